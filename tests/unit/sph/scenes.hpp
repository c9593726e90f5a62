// Small scenes for the tests of SPH, read like a user's.
#pragma once
#include "scene/scene.hpp"
#include "sph/solver.hpp"

#include <fmt/core.h>

#include <string>

namespace weir::test {

/// A box of 8 x 12 [x 8] spacings, d = 1/8 m, with walls, gravity and a block of liquid from the origin to (x, y [, z]).
template <int D>
scene::Scene sph_box(double x, double y, double z, const std::string& scheme = "", const std::string& more = "",
                     const std::string& cells = D == 2 ? "[8, 12]" : "[8, 12, 8]",
                     const std::string& size = D == 2 ? "[1, 1.5]" : "[1, 1.5, 1]") {
    const auto corner = D == 2 ? fmt::format("[{}, {}]", x, y) : fmt::format("[{}, {}, {}]", x, y, z);
    const std::string text = fmt::format(
        "title = \"test\"\nsolver = \"sph\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime = {{ end = 10.0 }}\n"
        "fluid = {{ density = 1000.0 }}\nliquid = [{{ shape = \"box\", min = {}, max = {} }}]\nscheme = {{ {} }}\n"
        "effects.gravity = {{ g = {} }}\n{}\n",
        D, cells, size, D == 2 ? "[0, 0]" : "[0, 0, 0]", corner, scheme, D == 2 ? "[0, -9.81]" : "[0, -9.81, 0]", more);
    return scene::parse(text, "test.toml", {sph::kind().schema});
}

}  // namespace weir::test
