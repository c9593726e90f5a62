// The scene of one run of a case: the case's changes, then the sweep's.
#include "validation/harness/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// Numbers as TOML: whole ones without a point, so that they may set integers.
std::string text_of(real value) {
    return value == std::floor(value) && std::abs(value) < 1e15 ? fmt::format("{:.0f}", value)
                                                                : fmt::format("{}", value);  // the fewest digits that give it back
}

/// Cells for `count` along the sweep's axis, others in proportion; refused where that is not a whole number.
std::string scaled_cells(const Sweep& sweep, real count, const std::vector<double>& cells) {
    if (sweep.axis >= static_cast<int>(cells.size())) throw BadInput("the sweep's axis is not one of the scene");
    const real factor = count / cells[static_cast<std::size_t>(sweep.axis)];
    std::vector<std::string> scaled;
    for (std::size_t a = 0; a < cells.size(); ++a) {
        const bool kept = std::find(sweep.keep.begin(), sweep.keep.end(), static_cast<int>(a)) != sweep.keep.end();
        const real n = kept ? cells[a] : std::round(cells[a] * factor);
        if (!kept && std::abs(n - cells[a] * factor) > 1e-9 * n)
            throw BadInput(
                fmt::format("{} cells along {} would need {:g} along {}", count, "xyz"[sweep.axis], cells[a] * factor, "xyz"[a]));
        scaled.push_back(text_of(n));
    }
    return fmt::format("[{}]", fmt::join(scaled, ", "));
}

}  // namespace

scene::Scene scene_of(const Variant& variant, std::size_t i, const std::vector<scene::SolverSchema>& solvers) {
    std::vector<scene::Override> overrides = variant.overrides;
    if (variant.sweep) {
        const Sweep& sweep = *variant.sweep;
        for (const auto& follower : sweep.also) overrides.push_back({follower.key, text_of(follower.values.at(i))});
        if (sweep.key == "grid.cells") {
            const scene::Scene base = scene::read(variant.scene, solvers, variant.overrides);
            overrides.push_back({sweep.key, scaled_cells(sweep, sweep.values.at(i), base.root().numbers("grid.cells"))});
        } else {
            overrides.push_back({sweep.key, text_of(sweep.values.at(i))});
        }
    }
    return scene::read(variant.scene, solvers, overrides);
}

}  // namespace weir::validation
