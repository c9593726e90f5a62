// The keys that a scene gives, and whether they were read: unread keys are rejected, so that no key is silently ignored.
#pragma once
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace weir::scene {

/// A value given in a scene, not a default.
struct GivenKey {
    std::string path;    // in the scene: "emitters[0].velocity", "sides.x_min.temperature"
    std::string schema;  // in the schema: "emitters.velocity", "sides.x_min<wall>.temperature"; "effects.viscosity" for the table itself
    std::string doc;
    bool read = false;
};
std::vector<GivenKey> given_keys(const Scene& scene, const SolverSchema& schema);
/// All keys allowed for this solver, in the notation of GivenKey::schema. Shapes and motions, which are recursive and common to all
/// solvers, are listed once: "<box>.min".
std::vector<std::string> every_key(const SolverSchema& schema);
/// The problems of given keys that were not read since Scene::forget_reading.
std::vector<Problem> ignored_keys(const Scene& scene, const SolverSchema& schema);

}  // namespace weir::scene
