// The surroundings of a scene: their temperature, and the pressure that they put on the matter, constant or by keyframes.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace weir::matter {

/// The key "ambient" of the table "heat".
scene::Key ambient_key();
/// The same of particles, whose pressure is seen by what boils alone.
scene::Key ambient_key_of_particles();

class Ambient {
public:
    Ambient() = default;
    /// Of a scene whose solver has the table "heat". Refuses keyframes that are out of order or say one thing only here and there.
    explicit Ambient(const scene::Scene& scene);

    bool has_temperature() const { return !temperature_.empty(); }
    bool pressure_changes() const { return pressure_.size() > 1; }
    real temperature(real t) const { return at(temperature_, t); }  // [K]
    real pressure(real t) const { return at(pressure_, t); }        // heat.pressure where no keyframe says another [Pa]
    real lowest_pressure() const;                                   // of all times [Pa]
    real highest_pressure() const;                                  // [Pa]
    /// Until the next keyframe; ∞ after the last [s].
    real to_next_frame(real t) const;

private:
    struct Frame {
        real t, value;
    };
    /// On the straight line between neighbours; the first and the last value outside.
    static real at(const std::vector<Frame>& frames, real t);
    std::vector<Frame> temperature_, pressure_;
};

}  // namespace weir::matter
