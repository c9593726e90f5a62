// Samples of fields on a small grid, laid out as solvers show them.
#include "validation/metrics/samples.hpp"

#include "support/test.hpp"

namespace samples_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// A velocity on the faces of a 6 x 4 (x 5) grid of the box [1, 4] x [0, 1] (x [0, 1]), filled by a function.
template <int D>
struct Faces {
    GridView grid;
    std::vector<std::vector<real>> values;
    FieldView view;
    FieldSet set() const { return {grid, {view}}; }

    template <class F>
    explicit Faces(F&& u) {
        grid = {D, {6, 4, D == 3 ? 5 : 1}, {1, 0, 0}, {0.5, 0.25, D == 3 ? 0.2 : 0}};
        for (int c = 0; c < D; ++c) {
            const auto n = sample_counts(grid, c);
            values.emplace_back(static_cast<std::size_t>(n[0] * n[1] * n[2]));
            for_each_sample(grid, c, [&](const Vec<3>& x, real, std::size_t i) { values.back()[i] = u(x)[c]; });
        }
        view = {.name = "velocity", .unit = "m/s", .where = Where::face, .set = "", .data = {}};
        for (const auto& v : values) view.data.emplace_back(v);
    }
};

}  // namespace

TEST_IN_2D_AND_3D("along a line, a field that is linear across comes out exactly, at its own points") {
    const Faces<D> field([](const Vec<3>& x) { return Vec<3>{x[0] + 10 * x[1] * x[1] - x[2], x[1], 0}; });
    const Vec<3> through{2.3, 0.4, D == 3 ? 0.37 : 0.0};
    const Curve line = along_line(field.view, field.grid, 0, through, 1);
    ASSERT_EQ(line.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(line.x[i], 0.25 * (real(i) + 0.5), 1e-15);
        EXPECT_NEAR(line.y[i], 2.3 + 10 * line.x[i] * line.x[i] - through[2], 1e-13);
    }
    EXPECT_EQ(along_line(field.view, field.grid, 1, through, 1).size(), 5u);  // faces across y stand on the floor and the ceiling too
}

TEST_IN_2D_AND_3D("mean kinetic energy and largest speed of a uniform stream") {
    const Faces<D> stream([](const Vec<3>&) { return Vec<3>{3, -4, 0}; });
    EXPECT_NEAR(mean_kinetic_energy(stream.set()), 12.5, 1e-12);
    EXPECT_EQ(max_speed(stream.set()), 4);
}

TEST("a cubic is reproduced between uneven points") {
    const auto f = [](real x) { return 1 - 2 * x + x * x * x; };
    Curve c;
    for (const real x : {0.0, 0.1, 0.3, 0.35, 0.7, 1.0}) c.x.push_back(x), c.y.push_back(f(x));
    for (const real x : {0.0, 0.05, 0.32, 0.5, 0.99, 1.0}) EXPECT_NEAR(cubic(c, x), f(x), 1e-13);
}

}  // namespace samples_tests
