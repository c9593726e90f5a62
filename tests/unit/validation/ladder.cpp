// Grids of a ladder, and which ones a scene can have.
#include "validation/uncertainty/ladder.hpp"

#include "core/error.hpp"
#include "sim/registry.hpp"
#include "support/test.hpp"
#include "validation/uncertainty/other_influences.hpp"

namespace ladder_tests {

using namespace weir;
using namespace weir::validation;

namespace {

const char* tank = R"(
title = "tank"
solver = "mac_water"
dim = 2
grid = { cells = [40, 24], size = [1.0, 0.6] }
time = { end = 0.1, max_dt = 0.01 }
fluid = { density = 1000.0 }
liquid = [ { shape = "box", min = [0.0, 0.0], max = [1.0, 0.3] } ]
effects = { gravity = { g = [0.0, -9.81] } }
)";

scene::Scene tank_with(const std::vector<scene::Override>& set) { return scene::parse(tank, "tank", sim::schemas(), set); }

Ladder ladder_of(const scene::Scene& scene, const std::string& with = "") {
    return Ladder(scene, method_of(scene, with, sim::registry()), sim::registry());
}

}  // namespace

TEST("grids keep the proportions of the cells, and steps shrink with the cell") {
    const Ladder ladder = ladder_of(tank_with({}));
    EXPECT_EQ(ladder.own(), 8);
    const Grid coarse = ladder.grid(4), fine = ladder.grid(12, 0.012, 4);
    EXPECT_EQ(coarse.cells, (std::vector<int>{20, 12}));
    EXPECT_EQ(fine.cells, (std::vector<int>{60, 36}));
    EXPECT_NEAR(coarse.h, 0.05, 1e-15);
    EXPECT_NEAR(ladder.scene(coarse).number("time.max_dt"), 0.02, 1e-12);
    EXPECT_NEAR(ladder.scene(fine).number("time.max_dt"), 0.012 * 4 / 12, 1e-9);  // the coarse run's mean step is shorter than max_dt
    EXPECT_NEAR(ladder.scene(ladder.grid(12, 1, 4)).number("time.max_dt"), 0.01 * 40 / 60, 1e-9);
}

TEST("probes with few rows get more, on every grid") {
    const auto scene = tank_with({{"probes",
                                   "[{name = \"a\", kind = \"gauge\", at = [0.5, 0.0], every = 0.05}, {name = \"b\", kind = "
                                   "\"gauge\", at = [0.5, 0.0], every = 0.0001}]"}});
    const Ladder ladder = ladder_of(scene);
    const auto coarse = ladder.scene(ladder.grid(4));
    const auto& probes = coarse.root().tables("probes");
    EXPECT_NEAR(probes[0].number("every"), 0.1 / 300, 1e-9);
    EXPECT_EQ(probes[1].number("every"), 0.0001);
}

TEST("a prescribed step shrinks with the cell") {
    const Ladder ladder = ladder_of(tank_with({{"time.dt", "0.004"}}));
    EXPECT_NEAR(ladder.scene(ladder.grid(16)).number("time.dt"), 0.002, 1e-12);
}

TEST("height fields have one cell along the vertical, and tall cells scale their layers") {
    const Ladder columns = ladder_of(tank_with({}), "shallow_water");
    EXPECT_EQ(columns.grid(20).cells, (std::vector<int>{20, 1}));
    EXPECT_EQ(columns.method().solver, "heightfield");
    EXPECT_EQ(columns.method().formal_order, 1.5);
    const Ladder tall = ladder_of(tank_with({}), "tallcell");
    EXPECT_EQ(tall.scene(tall.grid(16)).integer("scheme.layers"), 16);
    std::string why;
    EXPECT_EQ(tall.coarsest(why), 8);
    EXPECT_NE(why.find("scheme.layers"), std::string::npos) << why;
}

TEST("grids whose cells are too wide for a solid are left out") {
    const auto scene = tank_with({{"solids", "[{shape = \"box\", min = [0.5, 0.0], max = [0.56, 0.4]}]"}});
    const Ladder ladder = ladder_of(scene);
    std::string why;
    EXPECT_EQ(ladder.coarsest(why), 7);  // 35 cells of 1 m: the wall is 2.1 cells thick; 30 cells: 1.8
    EXPECT_NE(why.find("1.8 cells thick"), std::string::npos) << why;
}

TEST("unknown methods are refused with the nearest name, and what a solver cannot do with its reason") {
    const auto message = [](const scene::Scene& scene, const std::string& with) -> std::string {
        try {
            method_of(scene, with, sim::registry());
        } catch (const BadInput& wrong) {
            return wrong.what();
        }
        return "";
    };
    EXPECT_NE(message(tank_with({}), "tallcel").find("tallcell"), std::string::npos);
    const auto blocked = tank_with({{"solids", "[{shape = \"box\", min = [0.5, 0.0], max = [0.6, 0.4]}]"}});
    EXPECT_EQ(message(blocked, "waves"), "") << "other methods go on";
    EXPECT_THROW(ladder_of(blocked, "waves"), BadInput);
}

TEST("a ladder ends with its finest grid and keeps to its coarsest") {
    EXPECT_EQ(numbers_of_ladder(1, 8, 4, 1.5), (std::vector<int>{2, 3, 5, 8}));
    EXPECT_EQ(numbers_of_ladder(5, 8, 4, 1.5), (std::vector<int>{5, 8}));
    EXPECT_EQ(numbers_of_ladder(1, 3, 5, 1.1), (std::vector<int>{1, 2, 3}));
}

TEST("twins part where their means differ by a twentieth of the range") {
    Curve one, twin;
    for (int i = 0; i <= 300; ++i) {
        const real t = 0.01 * i;
        one.x.push_back(t), one.y.push_back(std::sin(4 * t));
        twin.x.push_back(t), twin.y.push_back(std::sin(4 * t) + (t < 2 ? 1e-6 : 0.2));
    }
    ASSERT_TRUE(time_of_parting(one, twin).has_value());
    EXPECT_NEAR(*time_of_parting(one, twin), 2, 0.1 + 1e-9);  // a window is 0.1 s long
    EXPECT_FALSE(time_of_parting(one, one).has_value());
    EXPECT_FALSE(time_of_parting(one, twin, 3).has_value()) << "below that, a series is round-off";
}

}  // namespace ladder_tests
