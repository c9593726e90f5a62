// Scenes of water for the tests.
#pragma once
#include "core/parallel.hpp"
#include "support/test.hpp"
#include "water/solver.hpp"

#include <fmt/format.h>

#include <string>

namespace weir::test {

inline scene::Scene water_scene(const std::string& text, const std::vector<scene::Override>& changes = {}) {
    static const std::vector<scene::SolverSchema> schemas{water::kind().schema};
    return scene::parse(text, "water.toml", schemas, changes);
}

inline std::string list(std::vector<std::string> entries, int dim) {
    std::string text = "[";
    for (int d = 0; d < dim; ++d) text += (d ? ", " : "") + entries[static_cast<std::size_t>(d)];
    return text + "]";
}

/// A tank of 1 m by 1 m (by 0.75 m) with a column of water in its lower left corner.
template <int D>
std::string dam_break(const std::string& transfer = "flip") {
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
effects = {{ gravity = {{ g = {} }} }}
scheme = {{ transfer = "{}" }}
)",
                       D, list({"16", "16", "12"}, D), list({"1.0", "1.0", "0.75"}, D), list({"0.0", "0.0", "0.0"}, D),
                       list({"0.4", "0.6", "0.75"}, D), list({"0.0", "-9.81", "0.0"}, D), transfer);
}

/// A tank half full under a gravity along −normal; the surface is the plane through `point`.
template <int D>
std::string at_rest(const Vec<D>& point, const Vec<D>& normal, const std::string& transfer) {
    std::vector<std::string> p, n, g;
    for (int d = 0; d < D; ++d) {
        p.push_back(fmt::format("{:.17g}", point[d]));
        n.push_back(fmt::format("{:.17g}", normal[d]));
        g.push_back(fmt::format("{:.17g}", -9.81 * normal[d] / norm(normal)));
    }
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "plane", point = {}, normal = {} }} ]
effects = {{ gravity = {{ g = {} }} }}
scheme = {{ transfer = "{}", poisson = {{ tolerance = 1e-10 }} }}
)",
                       D, list({"20", "16", "12"}, D), list({"1.25", "1.0", "0.75"}, D), list(p, D), list(n, D), list(g, D), transfer);
}

inline real integral(const Solver& solver, const std::string& name) {
    for (const auto& value : solver.integrals())
        if (value.name == name) return value.value;
    ADD_FAILURE() << "no integral " << name;
    return 0;
}

}  // namespace weir::test
