// What a scene says, key by key, and whether anybody has read it: what nobody reads is refused, so nothing is ignored without a word.
#pragma once
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace weir::scene {

/// A value that a scene gives, not a default.
struct GivenKey {
    std::string path;    // in the scene: "emitters[0].velocity", "sides.x_min.temperature"
    std::string schema;  // in the schema: "emitters.velocity", "sides.x_min<wall>.temperature"; "effects.viscosity" for naming it
    std::string doc;
    bool read = false;
};
std::vector<GivenKey> given_keys(const Scene& scene, const SolverSchema& schema);
/// All that a scene of this solver may say, as GivenKey::schema names it; shapes and motions, which contain themselves and read the same
/// for every solver, once each: "<box>.min".
std::vector<std::string> every_key(const SolverSchema& schema);
/// What is wrong with a scene that gives keys which nobody has read since Scene::forget_reading.
std::vector<Problem> ignored_keys(const Scene& scene, const SolverSchema& schema);

}  // namespace weir::scene
