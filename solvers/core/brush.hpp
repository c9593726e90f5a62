// Interactive forcing: a round brush with keyframes. It drives the fluid that it covers towards a velocity, pulls it together, adds,
// removes or heats it, or grabs a body. A keyframe applies until the next one, so later keyframes never change the past: replaying a
// recorded run repeats it bit for bit.
//
//   du/dt = rate w(x) (target − u),   w = (1 − |x − centre|²/radius²)² inside the brush,
//
// integrated exactly over the step, u += (1 − exp(−rate w dt)) (target − u): stable for any rate. The target speed is limited to one cell
// (or particle spacing) per step. Heat relaxes in the same way towards the enthalpy of a temperature. A body gets the acceleration rate
// (target − v) of its centre of mass, target = (rate/4) (centre − x): a critically damped spring. Momentum, mass and heat added since the
// start are recorded.
#pragma once
#include "core/checkpoint.hpp"
#include "core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

namespace weir {

enum class BrushKind { off, push, pull, pour, drain, heat, grab };
inline constexpr std::array brush_kinds{"off", "push", "pull", "pour", "drain", "heat", "grab"};  // in the order of BrushKind

struct BrushKeyframe {
    real time = 0;  // applies from this time on [s]
    BrushKind kind = BrushKind::off;
    Vec<3> centre{};
    real radius = 0;
    Vec<3> velocity{};     // the target of push and pour [m/s]
    real speed = 0;        // of pull, at the brush's edge towards its centre; of a surface's rise or fall in height fields [m/s]
    real temperature = 0;  // the target of heat [K]
    int body = -1;         // the body that grab acts on
};

/// The brush during one step.
template <int D>
struct Brush {
    BrushKind kind = BrushKind::off;
    Vec<D> centre{}, velocity{};
    real radius = 0, speed = 0, temperature = 0;
    int body = -1;

    bool moves() const { return kind == BrushKind::push || kind == BrushKind::pull || kind == BrushKind::pour; }
    bool covers(const Vec<D>& x) const { return dot(x - centre, x - centre) < radius * radius; }
    real weight(const Vec<D>& x) const {
        const real s = 1 - dot(x - centre, x - centre) / (radius * radius);
        return s > 0 ? s * s : 0;
    }
    /// The target velocity, each component limited to `most` [m/s].
    Vec<D> target(const Vec<D>& x, const Vec<D>& most) const {
        Vec<D> u = kind == BrushKind::pull ? speed / radius * (centre - x) : velocity;
        for (int a = 0; a < D; ++a) u[a] = std::clamp(u[a], -most[a], most[a]);
        return u;
    }
};

struct BrushForcing {
    std::vector<BrushKeyframe> keys;  // in the order of time
    real rate = 0;                    // [1/s]
    Vec<3> impulse{};  // added to the fluid since the start, including the momentum of liquid that was poured or drained [kg m/s]
    real mass = 0;     // poured minus drained [kg]
    real heat = 0;     // added to the fluid since the start [J]
    std::array<bool, brush_kinds.size()> can{};  // the kinds that the solver supports in this scene

    void allow(std::initializer_list<BrushKind> kinds) {
        for (const BrushKind kind : kinds) can[static_cast<std::size_t>(kind)] = true;
    }
    bool has(BrushKind kind) const { return can[static_cast<std::size_t>(kind)]; }

    /// The brush in the step that begins at t.
    template <int D>
    Brush<D> at(real t) const {
        const auto next =
            std::upper_bound(keys.begin(), keys.end(), t, [](real time, const BrushKeyframe& key) { return time < key.time; });
        if (next == keys.begin()) return {};
        const BrushKeyframe& key = *std::prev(next);
        Brush<D> brush{key.kind, {}, {}, key.radius, key.speed, key.temperature, key.body};
        for (int a = 0; a < D; ++a) brush.centre[a] = key.centre[a], brush.velocity[a] = key.velocity[a];
        return brush;
    }
    /// Fraction of the difference to the target that one step removes at a point of this weight.
    real share(real weight, real dt) const { return -std::expm1(-rate * weight * dt); }

    void save(Checkpoint& to) const { to.put_value("hand", std::array<real, 5>{impulse[0], impulse[1], impulse[2], mass, heat}); }
    void restore(const Checkpoint& from) {
        const auto given = from.get_value<std::array<real, 5>>("hand");
        impulse = {{given[0], given[1], given[2]}}, mass = given[3], heat = given[4];
    }
};

}  // namespace weir
