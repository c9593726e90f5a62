// The hand: a round brush that pushes the fluid it covers to a velocity, pulls it together, pours or drains, by keyframes. A keyframe holds
// until the next, so that what comes later never changes what has been: a hand that is recorded while a run goes on repeats it bit for bit.
//
//   du/dt = rate w(x) (target − u),   w = (1 − |x − centre|²/radius²)² inside the brush,
//
// taken exactly over the step, u += (1 − exp(−rate w dt)) (target − u): stable for any rate. A target is cut to one cell (or spacing of
// particles) a step. What it gives is accounted for: momentum and mass since the start.
#pragma once
#include "core/checkpoint.hpp"
#include "core/types.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace weir {

enum class HandKind { off, push, pull, pour, drain };
inline constexpr std::array hand_kinds{"off", "push", "pull", "pour", "drain"};  // in the order of HandKind

struct HandKey {
    real time = 0;  // from here on [s]
    HandKind kind = HandKind::off;
    Vec<3> centre{};
    real radius = 0;
    Vec<3> velocity{};  // the target of push and pour [m/s]
    real speed = 0;     // of pull, at the brush's edge towards its centre [m/s]
};

/// The brush of a step.
template <int D>
struct Brush {
    HandKind kind = HandKind::off;
    Vec<D> centre{}, velocity{};
    real radius = 0, speed = 0;

    bool moves() const { return kind == HandKind::push || kind == HandKind::pull || kind == HandKind::pour; }
    bool covers(const Vec<D>& x) const { return dot(x - centre, x - centre) < radius * radius; }
    real weight(const Vec<D>& x) const {
        const real s = 1 - dot(x - centre, x - centre) / (radius * radius);
        return s > 0 ? s * s : 0;
    }
    /// No component faster than `most` [m/s].
    Vec<D> target(const Vec<D>& x, const Vec<D>& most) const {
        Vec<D> u = kind == HandKind::pull ? speed / radius * (centre - x) : velocity;
        for (int a = 0; a < D; ++a) u[a] = std::clamp(u[a], -most[a], most[a]);
        return u;
    }
};

struct Hand {
    std::vector<HandKey> keys;  // in the order of time
    real rate = 0;              // [1/s]
    Vec<3> impulse{};           // given to the fluid since the start, poured and drained liquid's momentum included [kg m/s]
    real mass = 0;              // poured less drained [kg]

    /// In the step that begins at t.
    template <int D>
    Brush<D> at(real t) const {
        const auto next = std::upper_bound(keys.begin(), keys.end(), t, [](real time, const HandKey& key) { return time < key.time; });
        if (next == keys.begin()) return {};
        const HandKey& key = *std::prev(next);
        Brush<D> brush{key.kind, {}, {}, key.radius, key.speed};
        for (int a = 0; a < D; ++a) brush.centre[a] = key.centre[a], brush.velocity[a] = key.velocity[a];
        return brush;
    }
    /// How much of the way to the target a place of this weight goes in a step.
    real share(real weight, real dt) const { return -std::expm1(-rate * weight * dt); }

    void save(Checkpoint& to) const { to.put_value("hand", std::array<real, 4>{impulse[0], impulse[1], impulse[2], mass}); }
    void restore(const Checkpoint& from) {
        const auto given = from.get_value<std::array<real, 4>>("hand");
        impulse = {{given[0], given[1], given[2]}}, mass = given[3];
    }
};

}  // namespace weir
