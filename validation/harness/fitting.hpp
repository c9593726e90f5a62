// What metrics and references take for granted of a scene, and what is said where it is not so: `weir run --measure M --reference R` takes
// any scene.
#pragma once
#include "core/error.hpp"
#include "scene/scene.hpp"

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace weir::validation {

/// Parameters of an effect that the scene has to name.
inline const scene::Table& needed_effect(const scene::Scene& scene, std::string_view name) {
    if (const scene::Table* effect = scene.effect(name)) return *effect;
    throw BadInput("the scene has no effect \"" + std::string(name) + "\"");
}

/// f() of what is named `what`. A key that the scene lacks, or a list that is shorter than f reads, is bad input here.
template <class F>
auto fitting(std::string_view what, F&& f) {
    try {
        return std::forward<F>(f)();
    } catch (const std::logic_error& missing) {
        throw BadInput(std::string(what) + " does not fit this scene: " + missing.what());
    }
}

}  // namespace weir::validation
