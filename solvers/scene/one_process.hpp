// Rejects keys that are not supported in parallel, with the same message for all solvers.
#pragma once
#include "scene/scene.hpp"

#include <string>

namespace weir::scene {

/// One line about a feature without parallel (MPI) support: "effects.hand: interactive forcing is not supported in parallel (MPI); run in
/// one process".
[[noreturn]] inline void one_process_only(const Scene& scene, const std::string& key, const std::string& what) {
    scene.refuse(key, key + ": " + what + " not supported in parallel (MPI); run in one process");
}

inline void refuse_brush(const Scene& scene) {
    if (scene.effect("hand")) one_process_only(scene, "effects.hand", "interactive forcing is");
}

inline void refuse_bodies(const Scene& scene) {
    if (scene.has("bodies") && !scene.root().tables("bodies").empty()) one_process_only(scene, "bodies", "bodies are");
}

}  // namespace weir::scene
