// A rigid body: its properties, state and torque-free motion. The rotation uses the splitting of Dullweber, Leimkuhler & McLachlan 1997
// ("Symplectic splitting methods for rigid body molecular dynamics"): a product of exact rotations about the principal axes, composed to
// fourth order (Suzuki 1990). It conserves the angular momentum to round-off, and the energy does not drift.
#pragma once
#include "core/checkpoint.hpp"
#include "geometry/motion.hpp"
#include "geometry/shape.hpp"
#include "rigid/moments.hpp"

#include <array>
#include <string>
#include <vector>

namespace weir::rigid {

inline Vec<3> cross(const Vec<3>& a, const Vec<3>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// Components of a rigid velocity: D of translation, then the rotation about z (2D) or about x, y and z.
template <int D>
inline constexpr int freedoms = D == 2 ? 3 : 6;
template <int D>
using Twist = std::array<real, freedoms<D>>;

/// 3D: the unit quaternion (w, x, y, z) of the rotation from the scene's orientation. 2D: the angle, then zeros.
using Orientation = std::array<real, 4>;

/// A contact sphere: a ball inside a body that touches its surface.
template <int D>
struct ContactSphere {
    Vec<D> at{};  // at the scene's initial position [m]
    real radius = 0;
};

template <int D>
struct Body {
    std::string name;
    geometry::ShapePtr<D> shape;
    std::vector<ContactSphere<D>> contact_spheres;
    Moments<D> moments;  // of the shape, density 1
    Vec<D> centre{};     // of mass, at the scene's initial position [m]
    real radius = 0;     // of a bounding ball about the centre of mass [m]
    real mass = 0;       // [kg; per metre of depth in 2D]
    Vec<3> principal{};  // moments of inertia about the centre of mass [kg m²]; 2D: the last one
    std::array<Vec<3>, 3> axes{Vec<3>::unit(0), Vec<3>::unit(1), Vec<3>::unit(2)};  // 3D: their axes, in the scene's initial orientation
    std::array<bool, freedoms<D>> held{};                                           // velocities fixed by the scene
    bool no_slip = false;
    real friction = 0, restitution = 0;

    // State
    Vec<D> at{};  // of the centre of mass [m]
    Orientation orientation{1, 0, 0, 0};
    Twist<D> velocity{};       // [m/s], then [rad/s]
    bool touches = false;      // had contact, or a joint, in the last step
    real wet = 0;              // liquid volume fraction at its surface in that step, in [0, 1]
    Twist<D> force{};          // force of the fluid, mean over the last step [N], then torque about the centre of mass [N m]
    Twist<D> viscous{};        // the viscous part of that
    bool has_viscous = false;  // viscous: its part is written

    real density() const { return mass / moments.volume; }
    /// Pose and velocity field, as for solids.
    geometry::Pose<D> pose() const;
    /// Mass, then the inertia tensor in space; row by row.
    std::array<Twist<D>, freedoms<D>> mass_matrix() const;
    real kinetic_energy() const;
    real max_speed() const;           // upper bound for all its points
    Vec<3> angular_momentum() const;  // about the centre of mass; 2D: about z, in the last entry
    /// Free motion for a time dt: with its velocity, or, without water and walls, along the parabola of `gravity`; the velocity change by
    /// gravity is applied later.
    void advance_free(real dt, const Vec<D>& gravity);
    /// Translates [m] and rotates [rad] it, independent of its velocity.
    void shift(const Twist<D>& by);
    /// Mass and inertia from the shape's moments of unit density, about the centre of mass.
    void weigh(real total_mass, const Vec<D>& centre_of_mass);

    void save(Checkpoint& to, const std::string& name) const;
    void restore(const Checkpoint& from, const std::string& name);

private:
    void rotate(real dt);
    void turn_freely(real dt);
};

/// Rows of the rotation matrix.
template <int D>
std::array<Vec<D>, D> rotation(const Orientation& q);

/// Eigenvalues and eigenvectors of a symmetric matrix (Jacobi rotations).
void diagonalise(std::array<Vec<3>, 3> matrix, Vec<3>& values, std::array<Vec<3>, 3>& vectors);

}  // namespace weir::rigid
