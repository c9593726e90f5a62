// Energy of waves on tall cells: nothing puts any in.
#include "support/test.hpp"
#include "tallcell/solver.hpp"

namespace weir::test::energy_tests {
namespace {

/// Of motion and of the surface above where its volume stands at rest, a metre wide [J/m].
real wave_energy(const Solver& solver) {
    real energy = 0;
    for (const auto& value : solver.integrals()) {
        if (value.name == "kinetic_energy" || value.name == "potential_energy") energy += value.value;
        if (value.name == "volume") energy -= 0.5 * 1000 * 9.81 * value.value * value.value;
    }
    return energy;
}

/// As of mac_water (tests/unit/water/energy.cpp), with the same bound.
TEST("no wave gains energy on tall cells") {
    static const std::vector<scene::SolverSchema> schemas{tallcell::kind().schema};
    const scene::Scene scene = scene::parse(R"(solver = "tallcell"
dim = 2
grid = { cells = [32, 24], size = [1.0, 0.75] }
time = { end = 12.0 }
fluid = { density = 1000.0 }
liquid = [ { shape = "plane", point = [0.5, 0.4], normal = [-0.2, 1.0] } ]
effects.gravity.g = [0.0, -9.81]
)",
                                            "tank.toml", schemas, {});
    tallcell::TallCells<2> water(scene);
    const real start = wave_energy(water);
    real most = 0;
    while (water.time() < 12) {
        water.step(water.advised_dt());
        most = std::max(most, wave_energy(water));
    }
    // 2% of all energy: waves of medium slope swing by some of their own where the level set follows the liquid parts of cells.
    const real total = wave_energy(water) + 0.5 * 1000 * 9.81 * 0.4 * 0.4;
    EXPECT_LT(most, start + 0.02 * total);
}

/// As of mac_water (tests/unit/water/energy.cpp): a cup with its floor on a grid line and a hundredth of a cell above it; the slack is of
/// the two cells where walls meet.
TEST("the potential energy of water in a cup on tall cells is of the water alone") {
    static const std::vector<scene::SolverSchema> schemas{tallcell::kind().schema};
    for (const real up : {0.0, 0.000625}) {
        const std::string floor = std::to_string(0.25 + up), low = std::to_string(0.125 + up), top = std::to_string(0.5 + up);
        const tallcell::TallCells<2> water(scene::parse(R"(solver = "tallcell"
dim = 2
grid = { cells = [16, 16], size = [1.0, 1.0] }
time = { end = 1.0 }
fluid = { density = 1000.0 }
effects.gravity.g = [0.0, -9.81]
liquid = [ { shape = "box", min = [0.25, )" + floor + R"(], max = [0.75, )" +
                                                            top + R"(] } ]
solids = [ { shape = "box", min = [0.125, )" + low + R"(], max = [0.875, )" +
                                                            floor + R"(] },
           { shape = "box", min = [0.125, )" + low + R"(], max = [0.25, 0.75] }, { shape = "box", min = [0.75, )" +
                                                            low + R"(], max = [0.875, 0.75] } ]
)",
                                                        "cup.toml", schemas, {}));
        real volume = 0, energy = 0;
        for (const auto& value : water.integrals()) {
            if (value.name == "volume") volume = value.value;
            if (value.name == "potential_energy") energy = value.value;
        }
        EXPECT_NEAR(energy, 1000 * 9.81 * volume * (0.25 + up + volume), 1000 * 9.81 * volume * 2 * 2 / 16 / 16 / 4);
    }
}

}  // namespace
}  // namespace weir::test::energy_tests
