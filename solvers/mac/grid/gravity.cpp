// Gravity: a constant acceleration of all fluid.
#include "scene/gravity.hpp"
#include "mac/grid/effects.hpp"

namespace weir::mac {

namespace {

/// du/dt = g
template <int D>
struct Gravity final : MacEffect<D> {
    Vec<D> g;
    real cfl;
    Gravity(const scene::Table& table, const scene::Scene& scene) : g(table.vec<D>("g")), cfl(scene.number("time.cfl")) {}
    Stage stage() const override { return Stage::force; }
    void apply(MacState<D>& s, real dt) override {
        for (int a = 0; a < D; ++a) {
            const real du = dt * g[a];
            if (du != 0) for_each_free_face(s.u, s.sides, a, [&](const Index<D>& I) { s.u[a](I) += du; });
        }
    }
    real max_dt(const MacState<D>& s) const override {
        real limit = infinity;
        for (int a = 0; a < D; ++a) limit = std::min(limit, acceleration_limit(std::abs(g[a]), s.u.h[a], cfl));
        return limit;
    }
};

}  // namespace

EffectKind gravity() { return effect_kind<Gravity>(scene::gravity_effect("Constant acceleration of all fluid.")); }

}  // namespace weir::mac
