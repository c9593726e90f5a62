// The options of the surface in a scene's frames.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <optional>

namespace weir::surfaces {

/// From a level set directly; from particles by the distance to their weighted mean (Zhu & Bridson 2005), by anisotropic kernels (Yu & Turk
/// 2013), or by their density, smoothed where there are many particles (Loeschner, Boettcher, Jeske & Bender 2023).
enum class Method { level_set, zhu_bridson, anisotropic, density };

struct Options {
    Method method = Method::zhu_bridson;
    real cell = 1;      // between samples, in particle spacings
    int smoothing = 0;  // passes over the mesh
};

/// The scene's options; nullopt where it names no surface.
std::optional<Options> options_of(const scene::Scene& scene);
/// Range beyond a rank's planes of samples in which it reads particles, rounded to its cells [spacings].
real read_beside(const Options& options);
/// The method of that name; throws std::logic_error where there is none.
Method method_named(std::string_view name);

}  // namespace weir::surfaces
