// Prescribed rigid motion of solids: pose and velocity field as functions of time.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <array>
#include <vector>

namespace weir::geometry {

/// A rigid placement: x_world = centre + R (x_rest − centre) + offset, with its velocity field
/// v(x) = velocity + spin × (x − centre − offset).
template <int D>
struct Pose {
    Vec<D> centre{}, offset{}, velocity{};  // [m], [m], [m/s]
    std::array<Vec<D>, D> rotation;         // rows of R
    std::array<real, 3> spin{};             // angular velocity about x, y, z [rad/s]; 2D uses z

    Pose() {
        for (int d = 0; d < D; ++d) rotation[static_cast<std::size_t>(d)] = Vec<D>::unit(d);
    }
    Vec<D> to_rest(const Vec<D>& world) const {
        const Vec<D> y = world - offset - centre;
        Vec<D> x = centre;  // Rᵀ y: rotations are orthogonal
        for (int row = 0; row < D; ++row) x += y[row] * rotation[static_cast<std::size_t>(row)];
        return x;
    }
    Vec<D> to_world(const Vec<D>& rest) const;
    Vec<D> velocity_at(const Vec<D>& world) const;
};

/// One key frame: at time t the solid is translated by `offset` and rotated by `angle`; linear in between, at rest outside the frames.
template <int D>
struct Keyframe {
    real t = 0;
    Vec<D> offset{};
    real angle = 0;
};

template <int D>
class Motion {
public:
    enum class Kind { none, constant, sinusoidal, rotation, keyframes };

    Motion() = default;
    static Motion constant(const Vec<D>& velocity);
    /// offset(t) = amplitude (sin(2π frequency t + phase) − sin(phase)); starts at the scene's position.
    static Motion sinusoidal(const Vec<D>& amplitude, real frequency, real phase);
    /// Rotates about `centre` (3D: about `axis` through it) at `rate` [rad/s].
    static Motion rotating(const Vec<D>& centre, const std::array<real, 3>& axis, real rate);
    static Motion keyframed(std::vector<Keyframe<D>> frames, const Vec<D>& centre, const std::array<real, 3>& axis);
    /// From a scene's table { kind = "sinusoidal", ... }; `shape_centre` is the default centre of rotation.
    static Motion make(const scene::Table& table, const Vec<D>& shape_centre);

    bool moves() const { return kind_ != Kind::none; }
    Pose<D> pose(real t) const;

private:
    Pose<D> turned(real angle, real rate) const;
    Kind kind_ = Kind::none;
    Vec<D> vector_{}, centre_{};
    std::array<real, 3> axis_{0, 0, 1};
    real frequency_ = 0, phase_ = 0, rate_ = 0;
    std::vector<Keyframe<D>> frames_;
};

}  // namespace weir::geometry
