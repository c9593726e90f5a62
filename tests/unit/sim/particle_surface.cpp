// Heights and depths of particles from places that are known, without a solver: on lattices, disturbed ones, and where they part.
#include "sim/particle_surface.hpp"

#include "sim/surface.hpp"
#include "support/test.hpp"

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace particle_surface_tests {

namespace {

using weir::FieldSet;
using weir::FieldView;
using weir::real;
using weir::Vec;
using weir::Where;

constexpr int cells = 8;
constexpr real h = 1.0 / cells;

/// Particles of one box of 1 m with 8 spacings a side.
struct Places {
    int dim;
    std::array<std::vector<real>, 3> x;
    void add(const Vec<3>& at) {
        for (int a = 0; a < dim; ++a) x[static_cast<std::size_t>(a)].push_back(at[a]);
    }
    FieldSet fields() const {
        FieldSet set;
        set.grid.dim = dim;
        FieldView position{"position", "m", Where::particle, weir::particle_set_name, {}};
        for (int a = 0; a < dim; ++a) {
            const auto at = static_cast<std::size_t>(a);
            set.grid.cells[at] = cells, set.grid.spacing[at] = h;
            position.data.emplace_back(x[at]);
        }
        set.fields = {position};
        return set;
    }
};

/// A lattice over the whole box, up to a level along an axis; moved(place) is where each particle really is.
template <class Moved>
Places lattice(int dim, int axis, int layers, const Moved& moved) {
    Places places{dim, {}};
    for (int k = 0; k < (dim == 3 ? cells : 1); ++k)
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i) {
                const int index[3] = {i, j, k};
                if (index[axis] < layers) places.add(moved(Vec<3>{{(i + 0.5) * h, (j + 0.5) * h, dim == 3 ? (k + 0.5) * h : 0}}));
            }
    return places;
}

/// Lines through the box at every kind of offset from the particles, at walls and in corners.
std::vector<Vec<3>> lines() {
    std::vector<Vec<3>> list;
    for (const real s : {0.0, 0.01, 0.0625, 0.1, 0.125, 0.33, 0.5, 0.5625, 0.9, 1.0}) list.push_back({{s, 1 - s, 0.5 * s}});
    return list;
}

TEST_IN_2D_AND_3D(
    "the surface of a lattice is half a spacing above its uppermost layer, on every line along every axis; and so is its depth") {
    for (int axis = 0; axis < D; ++axis)
        for (const int layers : {2, 3, 5, 8}) {
            const Places places = lattice(D, axis, layers, [](const Vec<3>& x) { return x; });
            const FieldSet fields = places.fields();
            for (const Vec<3>& line : lines()) {
                EXPECT_NEAR(weir::sim::highest_of_particles(fields, line, axis), layers * h, 1e-13) << axis << ' ' << line[0];
                EXPECT_NEAR(weir::sim::depth_of_particles(fields, line, axis), layers * h, 1e-13) << axis << ' ' << line[0];
            }
        }
}

TEST_IN_2D_AND_3D("one layer is as high as it is, within half a spacing") {
    const Places places = lattice(D, 1, 1, [](const Vec<3>& x) { return x; });
    for (const Vec<3>& line : lines()) EXPECT_NEAR(weir::sim::highest_of_particles(places.fields(), line, 1), h, 0.5 * h);
}

TEST_IN_2D_AND_3D(
    "of particles that are off their lattice at random the height is right within half a spacing, and is never that of a gap") {
    std::mt19937 random(7);
    std::uniform_real_distribution<real> off(-0.25 * h, 0.25 * h);  // so that neighbours may be half a spacing nearer or farther
    for (int run = 0; run < 20; ++run) {
        const Places places = lattice(D, 1, 5, [&](const Vec<3>& x) {
            Vec<3> y = x;
            for (int a = 0; a < D; ++a) y[a] += off(random);
            return y;
        });
        for (const Vec<3>& line : lines()) EXPECT_NEAR(weir::sim::highest_of_particles(places.fields(), line, 1), 5 * h, 0.5 * h);
    }
}

TEST_IN_2D_AND_3D("between two columns that part the height stays, until nothing is within a spacing of it, where the line is dry") {
    for (const real gap : {1.0, 1.2, 1.4, 1.6, 2.6}) {  // spacings between the columns beside the line at x = 0.5
        const Places places = lattice(D, 1, 5, [&](const Vec<3>& x) {
            Vec<3> y = x;
            y[0] += (x[0] < 0.5 ? -0.5 : 0.5) * (gap - 1) * h;
            return y;
        });
        const real height = weir::sim::highest_of_particles(places.fields(), {{0.5, 0, 0.3}}, 1);
        if (gap < 2)
            EXPECT_NEAR(height, 5 * h, 0.5 * h) << gap;
        else
            EXPECT_EQ(height, 0);
    }
}

TEST_IN_2D_AND_3D("one particle in the air is liquid on lines that pass it within half a spacing, and on no line beyond one") {
    Places places{D, {}};
    places.add({{0.5, 0.7, 0.5}});
    const FieldSet fields = places.fields();
    const auto height = [&](real off) { return weir::sim::highest_of_particles(fields, {{0.5 + off * h, 0, 0.5}}, 1); };
    for (const real off : {0.0, 0.25, -0.5, 0.5}) {
        EXPECT_GT(height(off), 0.7) << off;
        EXPECT_LT(height(off), 0.7 + h) << off;
    }
    for (const real off : {1.0, -1.0, 1.5, 3.0}) EXPECT_EQ(height(off), 0) << off;
}

TEST_IN_2D_AND_3D("a front is half a spacing beyond the farthest particle, and no farther than a wall or a solid") {
    for (int axis = 0; axis < D; ++axis) {
        Places places{D, {}};
        places.add({{0.3, 0.3, 0.3}});
        Vec<3> far{{0.4, 0.4, 0.4}};
        for (const auto& [at, expected] : {std::pair{0.6, 0.6 + 0.5 * h}, {1 - 0.5 * h, 1.0}, {1 - 0.1 * h, 1.0}, {1.0, 1.0}}) {
            far[axis] = at;
            Places both = places;
            both.add(far);
            EXPECT_DOUBLE_EQ(weir::sim::front(both.fields(), axis), expected);
            const auto wall_at = [axis](real wall) { return [axis, wall](const Vec<3>& x) { return wall - x[axis]; }; };
            EXPECT_DOUBLE_EQ(weir::sim::front(both.fields(), axis, wall_at(at + 0.2 * h)), std::min(at + 0.2 * h, 1.0));
            EXPECT_DOUBLE_EQ(weir::sim::front(both.fields(), axis, wall_at(at + 5 * h)), expected);
        }
    }
}

}  // namespace

}  // namespace particle_surface_tests
