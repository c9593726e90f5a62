// The markers of a cell are moved, and exchange momentum with the faces, together; here each is held against interpolation at its own
// place.
#include "free_surface/extrapolate.hpp"
#include "free_surface/marker_motion.hpp"
#include "support.hpp"
#include "water/transfer.hpp"

#include <atomic>

namespace marker_lanes_tests {

using namespace weir;
using namespace weir::water;

namespace {

template <int D>
struct Swarm {
    MacVelocity<D> u;
    geometry::Sides<D> sides;
    Frame<D> frame;
    Markers<D> markers{true, false};

    explicit Swarm(const std::string& periodic, real speed) {
        const auto scene = test::water_scene(fmt::format(
            "solver = \"mac_water\"\ndim = {}\ngrid = {{ cells = {}, size = {}, periodic = {} }}\ntime = {{ end = 1.0 }}\n"
            "liquid = [ {{ shape = \"sphere\", centre = {}, radius = 0.3 }} ]\n",
            D, test::list({"7", "5", "6"}, D), test::list({"1.4", "1.1", "0.9"}, D), periodic, test::list({"0.5", "0.5", "0.5"}, D)));
        const MacState<D> state(scene, FieldPlan{});
        u = state.u;
        sides = state.sides;
        frame = Frame<D>(u, sides);
        for (int a = 0; a < D; ++a)
            for_each_cell(u[a].extent(), [&](const Index<D>& I) { u[a](I) = speed * std::sin(1.0 + a + 3 * I[0] * I[0] + 2 * I[D - 1]); });
        sync_periodic(u, sides);
        for (std::size_t p = 0; p < 3000; ++p) {  // from none to many in a cell, up to the walls
            Vec<D> x, v;
            for (int d = 0; d < D; ++d) {
                const real r = hashed_random(5, p, static_cast<std::uint64_t>(d));
                x[d] = frame.origin[d] + frame.h[d] * frame.cells[d] * (d == 1 ? r * r : r);
                v[d] = r - 0.5;
            }
            markers.add(x, v);
        }
        markers.sort(frame);
    }
};

}  // namespace

TEST_IN_2D_AND_3D("markers that move together go where each would go alone, beside walls, around periodic axes, and at any speed") {
    for (const std::string periodic : {"[]", "[\"x\", \"y\"]"})
        for (const real dt : {0.06, 0.6}) {  // midpoints within half a cell, and beyond
            Swarm<D> swarm(periodic, 1.0);
            for (const Trace order : {Trace::rk1, Trace::rk2, Trace::rk3}) {
                auto moved = swarm.markers;
                move_markers(moved, swarm.u, swarm.frame, dt, order, swarm.sides, geometry::Solids<D>(), Grid<std::uint8_t, D>());
                for (std::size_t p = 0; p < moved.count(); ++p) {
                    const Vec<D> alone = trace(swarm.u, swarm.frame, swarm.markers.position(p), dt, order);
                    for (int d = 0; d < D; ++d) {
                        const real lo = swarm.frame.origin[d], length = swarm.frame.h[d] * swarm.frame.cells[d];
                        const real margin = wall_margin * swarm.frame.h[d], x = moved.position(p)[d];
                        if (swarm.frame.periodic(d))
                            EXPECT_NEAR(std::remainder(x - alone[d], length), 0, 1e-14);
                        else
                            EXPECT_NEAR(x, std::clamp(alone[d], lo + margin, lo + length - margin), 1e-14);
                    }
                }
            }
        }
}

TEST_IN_2D_AND_3D("markers take their velocity from the faces as interpolation at each one's place says") {
    for (const std::string periodic : {"[]", "[\"x\", \"y\"]"}) {
        Swarm<D> swarm(periodic, 1.0);
        auto pic = swarm.markers, flip = swarm.markers;
        auto before = swarm.u;
        for (int a = 0; a < D; ++a)
            for_each_cell(before[a].extent(), [&](const Index<D>& I) { before[a](I) = std::cos(2.0 * I[0] + I[1]); });
        sync_periodic(before, swarm.sides);
        pic_to_markers(swarm.u, swarm.frame, pic);
        auto scratch = before;
        flip_to_markers(swarm.u, scratch, 0.9, swarm.frame, flip);
        for (std::size_t p = 0; p < pic.count(); ++p) {
            const Stencil<D> stencil(swarm.frame, pic.position(p));
            const Vec<D> now = sample(swarm.u, stencil), then = sample(before, stencil);
            for (int a = 0; a < D; ++a) {
                const auto at = static_cast<std::size_t>(a);
                EXPECT_NEAR(pic.v[at][p], now[a], 1e-14);
                EXPECT_NEAR(flip.v[at][p], 0.9 * (swarm.markers.v[at][p] + now[a] - then[a]) + 0.1 * now[a], 1e-14);
            }
        }
    }
}

TEST_IN_2D_AND_3D("faces get the mean of the markers around them that interpolation weights marker by marker say") {
    for (const std::string periodic : {"[]", "[\"x\", \"y\"]"}) {
        Swarm<D> swarm(periodic, 1.0);
        const Frame<D>& frame = swarm.frame;
        auto u = swarm.u;
        FaceSums<D> sums(frame.cells);
        FaceMarks<D> known;
        for (int a = 0; a < D; ++a) known[static_cast<std::size_t>(a)] = Grid<std::uint8_t, D>(u[a].extent());
        markers_to_faces(swarm.markers, frame, sums, u, known);
        for (int a = 0; a < D; ++a) {
            const auto at = static_cast<std::size_t>(a);
            Grid<real, D> momentum(u[a].extent()), weight(u[a].extent());
            for (std::size_t p = 0; p < swarm.markers.count(); ++p)
                for_each_sample(Stencil<D>(frame, swarm.markers.position(p)), a, u[a].extent(), [&](std::ptrdiff_t face, real w) {
                    momentum.data()[face] += w * swarm.markers.v[at][p];
                    weight.data()[face] += w;
                });
            for_each_cell(u[a].extent(), [&](Index<D> I) {
                Index<D> twin = I;  // a periodic axis has its first face twice, and both have the sum
                if (frame.periodic(a) && (I[a] == 0 || I[a] == frame.cells[a])) twin[a] = frame.cells[a] - I[a];
                const real w = weight(I) + (twin == I ? 0 : weight(twin)), m = momentum(I) + (twin == I ? 0 : momentum(twin));
                EXPECT_EQ(known[at](I), w > 1e-12);
                if (w > 1e-6) {
                    EXPECT_NEAR(u[a](I), m / w, 1e-14 * std::max(1.0, 1 / w));
                }
            });
        }
    }
}

TEST_IN_2D_AND_3D("cells found eight markers at a time are those that each marker alone is in, also outside the domain") {
    Swarm<D> swarm("[]", 1.0);
    auto& markers = swarm.markers;
    for (int d = 0; d < D; ++d) markers.add(3.0 * Vec<D>::unit(d), Vec<D>{}), markers.add(-0.3 * Vec<D>::unit(d), Vec<D>{});
    markers.sort(swarm.frame);
    std::atomic<std::size_t> seen = 0;  // lines of cells run on threads
    markers.for_each_occupied_cell(swarm.frame, [&](const Index<D>& I, std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p, ++seen) EXPECT_EQ(swarm.frame.cell_of(markers.position(p)), I);
    });
    EXPECT_EQ(seen, markers.count());
}

}  // namespace marker_lanes_tests
