#include "geometry/rotating_frame.hpp"

#include "geometry/sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weir::geometry {

namespace {

constexpr real two_pi = 2 * std::numbers::pi_v<real>;

/// s(x) = x³ (10 − 15 x + 6 x²) on [0, 1] with its derivatives: the smoothest polynomial whose first two vanish at both ends.
struct Ramp {
    real value = 1, first = 0, second = 0;
    Ramp(real t, real duration) {
        if (t >= duration) return;
        const real x = std::max<real>(0, t / duration);
        value = x * x * x * (10 + x * (6 * x - 15));
        first = 30 * x * x * (1 - x) * (1 - x) / duration;
        second = 60 * x * (1 - x) * (1 - 2 * x) / (duration * duration);
    }
};

/// Throws BadScene for a side around the axis that does not turn with the tank.
template <int D>
void require_wall(const Sides<D>& sides, int axis, int end, const scene::Scene& scene) {
    if (sides.side(axis, end).kind == SideKind::wall) return;
    const std::string name = fmt::format("sides.{}_{}", "xyz"[axis], end == 0 ? "min" : "max");
    const bool named = scene.has(name);  // else grid.periodic names the axis
    scene.refuse(named ? name + ".kind" : "grid.periodic",
                 fmt::format("{} is \"{}\"; in a rotating frame the sides around the axis must be \"wall\"", name,
                             named ? scene.root().table(name).text("kind") : "periodic"),
                 "nothing outside would turn with the tank: close the side, or remove effects.rotating_frame");
}

}  // namespace

template <int D>
RotatingFrame<D>::RotatingFrame(const scene::Table& table, const scene::Scene& scene)
    : centre_(table.vec<D>("centre")),
      rate_(table.number("rate")),
      amplitude_(table.number("amplitude")),
      omega_(two_pi / table.number("period")),
      phase_(table.number("phase")),
      ramp_(table.number("ramp")) {
    const std::string axis = table.text("axis");
    if (D == 2 && axis != "z")
        scene.refuse("effects.rotating_frame.axis",
                     fmt::format("effects.rotating_frame.axis is \"{}\"; with dim = 2 it must be \"z\"", axis),
                     "a plane turns about z only");
    if (axis == "x") plane_ = {1, 2};
    if (axis == "y") plane_ = {2, 0};
    if (const auto* g = scene.effect("gravity")) gravity_ = g->template vec<D>("g");
    for (const char* other : {"bodies", "floats", "emitters"})
        if (!scene.root().tables(other).empty())
            scene.refuse(other, std::string(other) + " are not supported in a rotating frame: they would not turn with the tank",
                         "remove effects.rotating_frame, or " + std::string(other));
    const Sides<D> sides(scene);
    for (const int a : plane_)
        for (const int end : {0, 1}) require_wall(sides, a, end, scene);
    if (scene.has("substance"))
        scene.refuse("substance", "buoyancy of a substance is not supported in a rotating frame",
                     "remove effects.rotating_frame, or substance");
}

template <int D>
Roll RotatingFrame<D>::at(real t) const {
    const Ramp s(t, ramp_);
    const real sine = std::sin(omega_ * t + phase_), first = omega_ * std::cos(omega_ * t + phase_), second = -omega_ * omega_ * sine;
    const real angle = rate_ * t + amplitude_ * s.value * sine, gp = gravity_[p()], gq = gravity_[q()];
    return {.angle = angle,
            .rate = rate_ + amplitude_ * (s.first * sine + s.value * first),
            .acceleration = amplitude_ * (s.second * sine + 2 * s.first * first + s.value * second),
            .tilt = {(std::cos(angle) - 1) * gp + std::sin(angle) * gq, (std::cos(angle) - 1) * gq - std::sin(angle) * gp}};
}

template <int D>
real RotatingFrame<D>::most(const Vec<D>& lo, const Vec<D>& hi) const {
    real far = 0;
    for (const int a : {p(), q()}) far += std::pow(std::max(std::abs(lo[a] - centre_[a]), std::abs(hi[a] - centre_[a])), 2);
    const real swing = std::abs(amplitude_), steep = ramp_ > 0 ? 1.875 / ramp_ : 0;  // |s'| ≤ 15/8 / ramp, |s''| ≤ 10/√3 / ramp²
    const real rate = std::abs(rate_) + swing * (steep + omega_);
    const real acceleration = swing * ((ramp_ > 0 ? 5.7736 / (ramp_ * ramp_) : 0) + 2 * steep * omega_ + omega_ * omega_);
    return norm(gravity_) + std::sqrt(far) * (rate * rate + acceleration);
}

template class RotatingFrame<2>;
template class RotatingFrame<3>;

scene::Variant rotating_frame_schema() {
    using scene::Key;
    using scene::Type;
    const auto number = [](const char* name, const char* doc, const char* unit, real fallback) {
        return Key{.name = name, .type = Type::number, .doc = doc, .unit = unit, .fallback = fallback};
    };
    Key period = number("period", "Period of the roll.", "s", 1.0),
        ramp = number("ramp", "The amplitude grows from 0 over this time.", "s", 0.0);
    period.min = 0, period.min_open = true, ramp.min = 0;
    return {"rotating_frame",
            "The frame of a tank that rolls: angle = rate t + amplitude sin(2 pi t / period + phase) about an axis through centre. The "
            "coordinates turn with the tank; fluid at rest in the scene turns with it at t = 0.",
            {{.name = "centre", .type = Type::numbers, .doc = "A point of the axis.", .unit = "m", .required = true, .length = -1},
             {.name = "axis",
              .type = Type::choice,
              .doc = "Direction of the axis; in 2D z.",
              .fallback = std::string("z"),
              .choices = {"x", "y", "z"}},
             number("amplitude", "Amplitude of the roll.", "rad", 0.0),
             std::move(period),
             number("phase", "Phase of the roll at t = 0.", "rad", 0.0),
             std::move(ramp),
             number("rate", "Constant angular velocity.", "rad/s", 0.0)},
            {"amplitude", "rate"}};
}

}  // namespace weir::geometry
