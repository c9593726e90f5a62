#include "geometry/motion.hpp"

#include <cmath>
#include <stdexcept>

namespace weir::geometry {

template <int D>
Vec<D> Pose<D>::to_world(const Vec<D>& rest) const {
    Vec<D> x = centre + offset;
    for (int row = 0; row < D; ++row) x[row] += dot(rotation[static_cast<std::size_t>(row)], rest - centre);
    return x;
}

template <int D>
Vec<D> Pose<D>::velocity_at(const Vec<D>& world) const {
    const Vec<D> y = world - centre - offset;
    Vec<D> v = velocity;
    if constexpr (D == 2) {
        v[0] -= spin[2] * y[1];
        v[1] += spin[2] * y[0];
    } else {
        v[0] += spin[1] * y[2] - spin[2] * y[1];
        v[1] += spin[2] * y[0] - spin[0] * y[2];
        v[2] += spin[0] * y[1] - spin[1] * y[0];
    }
    return v;
}

template <int D>
Motion<D> Motion<D>::constant(const Vec<D>& velocity) {
    Motion m;
    m.kind_ = Kind::constant;
    m.vector_ = velocity;
    return m;
}

template <int D>
Motion<D> Motion<D>::sinusoidal(const Vec<D>& amplitude, real frequency, real phase) {
    Motion m;
    m.kind_ = Kind::sinusoidal;
    m.vector_ = amplitude;
    m.frequency_ = frequency;
    m.phase_ = phase;
    return m;
}

template <int D>
Motion<D> Motion<D>::rotating(const Vec<D>& centre, const std::array<real, 3>& axis, real rate) {
    Motion m;
    m.kind_ = Kind::rotation;
    m.centre_ = centre;
    m.axis_ = axis;
    m.rate_ = rate;
    return m;
}

template <int D>
Motion<D> Motion<D>::keyframed(std::vector<Keyframe<D>> frames, const Vec<D>& centre, const std::array<real, 3>& axis) {
    Motion m;
    m.kind_ = Kind::keyframes;
    m.frames_ = std::move(frames);
    m.centre_ = centre;
    m.axis_ = axis;
    return m;
}

/// Rodrigues' rotation by `angle` about the axis through the centre, with angular velocity `rate`.
template <int D>
Pose<D> Motion<D>::turned(real angle, real rate) const {
    Pose<D> pose;
    pose.centre = centre_;
    const real c = std::cos(angle), s = std::sin(angle);
    if constexpr (D == 2) {
        pose.rotation = {Vec<2>{{c, -s}}, Vec<2>{{s, c}}};
        pose.spin = {0, 0, rate};
    } else {
        const real length = std::sqrt(axis_[0] * axis_[0] + axis_[1] * axis_[1] + axis_[2] * axis_[2]);
        const real x = axis_[0] / length, y = axis_[1] / length, z = axis_[2] / length, k = 1 - c;
        pose.rotation = {Vec<3>{{c + x * x * k, x * y * k - z * s, x * z * k + y * s}},
                         Vec<3>{{y * x * k + z * s, c + y * y * k, y * z * k - x * s}},
                         Vec<3>{{z * x * k - y * s, z * y * k + x * s, c + z * z * k}}};
        pose.spin = {rate * x, rate * y, rate * z};
    }
    return pose;
}

template <int D>
Pose<D> Motion<D>::pose(real t) const {
    Pose<D> pose;
    switch (kind_) {
        case Kind::none:
            break;
        case Kind::constant:
            pose.offset = t * vector_;
            pose.velocity = vector_;
            break;
        case Kind::sinusoidal: {
            const real w = 2 * pi * frequency_;
            pose.offset = (std::sin(w * t + phase_) - std::sin(phase_)) * vector_;
            pose.velocity = (w * std::cos(w * t + phase_)) * vector_;
            break;
        }
        case Kind::rotation:
            return turned(rate_ * t, rate_);
        case Kind::keyframes: {
            if (t <= frames_.front().t || t >= frames_.back().t) {
                const auto& end = t <= frames_.front().t ? frames_.front() : frames_.back();
                pose = turned(end.angle, 0);
                pose.offset = end.offset;
                return pose;
            }
            std::size_t next = 1;
            while (frames_[next].t <= t) ++next;
            const auto &a = frames_[next - 1], &b = frames_[next];
            const real span = b.t - a.t, s = (t - a.t) / span;
            pose = turned((1 - s) * a.angle + s * b.angle, (b.angle - a.angle) / span);
            pose.offset = (1 - s) * a.offset + s * b.offset;
            pose.velocity = (b.offset - a.offset) / span;
            break;
        }
    }
    return pose;
}

template <int D>
Motion<D> Motion<D>::make(const scene::Table& table, const Vec<D>& shape_centre) {
    const std::string& kind = table.text("kind");
    const Vec<D> centre = table.has("centre") ? table.vec<D>("centre") : shape_centre;
    std::array<real, 3> axis{0, 0, 1};
    if (D == 3 && table.has("axis")) {
        const auto given = table.vec<3>("axis");
        axis = {given[0], given[1], given[2]};
    }
    if (kind == "constant") return constant(table.vec<D>("velocity"));
    if (kind == "sinusoidal") return sinusoidal(table.vec<D>("amplitude"), table.number("frequency"), table.number_or("phase", 0));
    if (kind == "rotation") return rotating(centre, axis, table.number("rate"));
    if (kind == "keyframes") {
        std::vector<Keyframe<D>> frames;
        for (const auto& frame : table.tables("frames")) {
            const Vec<D> offset = frame.has("offset") ? frame.template vec<D>("offset") : Vec<D>{};
            frames.push_back({frame.number("t"), offset, frame.number_or("angle", 0)});
        }
        return keyframed(std::move(frames), centre, axis);
    }
    throw std::logic_error("motion \"" + kind + "\" is in the schema but has no maker");
}

template struct Pose<2>;
template struct Pose<3>;
template class Motion<2>;
template class Motion<3>;

}  // namespace weir::geometry
