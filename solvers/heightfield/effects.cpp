#include "heightfield/effects.hpp"

#include "geometry/brush.hpp"
#include "parallel/grid.hpp"
#include "scene/gravity.hpp"

#include <algorithm>
#include <cmath>

namespace weir::heightfield {

namespace {

using scene::Type;

template <class F>
void for_each_own_row(const State& s, F&& f) {
    const auto n = static_cast<std::size_t>(s.plane.nx);
    for_each_plane(s.plane.own, 0, s.plane.nz, [&](int k) { f(static_cast<std::size_t>(k) * n, static_cast<std::size_t>(k + 1) * n); });
}

/// The component of gravity in the plane: for a sloped bed drawn level.
class Slope final : public Effect<State> {
public:
    Stage stage() const override { return Stage::force; }
    void apply(State& s, real dt) override {
        for_each_own_row(s, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                s.qx[c] += dt * s.h[c] * s.push[0];
                if (!s.qz.empty()) s.qz[c] += dt * s.h[c] * s.push[1];
            }
        });
    }
};

/// dq/dt = -k |u| q / h,  k = g n^2 / h^(1/3) (Manning) or a constant:  q / (1 + dt k |u| / h). It is implicit and never reverses the flow,
/// even for thin films (Bristeau & Coussin 2001).
class Friction final : public Effect<State> {
public:
    explicit Friction(const scene::Table& table)
        : manning_(table.text("law") == "manning"), coefficient_(table.number(manning_ ? "n" : "c")) {}
    Stage stage() const override { return Stage::implicit; }
    void apply(State& s, real dt) override {
        if (coefficient_ == 0) return;
        const real gn2 = s.g * coefficient_ * coefficient_;
        for_each_own_row(s, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                const real h = s.h[c], x = s.qx[c], z = s.qz.empty() ? 0 : s.qz[c];
                if (h <= s.dry) continue;
                const real k = manning_ ? gn2 / std::cbrt(h) : coefficient_;
                // implicit in the remaining discharge: q1 = q / (1 + dt k |q1| / h^2), a quadratic in |q1|
                const real a = dt * k / (h * h), q = std::sqrt(x * x + z * z), left = 2 / (1 + std::sqrt(1 + 4 * a * q));
                s.qx[c] = x * left;
                if (!s.qz.empty()) s.qz[c] = z * left;
            }
        });
    }

private:
    bool manning_;
    real coefficient_;
};

class Damping final : public Effect<State> {
public:
    explicit Damping(const scene::Table& table) : rate_(table.number("rate")) {}
    Stage stage() const override { return Stage::implicit; }
    void apply(State& s, real dt) override {
        if (rate_ == 0) return;
        const real left = std::exp(-dt * rate_);
        for_each_own_row(s, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                s.qx[c] *= left;
                if (!s.qz.empty()) s.qz[c] *= left;
            }
        });
    }

private:
    real rate_;
};

/// dh/dt = rate, on the domain or within a shape seen from above (evaluated at the height of the floor).
class Rain final : public Effect<State> {
public:
    Rain(const scene::Table& table, const State& s)
        : rate_(table.number("rate")), start_(table.number("start")), end_(table.number_or("end", infinity)), on_(s.plane.extent(), 1) {
        if (!table.has("over")) return;
        const auto& over = table.numbers("over");
        const bool flat = s.plane.dim == 3;
        for_each_row(rows_stored(s.plane), [&](int k) {
            for (int i = 0; i < s.plane.nx; ++i) {
                const real x = s.plane.x(i), z = s.plane.z(k);
                const bool in = flat ? x > over[0] && x < over[2] && z > over[1] && z < over[3] : x > over[0] && x < over[1];
                on_[s.plane.at(i, k)] = in ? 1 : 0;
            }
        });
    }
    Stage stage() const override { return Stage::source; }
    void apply(State& s, real dt) override {
        const real seconds = std::min(s.time + dt, end_) - std::max(s.time, start_), depth = rate_ * std::max(0.0, seconds);
        if (depth == 0) return;
        s.net_inflow += s.plane.area() * depth * plane_sum(s.plane.own, s.plane.nz, [&](int k) {
                            real sum = 0;
                            for (int i = 0; i < s.plane.nx; ++i) {
                                const std::size_t c = s.plane.at(i, k);
                                s.h[c] += depth * on_[c];
                                sum += on_[c];
                            }
                            return sum;
                        });
    }
    std::size_t bytes() const override { return on_.bytes(); }

private:
    real rate_, start_, end_;
    Field on_;
};

}  // namespace

std::vector<scene::Variant> effect_schemas() {
    return {
        scene::gravity_effect(
            "Gravity of a height field. The component along y drives waves; the others accelerate the water along the bed."),
        {"friction",
         "Friction of the bed.",
         {{.name = "law",
           .type = Type::choice,
           .doc = "manning: g n^2 |u| u / h^(4/3); quadratic: c |u| u / h.",
           .fallback = std::string("manning"),
           .choices = {"manning", "quadratic"}},
          {.name = "n", .type = Type::number, .doc = "Manning's.", .unit = "s/m^(1/3)", .fallback = 0.03, .min = 0, .steerable = true},
          {.name = "c", .type = Type::number, .doc = "Coefficient of the quadratic law.", .fallback = 0.003, .min = 0, .steerable = true}},
         {"n"}},
        {"damping",
         "Linear damping of all motion: dq/dt = -rate q; in columns of their vertical speed.",
         {{.name = "rate", .type = Type::number, .doc = "Damping rate.", .unit = "1/s", .required = true, .min = 0, .steerable = true}},
         {"rate"}},
        {"rain",
         "Rain.",
         {{.name = "rate", .type = Type::number, .doc = "Rainfall rate.", .unit = "m/s", .required = true, .min = 0, .steerable = true},
          {.name = "over",
           .type = Type::numbers,
           .doc = "Region: [x_min, x_max] in 2D, [x_min, z_min, x_max, z_max] in 3D; the whole domain if absent.",
           .unit = "m"},
          {.name = "start", .type = Type::number, .doc = "Start time.", .unit = "s", .fallback = 0.0, .min = 0},
          {.name = "end", .type = Type::number, .doc = "End time.", .unit = "s", .min = 0}},
         {"rate"}},
        geometry::brush_schema()};
}

Effects<State> make_effects(const scene::Scene& scene, const State& state, const char* moved_in) {
    Effects<State> effects(scene.solver(), {Stage::source, Stage::force, Stage::implicit});
    if (scene.effect("gravity")) {
        if (state.push[0] != 0 || state.push[1] != 0)
            effects.add("gravity", std::make_unique<Slope>());
        else
            effects.declare({.name = "gravity", .inside = moved_in});
    }
    if (const auto* t = scene.effect("friction")) effects.add("friction", std::make_unique<Friction>(*t));
    if (const auto* t = scene.effect("damping")) effects.add("damping", std::make_unique<Damping>(*t));
    if (const auto* t = scene.effect("rain")) {
        if (t->has("over")) {
            const auto& over = t->numbers("over");
            const std::size_t wanted = scene.dim() == 2 ? 2 : 4;
            if (over.size() != wanted)
                scene.refuse("effects.rain.over", wanted == 2 ? "over is [x_min, x_max]" : "over is [x_min, z_min, x_max, z_max]");
        }
        effects.add("rain", std::make_unique<Rain>(*t, state));
    }
    return effects;
}

}  // namespace weir::heightfield
