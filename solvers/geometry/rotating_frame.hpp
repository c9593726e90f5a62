// A frame of reference that turns about a fixed axis, as that of a tank that rolls: the scene's coordinates turn with the tank, and the
// fluid feels (Batchelor 1967, section 3.2)
//     f = g(t) + Ω² r − dΩ/dt e × r − 2 Ω e × u
// with r the vector from the axis, e its direction, Ω = dθ/dt, and g(t) the scene's gravity seen from the turned frame.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"
#include "scene/schema.hpp"

#include <array>

namespace weir::geometry {

/// θ and its two derivatives at one time [rad, rad/s, rad/s²], and by how much gravity has turned along e_p and e_q [m/s²].
struct Roll {
    real angle = 0, rate = 0, acceleration = 0;
    std::array<real, 2> tilt{};
};

template <int D>
class RotatingFrame {
public:
    /// `table`: the effect's keys. Throws BadInput for a scene whose other parts would not turn with the tank.
    RotatingFrame(const scene::Table& table, const scene::Scene& scene);

    Roll at(real t) const;
    /// The axes of the plane of rotation: e × e_p = e_q.
    int p() const { return plane_[0]; }
    int q() const { return plane_[1]; }
    /// The scene's, which its own effect adds [m/s²].
    const Vec<D>& gravity() const { return gravity_; }
    /// The part of f that does not depend on u, less the scene's gravity; at x [m/s²].
    Vec<D> acceleration(const Roll& roll, const Vec<D>& x) const {
        const real rp = x[p()] - centre_[p()], rq = x[q()] - centre_[q()], squared = roll.rate * roll.rate;
        Vec<D> f{};
        f[p()] = roll.tilt[0] + squared * rp + roll.acceleration * rq;
        f[q()] = roll.tilt[1] + squared * rq - roll.acceleration * rp;
        return f;
    }
    /// Largest magnitude of that on the box [lo, hi] at any time, with the scene's gravity [m/s²].
    real most(const Vec<D>& lo, const Vec<D>& hi) const;

private:
    Vec<D> centre_{}, gravity_{};
    std::array<int, 2> plane_{0, 1};
    real rate_ = 0, amplitude_ = 0, omega_ = 0, phase_ = 0, ramp_ = 0;
};

/// The schema of the effect "rotating_frame".
scene::Variant rotating_frame_schema();

}  // namespace weir::geometry
