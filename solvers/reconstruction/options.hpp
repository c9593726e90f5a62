// What a scene may say of the surface that its frames show.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <optional>

namespace weir::reconstruction {

/// From a level set as it is; from particles by the distance to their weighted mean (Zhu & Bridson 2005), by stretched kernels (Yu & Turk
/// 2013), or by their density, whose surface is smoothed where particles are many (Loeschner, Boettcher, Jeske & Bender 2023).
enum class Method { level_set, zhu_bridson, anisotropic, density };

struct Options {
    Method method = Method::zhu_bridson;
    real cell = 1;      // between samples, in particle spacings
    int smoothing = 0;  // passes over the mesh
};

/// What the scene says; nothing where it does not name a surface.
std::optional<Options> options_of(const scene::Scene& scene);
/// How far beyond the planes of samples that a rank has it reads particles, to a cell of its sort [spacings].
real read_beside(const Options& options);
/// By name; throws std::logic_error where there is none.
Method method_named(std::string_view name);

}  // namespace weir::reconstruction
