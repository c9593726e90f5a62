// Buoyancy: the force of temperature and smoke on the fluid.
#include "mac/grid/rows.hpp"
#include "smoke/effects.hpp"

namespace weir::smoke {

namespace {

using scene::Type;

/// f = (β (T − T_ambient) − α s) up     Fedkiw, Stam & Jensen 2001, eq. 8; with α = 0 and β = g × thermal expansion, the Boussinesq force.
/// α [m/s² per unit of smoke], β [m/s² per kelvin]. A constant that is 0 requires no field.
template <int D>
struct Buoyancy final : MacEffect<D> {
    real alpha, beta, ambient, cfl;
    static constexpr int up = 1;
    Buoyancy(const scene::Table& table, const scene::Scene& scene)
        : alpha(table.number("alpha")), beta(table.number("beta")), ambient(table.number("ambient")), cfl(scene.number("time.cfl")) {}
    Stage stage() const override { return Stage::force; }
    void needs(FieldPlan& plan) const override {
        if (beta != 0) plan.advected("temperature");
        if (alpha != 0) plan.advected("smoke");
    }
    void apply(MacState<D>& s, real dt) override {
        const auto add = [&](const Grid<real, D>& q, real factor, real zero) {
            const Nodes<D> faces = free_faces(s.u, s.sides, up);
            const real push = dt * factor;
            for_each_row(faces.lo, faces.hi, [&](const Index<D>& first, int count) {
                real* v = &s.u[up](first);
                Index<D> above = first, under = first - e<D>(up);  // on a side the single adjacent cell, or the one across a periodic end
                above[up] = std::min(above[up], q.extent()[up] - 1);
                if (under[up] < 0) under[up] = s.sides.periodic(up) ? q.extent()[up] - 1 : 0;
                const real *here = &q(above), *below = &q(under);
#pragma omp simd
                for (int i = 0; i < count; ++i) v[i] += push * (0.5 * (below[i] + here[i]) - zero);
            });
        };
        if (beta != 0) add(s["temperature"], beta, ambient);
        if (alpha != 0) add(s["smoke"], -alpha, 0);
    }
    real max_dt(const MacState<D>& s) const override {
        real f = 0;
        const auto strongest = [&](const Grid<real, D>& q, real factor, real zero) { return std::abs(factor) * max_magnitude(q, zero); };
        if (beta != 0) f += strongest(*s.find("temperature"), beta, ambient);
        if (alpha != 0) f += strongest(*s.find("smoke"), alpha, 0);
        return acceleration_limit(f, s.u.h[up], cfl);
    }
};

}  // namespace

EffectKind buoyancy() {
    return effect_kind<Buoyancy>(
        {"buoyancy",
         "Buoyancy along y: beta (T - ambient) - alpha smoke (Fedkiw et al. 2001).",
         {{.name = "alpha",
           .type = Type::number,
           .doc = "Acceleration per unit of smoke, downwards.",
           .unit = "m/s^2",
           .fallback = 0.0,
           .steerable = true},
          {.name = "beta",
           .type = Type::number,
           .doc = "Acceleration per kelvin, upwards.",
           .unit = "m/(s^2 K)",
           .fallback = 0.0,
           .steerable = true},
          {.name = "ambient", .type = Type::number, .doc = "Temperature without buoyancy.", .unit = "K", .fallback = 0.0}},
         {"alpha", "beta"}});
}

}  // namespace weir::smoke
