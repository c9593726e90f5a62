// Remarks on a scene that a run prints before its first step.
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

namespace remarks_tests {

TEST("solvers with a grid name solids thinner than one cell and bodies thinner than two; particles resolve them by their spacing") {
    const auto warnings = [](const std::string& solver) {
        const std::string text = fmt::format(R"(solver = "{}"
dim = 2
grid = {{ cells = [16, 16], size = [1.0, 1.0] }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
effects = {{ gravity = {{ g = [0.0, -9.81] }} }}
solids = [ {{ shape = "box", min = [0.1, 0.2], max = [0.8, 0.23] }}, {{ shape = "box", min = [0.1, 0.7], max = [0.8, 0.8] }} ]
bodies = [ {{ shape = "box", min = [0.2, 0.3], max = [0.5, 0.4], density = 500.0 }} ]
{}{})",
                                             solver, solver == "two_phase" ? "gas = { density = 1.2 }\n" : "",
                                             solver == "mac" ? "" : "liquid = [ { shape = \"box\", min = [0, 0], max = [1, 0.5] } ]\n");
        return weir::Simulation(weir::scene::parse(text, "thin.toml", weir::sim::schemas())).warnings();
    };
    for (const std::string solver : {"mac", "mac_water", "two_phase"}) {
        const auto said = warnings(solver);
        ASSERT_EQ(said.size(), 2u) << solver;
        EXPECT_EQ(said[0].find("thin.toml: solids[0] is 0.48 cells thick at most"), 0u) << said[0];
        EXPECT_EQ(said[1].find("thin.toml: bodies[0] is 1.6 cells thick at most"), 0u) << said[1];
        EXPECT_NE(said[1].find("grid.cells = [20, 20]"), std::string::npos) << said[1];  // 16 cells times 2/1.6
    }
    EXPECT_TRUE(warnings("pbf").empty());
}

}  // namespace remarks_tests
