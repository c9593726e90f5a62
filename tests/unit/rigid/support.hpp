// Bodies out of a line of TOML, for the tests.
#pragma once
#include "rigid/bodies.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

namespace weir::test {

/// A scene of 4 m by 4 m (by 4 m) that knows nothing but bodies and solids.
inline scene::Scene body_scene(int dim, const std::string& lines) {
    static const std::vector<scene::SolverSchema> schemas{{.name = "bodies", .doc = "Bodies alone.", .keys = {rigid::bodies_key()}}};
    return scene::parse(fmt::format("solver = \"bodies\"\ndim = {0}\ngrid = {{ cells = {1}, size = {2} }}\ntime = {{ end = 1.0 }}\n{3}\n",
                                    dim, dim == 2 ? "[40, 40]" : "[40, 40, 40]", dim == 2 ? "[4.0, 4.0]" : "[4.0, 4.0, 4.0]", lines),
                        "bodies.toml", schemas);
}

/// The table of a shape: the first body of a scene.
inline scene::Table shape_table(int dim, const std::string& shape) {
    return body_scene(dim, "bodies = [ { density = 1.0, " + shape + " } ]").root().tables("bodies")[0];
}

}  // namespace weir::test
