#include "free_surface/level_set.hpp"
#include "free_surface/extrapolate.hpp"
#include "support.hpp"
#include "water/solver.hpp"

namespace level_set_tests {

using namespace weir;
using namespace weir::water;

namespace {

template <int D>
struct Surface {
    MacVelocity<D> u;
    Frame<D> frame;
    LevelSet<D> level_set;
    Surface(int n, const geometry::Shape<D>& liquid) : Surface(Index<D>::constant(n), liquid) {}
    /// A box of one metre in so many cells along each axis.
    Surface(const Index<D>& n, const geometry::Shape<D>& liquid)
        : u(replicated(n), edges(n), Vec<D>{}), frame(u, geometry::Sides<D>()), level_set(frame, 1) {
        start_level_set<D>(liquid, geometry::Solids<D>(), frame, level_set);
    }
    static Vec<D> edges(const Index<D>& n) {
        Vec<D> h;
        for (int d = 0; d < D; ++d) h[d] = 1.0 / n[d];
        return h;
    }
};

}  // namespace

TEST_IN_2D_AND_3D("the volume below a plane in a cell is exact: corners cut off, halves, and the whole") {
    Vec<D> g = Vec<D>::constant(1);
    // Σ x_d < −value about the centre: value = D/2 − t cuts a corner of volume t^D / D!
    const real t = 0.6, corner = D == 2 ? t * t / 2 : t * t * t / 6;
    EXPECT_NEAR(fraction_below_plane<D>(0.5 * D - t, g), corner, 1e-14);
    EXPECT_NEAR(fraction_below_plane<D>(t - 0.5 * D, g), 1 - corner, 1e-14);
    g[0] = 0.3, g[1] = -0.8;
    EXPECT_NEAR(fraction_below_plane<D>(0, g), 0.5, 1e-14);
    EXPECT_EQ(fraction_below_plane<D>(-5, g), 1);
    EXPECT_EQ(fraction_below_plane<D>(5, g), 0);
    EXPECT_NEAR(fraction_below_plane<D>(0.2, 0.5 * Vec<D>::unit(1)), 0.1, 1e-14);
}

TEST_IN_2D_AND_3D("the volume of a ball and the area of its surface converge at second order") {
    std::array<real, 2> volume_error, area_error;
    const real r = 0.31, volume = D == 2 ? pi * r * r : 4 * pi * r * r * r / 3, area = D == 2 ? 2 * pi * r : 4 * pi * r * r;
    for (int level = 0; level < 2; ++level) {
        const Surface<D> s(D == 2 ? 32 << level : 20 << level, *geometry::sphere<D>(Vec<D>::constant(0.52), r));
        volume_error[static_cast<std::size_t>(level)] = std::abs(s.level_set.volume() / volume - 1);
        area_error[static_cast<std::size_t>(level)] = std::abs(s.level_set.area() / area - 1);
    }
    EXPECT_GT(std::log2(volume_error[0] / volume_error[1]), 1.5);
    EXPECT_LT(area_error[1], 0.01);
}

TEST_IN_2D_AND_3D("the volume is the sum of the fractions of all cells, though only those of the band are looked at") {
    const Surface<D> s(18, *geometry::sphere<D>(Vec<D>::constant(0.45), 0.3));
    const real all = sum_over(s.frame.cells, [&](const Index<D>& I) { return s.level_set.fraction(I); });
    EXPECT_NEAR(s.level_set.volume(), all * s.frame.cell_volume(), 1e-12);
    EXPECT_GT(s.level_set.volume(), 0.1);
}

TEST_IN_2D_AND_3D("redistancing leaves the distance to a plane as it is, and makes a stretched field a distance within a tenth of a cell") {
    Vec<D> normal = Vec<D>::constant(0.3);
    normal[1] = 1;
    const auto plane = geometry::plane<D>(Vec<D>::constant(0.47), normal);
    Surface<D> s(24, *plane);
    const auto check = [&](real tolerance, std::size_t end) {
        for (std::size_t i = 0; i < end; ++i) {
            const Index<D> I = s.level_set.band()[i];
            EXPECT_NEAR(s.level_set.phi(I), plane->distance(s.frame.centre(I)), tolerance);
        }
    };
    check(1e-15, s.level_set.layer_end(2));  // the layers that the pressure reads: bit for bit up to the shape's own round-off
    for_each_cell(s.frame.cells, [&](const Index<D>& I) { s.level_set.phi(I) *= 3; });
    s.level_set.redistance();
    check(0.1 / 24, s.level_set.layer_end(1));
}

TEST_IN_2D_AND_3D("distances to a tilted plane are exact in flat cells too, however many of them it crosses in a column") {
    for (const int flat : {1, 4}) {
        Index<D> n = Index<D>::constant(16);
        n[1] *= flat;
        const auto plane = geometry::plane<D>(Vec<D>::constant(0.5), 0.7 * Vec<D>::unit(1) + 0.5 * Vec<D>::unit(0));
        Surface<D> s(n, *plane);
        const auto& band = s.level_set.band();
        for (std::size_t i = s.level_set.layer_end(2); i < band.size(); ++i)  // to be found again, from layers 1 and 2
            s.level_set.phi(band[i]) = std::copysign(0.9 * s.level_set.cap(), s.level_set.phi(band[i]));
        s.level_set.redistance();
        for (std::size_t i = 0; i < s.level_set.layer_end(3); ++i) {
            const Vec<D> x = s.frame.centre(band[i]);
            if (std::abs(x[0] - 0.5) > 0.2 || std::abs(x[1] - 0.5) > 0.2) continue;  // next to a wall one neighbour is missing
            EXPECT_NEAR(s.level_set.phi(band[i]), plane->distance(x), 1e-12) << "cells " << flat << " times as wide as high";
        }
    }
}

// The level set continues into solids by the mean of its neighbours: beside a corner |grad phi| is between 1 and |(1/2, 1)|, which
// redistancing does not rescale (up to 7/5). The sum of two neighbours would be a slope of 2.
TEST_IN_2D_AND_3D("redistancing leaves the distance to a plane as it is beside the corner of a solid, wherever in its cells the plane is") {
    set_threads(1);
    for (const real height : {0.44, 0.455, 0.47, 0.485, 0.5}) {
        const auto plane = geometry::plane<D>(height * Vec<D>::unit(1), Vec<D>::unit(1));
        Surface<D> s(16, *plane);
        Grid<std::uint8_t, D> closed(s.frame.cells);
        for_each_cell(s.frame.cells, [&](const Index<D>& I) { closed(I) = I[0] >= 10 && I[1] <= static_cast<int>(height * 16 + 0.5); });
        s.level_set.set_closed(closed);
        s.level_set.redistance();
        int beside = 0;
        for (std::size_t i = 0; i < s.level_set.layer_end(1); ++i) {
            const Index<D> I = s.level_set.band()[i];
            if (closed(I)) continue;
            EXPECT_NEAR(s.level_set.phi(I), plane->distance(s.frame.centre(I)), 1e-15) << height << ' ' << I[0] << ' ' << I[1];
            beside += I[0] == 9;
        }
        EXPECT_GT(beside, 0);
    }
}

TEST("a disc in solid rotation comes back: cubic advection changes its area by under 1% in a turn at 64 cells") {
    Surface<2> s(64, *geometry::sphere<2>(Vec<2>{{0.5, 0.7}}, 0.15));
    for (int a = 0; a < 2; ++a)
        for_each_cell(s.u[a].extent(), [&](const Index<2>& I) {
            const Vec<2> x = s.u.face_centre(a, I);
            s.u[a](I) = 2 * pi * (a == 0 ? 0.5 - x[1] : x[0] - 0.5);
        });
    const real before = s.level_set.volume();
    const auto phi = s.level_set.phi;
    for (int step = 0; step < 256; ++step) {
        s.level_set.advect(s.u, 1.0 / 256);
        s.level_set.redistance();
    }
    EXPECT_NEAR(s.level_set.volume() / before, 1, 0.01);  // measured 0.6%; first-order distances from layer 3 on reach the stencil
    real largest = 0;
    for (std::size_t i = 0; i < s.level_set.layer_end(1); ++i)
        largest = std::max(largest, std::abs(s.level_set.phi(s.level_set.band()[i]) - phi(s.level_set.band()[i])));
    EXPECT_LT(largest * 64, 0.2) << "the shape too: within a fifth of a cell";
}

TEST_IN_2D_AND_3D("a marker that leaves the liquid takes a drop with it; one that stays changes nothing") {
    Surface<D> s(16, *geometry::plane<D>(Vec<D>::constant(0.5), Vec<D>::unit(1)));
    Markers<D> markers(false, false);
    Vec<D> x = s.frame.centre(Index<D>::constant(4));
    markers.add(x, Vec<D>{});
    markers.sort(s.frame);
    const auto before = s.level_set.phi;
    EXPECT_EQ(s.level_set.correct_with_particles(markers), 0u);
    EXPECT_TRUE(std::equal(before.values().begin(), before.values().end(), s.level_set.phi.values().begin()));
    Index<D> up = Index<D>::constant(4);
    up[1] = 12;
    markers.set_position(0, s.frame.centre(up));
    markers.sort(s.frame);
    EXPECT_EQ(s.level_set.correct_with_particles(markers), 1u);
    EXPECT_NEAR(s.level_set.phi(up), -(D == 2 ? 0.28 : 0.31) / 16, 1e-15);
    s.level_set.redistance();
    EXPECT_LT(s.level_set.phi(up), 0);
    EXPECT_EQ(s.level_set.count_airborne(markers), 0u);
}

// Both are in the air, and within each other's drop: the first that joins puts the second inside.
TEST_IN_2D_AND_3D("whether a marker has escaped does not depend on other markers, in flat cells neither") {
    for (const int flat : {1, 4}) {
        Index<D> n = Index<D>::constant(16), up = Index<D>::constant(4);
        n[1] *= flat, up[1] = 12 * flat;
        Surface<D> s(n, *geometry::plane<D>(Vec<D>::constant(0.5), Vec<D>::unit(1)));
        Markers<D> markers(false, false);
        const Vec<D> x = s.frame.centre(up);
        markers.add(x, Vec<D>{});
        markers.add(x + 0.05 * s.frame.h_min() * Vec<D>::unit(1), Vec<D>{});
        markers.sort(s.frame);
        EXPECT_EQ(s.level_set.correct_with_particles(markers), 2u) << "cells " << flat << " times as wide as high";
    }
}

TEST_IN_2D_AND_3D("extrapolation continues a velocity without change along the normal") {
    Surface<D> s(20, *geometry::plane<D>(Vec<D>::constant(0.5), Vec<D>::unit(1)));
    FaceMarks<D> known;
    for (int a = 0; a < D; ++a) {
        auto& mark = known[static_cast<std::size_t>(a)] = Grid<std::uint8_t, D>(s.u[a].extent());
        for_each_cell(mark.extent(), [&](const Index<D>& I) {
            mark(I) = I[1] < 10;
            s.u[a](I) = mark(I) ? std::sin(3.0 * I[0] + a) : 1e30;
        });
    }
    Extrapolation<D> extrapolate(s.frame, 9.81);
    extrapolate(s.u, known, s.level_set, {}, 4);
    for (int a = 0; a < D; ++a)
        for_each_cell(s.u[a].extent(), [&](const Index<D>& I) {
            const bool reached = I[1] < 14;
            EXPECT_EQ(s.u[a](I) < 1e29, reached) << I[1];
            if (!reached) return;
            EXPECT_NEAR(s.u[a](I), std::sin(3.0 * I[0] + a), 1e-14);
        });
}

TEST_IN_2D_AND_3D("half cells measured all at once are the mean of planes one by one, to the last bit") {
    for (std::uint64_t sample = 0; sample < 4000; ++sample) {
        std::array<Vec<D>, 2> slope;
        for (std::size_t side = 0; side < 2; ++side)
            for (int d = 0; d < D; ++d) {
                slope[side][d] = 2 * hashed_random(3, sample, 4 * side + static_cast<std::uint64_t>(d)) - 1;
                if (sample % 5 == 0 && d == 1) slope[side][d] = 0;  // an axis that does not count
            }
        const real phi = 1.2 * (2 * hashed_random(3, sample, 9) - 1);
        real sum = 0;
        for (int half = 0; half < (1 << D); ++half) {
            Vec<D> g;
            real value = phi;
            for (int d = 0; d < D; ++d) {
                const bool up = half >> d & 1;
                g[d] = 0.5 * slope[up ? 1 : 0][d];
                value += up ? 0.5 * g[d] : -0.5 * g[d];
            }
            sum += fraction_below_plane(value, g);
        }
        EXPECT_EQ(fraction_of_halves<D>(phi, slope), sum / (1 << D));
    }
}

TEST_IN_2D_AND_3D("the surface comes from where a trace says, by cubic interpolation there, in the middle and beside the walls") {
    Surface<D> s(Index<D>::constant(15), *geometry::sphere<D>(Vec<D>::constant(0.42), 0.33));
    for (const real speed : {0.0, 1.0, 6.0}) {  // at rest, within a cell, and beyond
        for (int a = 0; a < D; ++a)
            for_each_cell(s.u[a].extent(), [&](const Index<D>& I) { s.u[a](I) = speed * std::sin(1.0 + a + 0.7 * I[0] + 0.4 * I[D - 1]); });
        const real dt = 0.9 / 15;
        auto moved = s.level_set;
        moved.advect(s.u, dt);
        const auto& phi = s.level_set.phi;
        for (const Index<D>& I : s.level_set.band()) {
            if (std::abs(phi(I)) >= 3 * s.frame.h_max()) continue;
            const Vec<D> from = trace(s.u, s.frame, s.frame.centre(I), -dt, Trace::rk2);
            real sum = 0;
            for (int node = 0; node < (D == 2 ? 16 : 64); ++node) {
                Index<D> J{};
                real weight = 1;
                for (int d = 0, rest = node; d < D; ++d, rest /= 4) {
                    const real at = (from[d] - s.frame.origin[d]) * s.frame.inv_h[d] - 0.5, f = at - std::floor(at);
                    const std::array<real, 4> w{f * (-0.5 + f * (1 - 0.5 * f)), 1 + f * f * (-2.5 + 1.5 * f), f * (0.5 + f * (2 - 1.5 * f)),
                                                f * f * (-0.5 + 0.5 * f)};
                    weight *= w[static_cast<std::size_t>(rest % 4)];
                    J[d] = static_cast<int>(std::floor(at));
                    J[d] = s.frame.near(J, d, rest % 4 - 1)[d];
                }
                sum += weight * phi(J);
            }
            EXPECT_NEAR(moved.phi(I), sum, 1e-14);
            if (speed == 0) {
                EXPECT_EQ(moved.phi(I), phi(I));
            }
        }
    }
}

}  // namespace level_set_tests
