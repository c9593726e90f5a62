// Small scenes of height fields.
#pragma once
#include "heightfield/rows.hpp"
#include "heightfield/solver.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <string>

namespace weir::test {

inline scene::Scene height_scene(int dim, const std::string& more, int cells = 24, const std::string& gravity = "-9.81") {
    const std::string n = std::to_string(cells), m = std::to_string(cells + 13);
    const std::string head =
        dim == 2 ? "dim = 2\ngrid.cells = [" + n + ", 1]\ngrid.size = [1.0, 1.0]\neffects.gravity.g = [0.0, " + gravity + "]\n"
                 : "dim = 3\ngrid.cells = [" + n + ", 1, " + m + "]\ngrid.size = [1.0, 1.0, 1.5]\neffects.gravity.g = [0.0, " + gravity +
                       ", 0.0]\n";
    return scene::parse("solver = \"heightfield\"\ntime = { end = 1.0 }\n" + head + more, "scene.toml", {heightfield::kind().schema});
}

/// Hills that stand out of the water, waves, currents.
inline std::string rough_water(int dim) {
    return dim == 2 ? "terrain = { kind = \"formula\", height = \"0.2*sin(9*x) + 0.05*sin(40*x)\" }\n"
                      "initial = { surface = \"0.1 + 0.05*cos(7*x)\", velocity = { name = \"formula\", x = \"0.4*sin(5*x)\" } }\n"
                    : "terrain = { kind = \"formula\", height = \"0.2*sin(9*x)*cos(8*z) + 0.05*sin(40*x - 30*z)\" }\n"
                      "initial = { surface = \"0.1 + 0.05*cos(7*x + 3*z)\", velocity = { name = \"formula\", x = \"0.4*sin(5*x + z)\", z = "
                      "\"0.3*cos(4*z)\" } }\n";
}

inline std::unique_ptr<Solver> height_solver(const scene::Scene& scene) { return heightfield::kind().make(scene, {}); }

}  // namespace weir::test
