// Small MAC simulations for tests: a scene as text, its solver by type.
#pragma once
#include "smoke/solver.hpp"
#include "studies/kinds.hpp"
#include "studies/transport.hpp"

#include <cstring>
#include <string>
#include <vector>

namespace weir::test {

inline scene::Scene mac_scene(const std::string& text, const std::vector<scene::Override>& overrides = {}) {
    return scene::parse(text, "test.toml", {smoke::kind().schema, studies::transport_kind().schema, studies::poisson_kind().schema},
                        overrides);
}

/// "[n, n]" or "[n, n, n]".
inline std::string list(int dim, const std::string& value) {
    std::string text = "[" + value;
    for (int d = 1; d < dim; ++d) text.append(", ").append(value);
    return text.append("]");
}

/// A unit box of n cells an axis, and what `rest` adds to the scene.
inline std::string unit_box(int dim, int n, const std::string& rest) {
    return std::string("solver = \"mac\"\ndim = ")
        .append(std::to_string(dim))
        .append("\ngrid = { cells = ")
        .append(list(dim, std::to_string(n)))
        .append(", size = ")
        .append(list(dim, "1.0"))
        .append(" }\ntime = { end = 1.0 }\n")
        .append(rest);
}

/// Whether two solvers show the same bits.
inline bool same_bits(const Solver& a, const Solver& b) {
    const FieldSet left = a.fields(), right = b.fields();
    if (left.fields.size() != right.fields.size()) return false;
    for (std::size_t f = 0; f < left.fields.size(); ++f)
        for (std::size_t c = 0; c < left.fields[f].data.size(); ++c) {
            const auto x = left.fields[f].data[c], y = right.fields[f].data[c];
            if (x.size() != y.size() || std::memcmp(x.data(), y.data(), x.size_bytes()) != 0) return false;
        }
    return true;
}

}  // namespace weir::test
