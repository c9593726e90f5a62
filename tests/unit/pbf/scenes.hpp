// Small scenes for the tests of PBF, read like a user's.
#pragma once
#include "core/parallel.hpp"
#include "pbf/solver.hpp"
#include "scene/scene.hpp"

#include <fmt/core.h>

#include <memory>
#include <string>

namespace weir::test {

/// A box of 8 x 12 [x 8] spacings, d = 1/8 m, with walls, gravity and the liquid given; `more` is TOML added at the end.
template <int D>
scene::Scene pbf_scene(const std::string& liquid, const std::string& scheme = "", const std::string& more = "",
                       const std::string& cells = D == 2 ? "[8, 12]" : "[8, 12, 8]",
                       const std::string& size = D == 2 ? "[1, 1.5]" : "[1, 1.5, 1]") {
    const std::string text = fmt::format(
        "title = \"test\"\nsolver = \"pbf\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime = {{ end = 10.0, dt = 0.008 }}\n"
        "fluid = {{ density = 1000.0 }}\nliquid = [{}]\nscheme = {{ {} }}\neffects.gravity = {{ g = {} }}\n{}\n",
        D, cells, size, liquid, scheme, D == 2 ? "[0, -9.81]" : "[0, -9.81, 0]", more);
    return scene::parse(text, "test.toml", {pbf::kind().schema});
}

template <int D>
std::string box(double x, double y, double z) {
    const auto corner = D == 2 ? fmt::format("[{}, {}]", x, y) : fmt::format("[{}, {}, {}]", x, y, z);
    return fmt::format("{{ shape = \"box\", min = {}, max = {} }}", D == 2 ? "[0, 0]" : "[0, 0, 0]", corner);
}

template <int D>
std::unique_ptr<pbf::PbfSolver<D>> pbf_solver(const scene::Scene& scene) {
    return std::make_unique<pbf::PbfSolver<D>>(scene);
}

}  // namespace weir::test
