// Scenes of procedural waves for the tests.
#pragma once
#include "core/parallel.hpp"
#include "support/test.hpp"
#include "waves/solver.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace weir::test {

inline scene::Scene wave_scene(int dim, const std::string& cells, const std::string& size, const std::string& rest) {
    static const std::vector<scene::SolverSchema> schemas{waves::kind().schema};
    const std::string g = dim == 2 ? "[0.0, -9.81]" : "[0.0, -9.81, 0.0]", low = dim == 2 ? "[0.0, -5.0]" : "[0.0, -5.0, 0.0]";
    return scene::parse("solver = \"waves\"\ndim = " + std::to_string(dim) + "\ngrid = { cells = " + cells + ", size = " + size +
                            ", origin = " + low + " }\ntime.end = 100.0\neffects.gravity = { g = " + g + " }\n" + rest,
                        "waves.toml", schemas);
}

/// A sea on a tile of 200 m by 150 m, with cells that are no squares.
inline scene::Scene sea_scene(const std::string& more, const std::string& cells = "[48, 1, 36]", const std::string& rest = "") {
    return wave_scene(
        3, cells, "[200.0, 10.0, 150.0]",
        "waves = { model = \"spectrum\", spectrum = { kind = \"pierson_moskowitz\", wind = 8.0 }, heading = 0.7" + more + " }\n" + rest);
}

inline std::vector<real> values_of(const waves::Waves& solver, std::string_view field, int component = 0) {
    const FieldSet fields = solver.fields();
    const auto& data = fields.find(field)->data.at(static_cast<std::size_t>(component));
    return {data.begin(), data.end()};
}

template <std::size_t N>
std::array<real, N> ask(const waves::Waves& solver, const char* field, const Vec<3>& at) {
    std::array<real, N> values{};
    EXPECT_TRUE(solver.answer(field, at, values)) << field;
    return values;
}

/// Centre of the cell (i, k) of a sheet.
inline Vec<3> middle_of(const FieldSet& fields, int i, int k) {
    const GridView& g = fields.grid;
    return {{g.origin[0] + (i + 0.5) * g.spacing[0], g.origin[1] + 0.5 * g.spacing[1],
             g.dim == 3 ? g.origin[2] + (k + 0.5) * g.spacing[2] : 0}};
}

}  // namespace weir::test
