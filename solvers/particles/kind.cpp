#include "particles/kind.hpp"

#include "particles/heat.hpp"
#include "rigid/bodies.hpp"
#include "rigid/joints.hpp"
#include "scene/surface_keys.hpp"

namespace weir::particles {

scene::SolverSchema schema_of(scene::SolverSchema own, const std::vector<scene::Key>& in_initial) {
    scene::Key initial = initial_key();
    initial.keys.insert(initial.keys.end(), in_initial.begin(), in_initial.end());
    initial.keys.push_back(initial_temperature_key());
    own.keys.push_back(std::move(initial));
    own.keys.push_back(sinks_key());
    own.keys.push_back(rigid::bodies_key());
    own.keys.push_back(rigid::joints_key());
    own.keys.push_back(rigid::probe_key());
    for (scene::Key& key : heat_keys()) own.keys.push_back(std::move(key));
    own.keys.push_back(scene::surface_key_of_particles());
    const auto shared = effect_schemas();
    for (const char* key : {"time.stop_when_steady", "sides.*.smoke", "sides.*.profile", "emitters.smoke", "initial.smoke"})
        own.without.push_back(key);
    own.effects.insert(own.effects.begin(), shared.begin(), shared.end());
    return own;
}

void refuse_over_ranks(const scene::Scene& scene) {
    const auto refuse = [&](const std::string& key, const std::string& what) {
        scene.refuse(key, key + ": " + what + " in one process only");
    };
    if (scene.has("bodies") && !scene.root().tables("bodies").empty()) refuse("bodies", "bodies move");
    if (heat_is_named(scene)) refuse("substance", "a substance is heated");
    if (scene.effect("hand")) refuse("effects.hand", "the hand pushes");
    if (backend_of(scene).kind != backend::Choice::Kind::threads) refuse("scheme.backend", "this backend runs");
}

scene::PlainStep plain_step(std::vector<std::string> more_fields, std::vector<std::string> passes) {
    std::vector<std::string> fields{"position", "velocity", "density", "id"};
    fields.insert(fields.end(), more_fields.begin(), more_fields.end());
    return {fields, std::move(passes),
            "liquid = [ { shape = \"box\", min = <0.0>, max = <0.5> } ]\ninitial.velocity = { name = \"rotation\", omega = 1.0, centre = "
            "<0.25> }"};
}

}  // namespace weir::particles
