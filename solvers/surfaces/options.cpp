#include "surfaces/options.hpp"

#include "surfaces/kernel.hpp"

#include <stdexcept>

namespace weir::surfaces {

Method method_named(std::string_view name) {
    if (name == "level_set") return Method::level_set;
    if (name == "zhu_bridson") return Method::zhu_bridson;
    if (name == "anisotropic") return Method::anisotropic;
    if (name == "density") return Method::density;
    throw std::logic_error("unknown surface method \"" + std::string(name) + "\"");
}

real read_beside(const Options& options) {
    if (options.method == Method::zhu_bridson) return reach + options.cell + reach;
    if (options.method == Method::density) return reach + options.cell + reach + 2 * reach;
    return far_reach * longest + farthest_move + options.cell + far_reach + 2 * reach;
}

std::optional<Options> options_of(const scene::Scene& scene) {
    if (!scene.has("output.surface")) return std::nullopt;
    Options options;
    const scene::Table& said = scene.root().table("output.surface");
    options.method = method_named(said.text("method"));
    options.cell = said.number_or("cell", 1);
    if (said.has("smoothing")) options.smoothing = static_cast<int>(said.integer("smoothing"));
    return options;
}

}  // namespace weir::surfaces
