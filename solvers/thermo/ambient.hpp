// The surroundings of a scene: their temperature and pressure, constant or by keyframes.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace weir::thermo {

/// The key "ambient" of the table "heat".
scene::Key ambient_key();
/// The same for particles, whose pressure only affects boiling.
scene::Key ambient_key_of_particles();

class Ambient {
public:
    Ambient() = default;
    /// For a scene whose solver has the table "heat". Rejects keyframes that are out of order, or in which a value is given only in some.
    explicit Ambient(const scene::Scene& scene);

    bool has_temperature() const { return !temperature_.empty(); }
    bool pressure_changes() const { return pressure_.size() > 1; }
    real temperature(real t) const { return at(temperature_, t); }  // [K]
    real pressure(real t) const { return at(pressure_, t); }        // heat.pressure where no keyframe gives another value [Pa]
    real lowest_pressure() const;                                   // over all times [Pa]
    real highest_pressure() const;                                  // [Pa]
    /// Time to the next keyframe; ∞ after the last [s].
    real to_next_frame(real t) const;

private:
    struct Frame {
        real t, value;
    };
    /// Linear between neighbours; constant outside.
    static real at(const std::vector<Frame>& frames, real t);
    std::vector<Frame> temperature_, pressure_;
};

}  // namespace weir::thermo
