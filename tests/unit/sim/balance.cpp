// The balance of a run: what it calls unexplained, and what it warns of, on a solver whose integrals are known.
#include "sim/balance.hpp"

#include "geometry/solids.hpp"
#include "support/fake_solver.hpp"
#include "support/test.hpp"

#include <functional>

namespace balance_tests {

namespace {

using weir::Integral;
using weir::real;
using weir::sim::BalanceOfRun;

using Integrals = std::function<std::vector<Integral>(real t)>;

/// The fake, whose integrals are a function of time. It reads sides and solids, so that a scene may have them.
struct Stated final : weir::test::FakeSolver {
    Stated(const weir::scene::Scene& scene, Integrals f) : FakeSolver(scene), of(std::move(f)) {
        const weir::geometry::Solids<2> solids(scene.root().tables("solids"));
        for (const std::string side : {"sides.x_min", "sides.y_max"}) {
            scene.text(side + ".kind");
            if (scene.has(side + ".velocity")) scene.root().numbers(side + ".velocity");
        }
    }
    std::vector<Integral> integrals() const override { return of(time()); }
    Integrals of;
};

/// Of a run of 1 s with frames every 0.1 s, from `begin` on.
BalanceOfRun balance(const Integrals& integrals, const std::string& more = "", int begin = 0, const std::string& every = "0.1") {
    auto kinds = weir::test::fake_kinds();
    kinds[0].make = [&](const weir::scene::Scene& scene, const weir::Partition&) { return std::make_unique<Stated>(scene, integrals); };
    const std::string text =
        "solver = \"fake\"\ndim = 2\ngrid = { cells = [8, 8], size = [1, 1] }\ntime = { end = 1 }\noutput.every = " + every + "\n" + more;
    weir::Simulation simulation(weir::scene::parse(text, "fake.toml", {kinds[0].schema}), kinds);
    while (simulation.steps() < begin) simulation.step();
    weir::sim::Balance taken(simulation);
    while (!simulation.finished()) {
        const auto report = simulation.step();
        taken.on_step(simulation, report);
        if (simulation.at_frame()) taken.on_frame(simulation);
    }
    return taken.of_run(simulation);
}

Integrals volume(real from, real to, real balance_from, real balance_to) {
    return [=](real t) {
        return std::vector<Integral>{{"volume", "m^2", from + t * (to - from)},
                                     {"volume_target", "m^2", balance_from + t * (balance_to - balance_from)}};
    };
}

TEST("a volume that falls without an outlet is unexplained, in part of what it was, and warned of in its numbers") {
    const BalanceOfRun run = balance(volume(0.143, 0.1296, 0.143, 0.143));
    ASSERT_EQ(run.quantities.size(), 1u);
    EXPECT_NEAR(*run.quantities[0].unexplained, 0.1296 / 0.143 - 1, 1e-12);
    EXPECT_NEAR(*run.quantities[0].inflow, 0, 1e-15);
    ASSERT_EQ(run.warnings.size(), 1u);
    EXPECT_EQ(run.warnings[0].find("the liquid's volume fell by 9.4% without an outlet (0.143 m^2 to 0.1296 m^2); "), 0u)
        << run.warnings[0];
}

TEST("a volume that grows by what was poured in is explained; more than that is not, by the part of what there should be") {
    EXPECT_TRUE(balance(volume(0.1, 0.2, 0.1, 0.2)).warnings.empty());
    const BalanceOfRun run = balance(volume(0.1, 0.22, 0.1, 0.2));
    EXPECT_NEAR(*run.quantities[0].unexplained, 0.02 / 0.2, 1e-12);
    EXPECT_NEAR(*run.quantities[0].inflow, 0.1, 1e-12);
    ASSERT_EQ(run.warnings.size(), 1u);
    EXPECT_NE(run.warnings[0].find("10% above the value expected from inflow and outflow"), std::string::npos) << run.warnings[0];
}

TEST("the bound is one per cent, and what was lost between and came back is shown") {
    EXPECT_TRUE(balance(volume(1, 0.991, 1, 1)).warnings.empty());
    EXPECT_FALSE(balance(volume(1, 0.989, 1, 1)).warnings.empty());
    const BalanceOfRun run = balance([](real t) {
        return std::vector<Integral>{{"volume", "m^2", 1 - t * (1 - t)}, {"volume_target", "m^2", 1}};
    });
    EXPECT_NEAR(*run.quantities[0].unexplained, 0, 1e-12);
    EXPECT_NEAR(*run.quantities[0].furthest, -0.25, 0.002);  // frames are within 0.03 s of 0.5 s
    EXPECT_TRUE(run.warnings.empty());
}

TEST("a run that continues is balanced from where it continues") {
    const BalanceOfRun run = balance(volume(1, 2, 1, 1), "", 30);
    EXPECT_GT(run.from, 0.3);
    EXPECT_NEAR(*run.quantities[0].unexplained, (2 - run.quantities[0].start) / run.quantities[0].start, 1e-12);
}

TEST("mass of particles is judged where nothing comes or goes, and shown where emitters stand") {
    const Integrals loses = [](real t) { return std::vector<Integral>{{"mass", "kg", 2 - 0.1 * t}, {"volume", "m^3", 1}}; };
    const BalanceOfRun closed = balance(loses), open = balance(loses, "sides = { y_max = \"outflow\" }\n");
    ASSERT_EQ(closed.warnings.size(), 1u);
    EXPECT_EQ(closed.warnings[0].find("the liquid's mass fell by 5%"), 0u) << closed.warnings[0];
    EXPECT_TRUE(open.warnings.empty());
    EXPECT_FALSE(open.quantities[0].unexplained.has_value());
    EXPECT_EQ(open.quantities.size(), 1u);  // its volume says nothing more
}

TEST("energy above its start is warned of in a closed scene, at its highest frame; where something does work it is shown alone") {
    const Integrals swings = [](real t) {
        return std::vector<Integral>{{"kinetic_energy", "J/m", 1 + 0.2 * std::sin(weir::pi * t)}, {"potential_energy", "J/m", 3 - t}};
    };
    const BalanceOfRun run = balance(swings);
    EXPECT_EQ(run.quantities[0].name, "energy");
    EXPECT_NEAR(run.quantities[0].start, 4, 1e-12);
    EXPECT_NEAR(run.quantities[0].end, 3, 1e-12);
    EXPECT_TRUE(run.warnings.empty());  // it falls faster than it swings
    const Integrals grows = [](real t) { return std::vector<Integral>{{"kinetic_energy", "J/m", 1 + 0.2 * std::sin(weir::pi * t)}}; };
    const BalanceOfRun more = balance(grows);
    ASSERT_EQ(more.warnings.size(), 1u);
    EXPECT_NEAR(*more.quantities[0].unexplained, 0.2, 0.001);
    EXPECT_EQ(more.warnings[0].find("the total energy rose by 20% above its initial value"), 0u) << more.warnings[0];
    for (const std::string works :
         {"sides = { x_min = { kind = \"moving_wall\", velocity = [0, 1] } }\n",
          "solids = [ { shape = \"sphere\", centre = [0.5, 0.5], radius = 0.2, motion = { kind = \"constant\", velocity "
          "= [0.1, 0] } } ]\n",
          "sides = { y_max = \"outflow\" }\n"})
        EXPECT_TRUE(balance(grows, works).warnings.empty()) << works;
    EXPECT_EQ(balance(grows, "sides = { x_min = \"wall\" }\n").warnings.size(), 1u);
}

TEST("energy that comes and goes between two frames is seen if it stays for 16 steps") {
    int steps = 0;
    const Integrals thrown = [&](real t) {
        return ++steps, std::vector<Integral>{{"kinetic_energy", "J/m", t > 0.3 && t < 0.6 ? 2.0 : 1.0}};
    };
    const BalanceOfRun run = balance(thrown, "", 0, "1");
    EXPECT_EQ(*run.quantities[0].highest, 2);
    EXPECT_EQ(run.warnings.size(), 1u);
    EXPECT_LT(steps, 12);  // of about a hundred steps
}

// 2% of the volume in one second; 1% is the bound of all quantities.
TEST("a volume that is kept by corrections beside moving solids says how much they moved") {
    const auto moved = [](real rate) {
        return [rate](real t) -> std::vector<Integral> { return {{"volume", "m^2", 0.5}, {"volume_corrections", "m^2", rate * t}}; };
    };
    const BalanceOfRun much = balance(moved(0.01)), little = balance(moved(0.004));
    ASSERT_EQ(much.corrected.size(), 1);
    EXPECT_EQ(much.corrected[0].name, "volume_corrections");
    EXPECT_NEAR(much.corrected[0].value, 0.01, 1e-12);
    ASSERT_EQ(much.warnings.size(), 1);
    EXPECT_EQ(much.warnings[0].find("2% of the liquid was moved along its surface"), 0) << much.warnings[0];
    EXPECT_TRUE(little.warnings.empty());
}

TEST("percentages of any size have no exponent: all of a volume that vanished, and 900 times it moved by corrections") {
    const BalanceOfRun vanished = balance(volume(0.143, 0.0004, 0.143, 0.143));
    ASSERT_EQ(vanished.warnings.size(), 1u);
    EXPECT_EQ(vanished.warnings[0].find("the liquid's volume fell by 100% without an outlet"), 0u) << vanished.warnings[0];
    const BalanceOfRun moved = balance([](real t) -> std::vector<Integral> {
        return {{"volume", "m^2", 0.5}, {"volume_corrections", "m^2", 450 * t}};
    });
    ASSERT_EQ(moved.warnings.size(), 1u);
    EXPECT_EQ(moved.warnings[0].find("90000% of the liquid was moved"), 0u) << moved.warnings[0];
    for (const auto& [part, text] : {std::pair{0.0, "0%"},
                                     {5.23e-7, "0.000052%"},
                                     {0.00052, "0.052%"},
                                     {-0.094, "-9.4%"},
                                     {0.0996, "10%"},
                                     {0.125, "12%"},
                                     {0.996, "100%"},
                                     {1.234, "123%"},
                                     {-900.0, "-90000%"}})
        EXPECT_EQ(weir::sim::percent_text(part), text);
}

TEST("heat is balanced against what was added to it") {
    const auto heat = [](real lost) {
        return [lost](real t) { return std::vector<Integral>{{"heat", "J/m", 100 + (50 - lost) * t}, {"heat_added", "J/m", 50 * t}}; };
    };
    EXPECT_TRUE(balance(heat(0)).warnings.empty());
    const BalanceOfRun run = balance(heat(10));
    ASSERT_EQ(run.warnings.size(), 1u);
    EXPECT_NEAR(*run.quantities[0].unexplained, -10.0 / 140, 1e-12);
    EXPECT_TRUE(
        balance([](real t) {
            return std::vector<Integral>{{"heat", "J/m", 100 + 30 * t}, {"heat_added", "J/m", 50 * t}, {"vapour_heat", "J/m", 20 * t}};
        }).warnings.empty());  // what vapour takes along is explained
}

TEST("solids thinner than two cells are named with their thickness, whatever shape they have") {
    const std::string solids =
        "solids = [ { shape = \"box\", min = [0.2, -0.1], max = [0.26, 0.7] }, { shape = \"box\", min = [0.5, 0], max = [0.75, 0.25] }, "
        "{ shape = \"sphere\", centre = [0.8, 0.8], radius = 0.1 }, { shape = \"capsule\", from = [0, 0.9], to = [0.3, 0.9], radius = 0.2 "
        "}, "
        "{ shape = \"cylinder\", from = [0.3, 0.4], to = [0.4, 0.4], radius = 0.2 }, "
        "{ shape = \"plane\", point = [0, 0.01], normal = [0, 1] } ]\n";
    const BalanceOfRun run = balance([](real) { return std::vector<Integral>{}; }, solids);
    ASSERT_EQ(run.thin.size(), 3u);  // cells of 1/8 m
    EXPECT_EQ(run.thin[0].first, "solids[0]");
    EXPECT_NEAR(run.thin[0].second, 0.48, 1e-12);
    EXPECT_EQ(run.thin[1].first, "solids[2]");
    EXPECT_NEAR(run.thin[1].second, 1.6, 1e-12);
    EXPECT_EQ(run.thin[2].first, "solids[4]");
    EXPECT_NEAR(run.thin[2].second, 0.8, 1e-12);
}

TEST("the largest divergence of any step is kept, and nothing is invented where there is none to tell") {
    const BalanceOfRun run = balance([](real) { return std::vector<Integral>{}; });
    EXPECT_EQ(run.divergence, 1e-12);
    EXPECT_LE(run.cell_change, 0.03 * 1e-12);
    EXPECT_TRUE(run.quantities.empty());
    EXPECT_TRUE(run.corrected.empty());
    EXPECT_TRUE(run.warnings.empty());
}

}  // namespace

}  // namespace balance_tests
