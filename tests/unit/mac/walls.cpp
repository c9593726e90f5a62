// Walls on the grid: a solid's face on a grid line closes the faces on that line, and a wall of any thickness separates the cells on its
// two sides, straight, oblique and curved.
#include "mac/bodies/solid_faces.hpp"
#include "mac/bodies/thin_solids.hpp"
#include "support/grid_solvers.hpp"
#include "support/test.hpp"

#include <fmt/format.h>
#include <cmath>

namespace weir::smoke::walls_tests {

namespace {

using poisson::Cell;

template <int D>
struct Placed {
    MacState<D> state;
    SolidPlacement<D> solids;
    explicit Placed(const scene::Scene& scene) : state(scene, {}), solids(geometry::Solids<D>(scene.root().tables("solids")), state) {}
    Placed(int n, const std::string& list) : Placed(test::mac_scene(test::unit_box(D, n, "solids = [ " + list + " ]\n"))) {}
    real open(int a, const Index<D>& I) const { return state.solid.open[static_cast<std::size_t>(a)](I); }

    /// How many cells are reached from one through open faces.
    std::size_t reached_from(const Index<D>& first) const {
        Grid<std::uint8_t, D> seen(state.extent());
        std::vector<Index<D>> queue{first};
        seen(first) = 1;
        for (std::size_t i = 0; i < queue.size(); ++i)
            for (int a = 0; a < D; ++a)
                for (const int up : {0, 1}) {
                    const Index<D> J = up == 1 ? queue[i] + e<D>(a) : queue[i] - e<D>(a);
                    if (!seen.contains(J) || seen(J) || open(a, up == 1 ? J : queue[i]) == 0) continue;
                    seen(J) = 1;
                    queue.push_back(J);
                }
        return queue.size();
    }
};

std::string box(const std::string& min, const std::string& max) { return "{ shape = \"box\", min = [" + min + "], max = [" + max + "] }"; }

}  // namespace

TEST("faces on the faces of an aligned box are closed, those that touch its corners alone are open, at any place on the grid") {
    // 1/10 and 3/10 are no binary fractions: k h and the box differ by round-off.
    const int n = 10;
    for (int first = 1; first < 8; ++first) {
        const Placed<2> p(n, box(fmt::format("{:.3f}, 0.3", first * 0.1), fmt::format("{:.3f}, 0.6", (first + 1) * 0.1)));
        for (int j = 0; j < n; ++j) {
            const bool beside = j >= 3 && j < 6;
            for (const int line : {first, first + 1}) EXPECT_EQ(p.open(0, {{line, j}}), beside ? 0 : 1);
            EXPECT_EQ(p.open(1, {{first, j}}), j >= 3 && j <= 6 ? 0 : 1);
            EXPECT_EQ(p.open(1, {{first - 1, j}}), 1);
            EXPECT_EQ(p.open(1, {{first + 1, j}}), 1);
            EXPECT_EQ(p.state.cells({{first, j}}) == Cell::solid, beside);
            EXPECT_EQ(p.state.cells({{first - 1, j}}) == Cell::solid, false);
        }
    }
}

TEST("a slot of one cell between two aligned boxes stays open, and so does the opening of one cell in a plate") {
    const Placed<2> p(10, box("0.2, -0.1", "0.4, 0.6") + ", " + box("0.5, -0.1", "0.8, 0.6"));
    for (int j = 0; j <= 9; ++j) EXPECT_EQ(p.open(1, {{4, j}}), 1);
    const Placed<3> plate(10, box("0.3, -0.1, -0.1", "0.4, 0.5, 1.1") + ", " + box("0.3, 0.6, -0.1", "0.4, 1.1, 1.1"));
    for (int k = 0; k < 10; ++k) {
        EXPECT_EQ(plate.open(0, {{3, 5, k}}), 1);
        EXPECT_EQ(plate.open(0, {{3, 4, k}}), 0);
        EXPECT_EQ(plate.open(0, {{4, 6, k}}), 0);
    }
}

TEST("boxes within round-off of the grid's lines are as those on them") {
    const Placed<2> on(16, box("0.25, 0.25", "0.5, 0.5"));
    for (const std::string by : {"0.2500000000001, 0.2499999999999", "0.2499999999999, 0.2500000000001"}) {
        const Placed<2> near(16, box(by, "0.5000000000001, 0.4999999999999"));
        for (int a = 0; a < 2; ++a) for_each_cell(on.state.extent(), [&](const Index<2>& I) { EXPECT_EQ(on.open(a, I), near.open(a, I)); });
    }
}

TEST("walls of any thickness and slope across the box separate its two sides") {
    const int n = 20;
    for (const real thick : {0.02, 0.3, 0.48, 0.9, 1.0, 1.2, 1.7, 2.5})  // cells
        for (const real degrees : {0.0, 7.0, 30.0, 45.0, 73.0, 90.0})
            for (const real off : {0.0, 0.01, 0.25, 0.5}) {
                const real angle = degrees * pi / 180, x = 0.5 + off / n;
                const Vec<2> along{std::cos(angle), std::sin(angle)};
                const Placed<2> p(
                    n, fmt::format("{{ shape = \"cylinder\", from = [{:.17g}, {:.17g}], to = [{:.17g}, {:.17g}], radius = {:.17g} }}",
                                   x - 2 * along[0], x - 2 * along[1], x + 2 * along[0], x + 2 * along[1], 0.5 * thick / n));
                const Index<2> one = degrees < 45 ? Index<2>{{10, 19}} : Index<2>{{0, 19}},
                               other = degrees < 45 ? Index<2>{{10, 0}} : Index<2>{{19, 0}};
                const std::size_t above = p.reached_from(one), below = p.reached_from(other);
                EXPECT_LT(above + below, static_cast<std::size_t>(n * n) + 1);
                // A wall takes no more than its own area and the cells that it crosses, two in a row and column of the steeper axis.
                EXPECT_GT(above + below, static_cast<std::size_t>(n * n) - static_cast<std::size_t>(n * (1.5 * thick + 3)));
            }
}

TEST("a thin shell in three dimensions, oblique to the grid everywhere, holds what is inside") {
    const int n = 20;
    const real shell = 0.3;
    for (const real thick : {0.1, 0.6, 1.4}) {
        const Placed<3> p(
            n,
            fmt::format("{{ shape = \"difference\", from = {{ shape = \"sphere\", centre = [0.51, 0.5, 0.49], radius = {:.17g} }}, minus = "
                        "[ {{ shape = \"sphere\", centre = [0.51, 0.5, 0.49], radius = {:.17g} }} ] }}",
                        shell, shell - thick / n));
        const std::size_t inside = p.reached_from({{10, 10, 9}}), ball = static_cast<std::size_t>(4.0 / 3 * pi * std::pow(shell * n, 3));
        EXPECT_LT(inside, ball + ball / 3);  // cells that the shell cuts count whole: one layer
        EXPECT_GT(inside, ball / 3);
    }
}

TEST("the tip of a thick solid closes no cell: a square on its corner leaves the cells beside it as they are cut") {
    const Placed<2> p(20, "{ shape = \"cylinder\", from = [0.4, 0.4], to = [0.613, 0.613], radius = 0.15 }");
    for_each_cell(p.state.extent(), [&](const Index<2>& I) {
        if (p.state.cells(I) != Cell::solid) return;
        const Vec<2> x{(I[0] + 0.5) / 20, (I[1] + 0.5) / 20};
        EXPECT_LT(p.solids.solids().distance(x), 0.0);
    });
}

TEST("a solid thinner than a cell is named before the run, with its thickness and the cells that it needs") {
    const auto remarks = [](const std::string& list) {
        return mac::remarks_on_thin_solids(test::mac_scene(test::unit_box(2, 20, "solids = [ " + list + " ]\n")));
    };
    EXPECT_EQ(remarks(box("0.2, 0.2", "0.4, 0.4")).size(), 0u);
    EXPECT_EQ(remarks(box("0.2, 0.2", "0.3, 0.4")).size(), 0u);  // two cells
    const auto said = remarks(box("0.2, 0.2", "0.4, 0.4") + ", " + box("0.51, -0.1", "0.534, 0.5"));
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("solids[1] is 0.48 cells thick"), std::string::npos);
    EXPECT_NE(said[0].find("grid.cells = [84, 84]"), std::string::npos);  // 20 cells times 2/0.48, upwards
}

// 2 cells: the bound of remarks on bodies. The plate of 0.8 cells is 0.04 m; turned by 30 degrees it is as thick.
TEST("a body thinner than two cells is named before the run, with its thickness and the cells that it needs, in 2D and 3D") {
    const auto remarks = [](int dim, const std::string& list) {
        return mac::remarks_on_thin_solids(test::mac_scene(test::unit_box(dim, 20, "bodies = [ " + list + " ]\n")));
    };
    const std::string thick = "{ shape = \"box\", min = [0.2, 0.2], max = [0.6, 0.3], density = 500.0 }",
                      plate = "{ shape = \"box\", min = [0.213, 0.417], max = [0.613, 0.457], density = 500.0, name = \"plate\" }",
                      turned = "{ shape = \"cylinder\", from = [0.3, 0.6], to = [0.6464, 0.8], radius = 0.02, density = 500.0 }";
    EXPECT_TRUE(remarks(2, thick).empty());
    const auto said = remarks(2, thick + ", " + plate + ", " + turned);
    ASSERT_EQ(said.size(), 2u);
    EXPECT_EQ(said[0].find("bodies[1] (\"plate\") is 0.8 cells thick at most: "), 0u) << said[0];
    EXPECT_NE(said[0].find("grid.cells = [50, 50]"), std::string::npos) << said[0];  // 20 cells times 2/0.8
    EXPECT_EQ(said[1].find("bodies[2] is 0.8 cells thick at most: "), 0u) << said[1];
    const std::string ball = "{{ shape = \"sphere\", centre = [0.5, 0.5, 0.5], radius = {}, density = 500.0 }}";
    EXPECT_TRUE(remarks(3, fmt::format(fmt::runtime(ball), 0.05)).empty());  // two cells
    const auto small = remarks(3, fmt::format(fmt::runtime(ball), 0.04));
    ASSERT_EQ(small.size(), 1u);
    EXPECT_EQ(small[0].find("bodies[0] is 1.6 cells thick at most: "), 0u) << small[0];
    EXPECT_NE(small[0].find("grid.cells = [25, 25, 25]"), std::string::npos) << small[0];
}

}  // namespace weir::smoke::walls_tests
