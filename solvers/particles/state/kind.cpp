#include "particles/state/kind.hpp"

#include "particles/heat/heat.hpp"
#include "rigid/bodies.hpp"
#include "rigid/joints.hpp"
#include "scene/one_process.hpp"
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

void refuse_in_parallel(const scene::Scene& scene) {
    scene::refuse_bodies(scene);
    if (heat_is_named(scene)) scene::one_process_only(scene, "substance", "heating of a substance is");
    scene::refuse_brush(scene);
    if (backend_of(scene).kind != backend::Choice::Kind::threads) scene::one_process_only(scene, "scheme.backend", "this backend is");
}

scene::PlainStep plain_step(std::vector<std::string> more_fields, std::vector<std::string> passes) {
    std::vector<std::string> fields{"position", "velocity", "density", "id"};
    fields.insert(fields.end(), more_fields.begin(), more_fields.end());
    return {fields, std::move(passes),
            "liquid = [ { shape = \"box\", min = <0.0>, max = <0.5> } ]\ninitial.velocity = { name = \"rotation\", omega = 1.0, centre = "
            "<0.25> }"};
}

}  // namespace weir::particles
