// Rejects keys that are not supported in parallel, with the same message for all solvers.
#pragma once
#include "scene/scene.hpp"

#include <string>

namespace weir::scene {

/// The message about a key that is not supported in parallel: "effects.hand: the hand pushes in one process only".
[[noreturn]] inline void one_process_only(const Scene& scene, const std::string& key, const std::string& what) {
    scene.refuse(key, key + ": " + what + " in one process only");
}

inline void refuse_hand(const Scene& scene) {
    if (scene.effect("hand")) one_process_only(scene, "effects.hand", "the hand pushes");
}

inline void refuse_bodies(const Scene& scene) {
    if (scene.has("bodies") && !scene.root().tables("bodies").empty()) one_process_only(scene, "bodies", "bodies move");
}

}  // namespace weir::scene
