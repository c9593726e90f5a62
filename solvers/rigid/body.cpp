#include "rigid/body.hpp"

#include <algorithm>
#include <cmath>

namespace weir::rigid {

namespace {

Orientation product(const Orientation& p, const Orientation& q) {
    return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3], p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1], p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

/// The rotation by `angle` about a unit axis.
Orientation turn_about(const Vec<3>& axis, real angle) {
    const real s = std::sin(0.5 * angle);
    return {std::cos(0.5 * angle), s * axis[0], s * axis[1], s * axis[2]};
}

void normalise(Orientation& q) {
    const real length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (real& c : q) c /= length;
}

Vec<3> times(const std::array<Vec<3>, 3>& rows, const Vec<3>& v) { return {{dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}}; }
Vec<3> transposed_times(const std::array<Vec<3>, 3>& rows, const Vec<3>& v) { return v[0] * rows[0] + v[1] * rows[1] + v[2] * rows[2]; }

template <int D>
Vec<3> spin_of(const Body<D>& body) {
    if constexpr (D == 2) return {{0, 0, body.velocity[2]}};
    return {{body.velocity[3], body.velocity[4], body.velocity[5]}};
}

/// Returns whether the shape is a ball, equal to its single contact sphere.
template <int D>
bool is_ball(const Body<D>& body) {
    if (body.contact_spheres.size() != 1) return false;
    const real r = body.contact_spheres[0].radius, ball = D == 2 ? pi * r * r : 4 * pi / 3 * r * r * r;
    return std::abs(body.moments.volume - ball) < 1e-9 * ball;
}

/// Rotation per substep [rad]: the splitting error is of fourth order in it.
constexpr real turn_of_part = 0.02;
constexpr int most_parts = 100000;

}  // namespace

template <>
std::array<Vec<2>, 2> rotation<2>(const Orientation& q) {
    const real c = std::cos(q[0]), s = std::sin(q[0]);
    return {Vec<2>{{c, -s}}, Vec<2>{{s, c}}};
}

template <>
std::array<Vec<3>, 3> rotation<3>(const Orientation& q) {
    const real w = q[0], x = q[1], y = q[2], z = q[3];
    return {Vec<3>{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)}},
            Vec<3>{{2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)}},
            Vec<3>{{2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

void diagonalise(std::array<Vec<3>, 3> m, Vec<3>& values, std::array<Vec<3>, 3>& vectors) {
    vectors = {Vec<3>::unit(0), Vec<3>::unit(1), Vec<3>::unit(2)};
    for (int sweep = 0; sweep < 50; ++sweep)
        for (std::size_t p = 0; p < 2; ++p)
            for (std::size_t q = p + 1; q < 3; ++q) {
                if (m[p][q] == 0) continue;
                const real theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
                const real t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const real c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (std::size_t k = 0; k < 3; ++k) {
                    const real a = m[k][p], b = m[k][q];
                    m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
                }
                for (std::size_t k = 0; k < 3; ++k) {
                    const real a = m[p][k], b = m[q][k];
                    m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
                }
                m[p][q] = m[q][p] = 0;
                const Vec<3> a = vectors[p], b = vectors[q];
                vectors[p] = c * a - s * b, vectors[q] = s * a + c * b;
            }
    for (std::size_t a = 0; a < 3; ++a) values[a] = m[a][a];
    if (dot(cross(vectors[0], vectors[1]), vectors[2]) < 0) vectors[2] = -vectors[2];
}

template <int D>
geometry::Pose<D> Body<D>::pose() const {
    geometry::Pose<D> p;
    p.centre = centre;
    p.offset = at - centre;
    p.rotation = rotation<D>(orientation);
    for (int a = 0; a < D; ++a) p.velocity[a] = velocity[static_cast<std::size_t>(a)];
    const Vec<3> w = spin_of(*this);
    p.spin = {w[0], w[1], w[2]};
    return p;
}

template <int D>
std::array<Twist<D>, freedoms<D>> Body<D>::mass_matrix() const {
    std::array<Twist<D>, freedoms<D>> m{};
    for (std::size_t a = 0; a < D; ++a) m[a][a] = mass;
    if constexpr (D == 2) {
        m[2][2] = principal[2];
    } else {
        const auto rows = rotation<3>(orientation);
        for (int k = 0; k < 3; ++k) {
            const Vec<3> axis = times(rows, axes[static_cast<std::size_t>(k)]);
            for (std::size_t a = 0; a < 3; ++a)
                for (std::size_t b = 0; b < 3; ++b) m[3 + a][3 + b] += principal[k] * axis[a] * axis[b];
        }
    }
    return m;
}

template <int D>
Vec<3> Body<D>::angular_momentum() const {
    const auto m = mass_matrix();
    Vec<3> l{};
    for (std::size_t a = D; a < m.size(); ++a)
        for (std::size_t b = D; b < m.size(); ++b) l[a - D + (D == 2 ? 2 : 0)] += m[a][b] * velocity[b];
    return l;
}

template <int D>
real Body<D>::max_speed() const {
    real moves = 0, turns = 0;
    for (std::size_t k = 0; k < freedoms<D>; ++k) (k < D ? moves : turns) += velocity[k] * velocity[k];
    // Rotation moves no surface point of a ball except by the offset of its middle. Otherwise a massless ball, which the error of grid
    // faces accelerates to metres per second, would limit every step needlessly.
    const real arm = is_ball(*this) && !no_slip ? norm(contact_spheres[0].at - centre) : radius;
    return std::sqrt(moves) + arm * std::sqrt(turns);
}

template <int D>
real Body<D>::kinetic_energy() const {
    const auto m = mass_matrix();
    real energy = 0;
    for (std::size_t a = 0; a < m.size(); ++a)
        for (std::size_t b = 0; b < m.size(); ++b) energy += 0.5 * velocity[a] * m[a][b] * velocity[b];
    return energy;
}

template <int D>
void Body<D>::advance_free(real dt, const Vec<D>& gravity) {
    for (int a = 0; a < D; ++a) {
        const auto k = static_cast<std::size_t>(a);
        if (held[k]) continue;
        at[a] += dt * velocity[k];
        if (wet == 0 && !touches) at[a] += 0.5 * dt * dt * gravity[a];
    }
    rotate(dt);
}

template <int D>
void Body<D>::rotate(real dt) {
    if constexpr (D == 2) {
        orientation[0] += dt * velocity[2];
    } else {
        const Vec<3> w = spin_of(*this);
        const real speed = norm(w);
        if (speed == 0) return;
        if (!held[3] && !held[4] && !held[5] && principal[0] > 0 && principal[1] > 0 && principal[2] > 0) return turn_freely(dt);
        orientation = product(turn_about(w / speed, speed * dt), orientation);
        normalise(orientation);
    }
}

template <int D>
void Body<D>::shift(const Twist<D>& by) {
    for (int a = 0; a < D; ++a) at[a] += by[static_cast<std::size_t>(a)];
    if constexpr (D == 2) {
        orientation[0] += by[2];
    } else {
        const Vec<3> rotation{{by[3], by[4], by[5]}};
        const real angle = norm(rotation);
        if (angle == 0) return;
        orientation = product(turn_about(rotation / angle, angle), orientation);
        normalise(orientation);
    }
}

/// In the principal frame the angular momentum rotates opposite to the body.
template <int D>
void Body<D>::turn_freely(real dt) {
    if constexpr (D == 3) {
        const Vec<3> in_space = angular_momentum();
        Vec<3> l = times(axes, transposed_times(rotation<3>(orientation), in_space));
        const int parts =
            static_cast<int>(std::clamp(std::ceil(norm(spin_of(*this)) * std::abs(dt) / turn_of_part), 1.0, 1.0 * most_parts));
        const auto about = [&](int i, real time) {
            const auto k = static_cast<std::size_t>(i);
            const real angle = time * l[i] / principal[i], c = std::cos(angle), s = std::sin(angle);
            const int j = (i + 1) % 3, m = (i + 2) % 3;
            const real a = l[j], b = l[m];
            l[j] = c * a + s * b, l[m] = c * b - s * a;
            orientation = product(orientation, turn_about(axes[k], angle));
        };
        const real p = 1 / (4 - std::cbrt(4.0));
        for (int part = 0; part < parts; ++part)
            for (const real weight : {p, p, 1 - 4 * p, p, p}) {
                const real time = weight * dt / parts;
                about(0, 0.5 * time), about(1, 0.5 * time), about(2, time), about(1, 0.5 * time), about(0, 0.5 * time);
            }
        normalise(orientation);
        // the momentum in space is conserved: the velocity follows from it and the new orientation
        const Vec<3> now = times(axes, transposed_times(rotation<3>(orientation), in_space));
        Vec<3> w{};
        for (int i = 0; i < 3; ++i) w += (now[i] / principal[i]) * axes[static_cast<std::size_t>(i)];
        w = times(rotation<3>(orientation), w);
        for (int a = 0; a < 3; ++a) velocity[static_cast<std::size_t>(3 + a)] = w[a];
    }
}

template <int D>
void Body<D>::weigh(real total_mass, const Vec<D>& centre_of_mass) {
    mass = total_mass;
    at = centre = centre_of_mass;
    const Vec<D> away = moments.centre - centre;
    std::array<Vec<3>, 3> second{}, inertia{};  // about the centre of mass
    real trace = 0;
    for (std::size_t a = 0; a < D; ++a) {
        for (std::size_t b = 0; b < D; ++b) second[a][b] = density() * (moments.second[a][b] + moments.volume * away[a] * away[b]);
        trace += second[a][a];
    }
    if constexpr (D == 2) {
        principal[2] = trace;
    } else {
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b) inertia[a][b] = (a == b ? trace : 0) - second[a][b];
        diagonalise(inertia, principal, axes);
    }
}

template <int D>
void Body<D>::save(Checkpoint& to, const std::string& block) const {
    to.put_value(block + "at", at);
    to.put_value(block + "orientation", orientation);
    to.put_value(block + "velocity", velocity);
    to.put_value(block + "force", force);
    if (has_viscous) to.put_value(block + "viscous", viscous);
    to.put_value(block + "wet", wet);
    to.put_value(block + "touches", touches);
}

template <int D>
void Body<D>::restore(const Checkpoint& from, const std::string& block) {
    at = from.template get_value<Vec<D>>(block + "at");
    orientation = from.template get_value<Orientation>(block + "orientation");
    velocity = from.template get_value<Twist<D>>(block + "velocity");
    force = from.template get_value<Twist<D>>(block + "force");
    if (has_viscous) viscous = from.template get_value<Twist<D>>(block + "viscous");
    wet = from.template get_value<real>(block + "wet");
    touches = from.template get_value<char>(block + "touches") != 0;
    const auto require = [&](const char* which, const auto& value) {  // all are lists of reals
        Checkpoint::require_finite(block + which, {reinterpret_cast<const real*>(&value), sizeof value / sizeof(real)});
    };
    require("at", at), require("orientation", orientation), require("velocity", velocity), require("force", force), require("wet", wet);
}

template struct Body<2>;
template struct Body<3>;

}  // namespace weir::rigid
