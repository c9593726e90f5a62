// Relaxation of fields: heat loss to the surroundings, settling smoke. Exact for any step with semi-Lagrangian schemes. In flux form it is
// an explicit rate like the others, because a split decay makes the steady state depend on the step.
#include "smoke/effects.hpp"

namespace weir::smoke {

namespace {

using scene::Type;

/// dq/dt = −rate (q − ambient)
template <int D>
struct Relaxation : MacEffect<D> {
    std::string field;
    real rate, ambient;
    Scheme scheme;
    Relaxation(const char* name, real rate_, real ambient_, Scheme scheme_)
        : field(name), rate(rate_), ambient(ambient_), scheme(scheme_) {}
    Stage stage() const override { return scheme == Scheme::conservative ? Stage::force : Stage::carried; }
    void needs(FieldPlan& plan) const override { plan.advected(field); }
    void apply_before_advection(MacState<D>& s, real dt) override { fade(s[field], dt); }
    void apply(MacState<D>& s, real dt) override {
        if (scheme != Scheme::conservative) return fade(s[field], scheme == Scheme::maccormack ? 0.5 * dt : dt);
        auto& q = s.field(field);
        const real lost = rate * dt;
        for_each_cell(s.extent(), [&](const Index<D>& I) { q.values(I) -= lost * (q.before(I) - ambient); });
    }
    /// Explicit Euler as a rate: the step that removes everything.
    real max_dt(const MacState<D>&) const override { return scheme == Scheme::conservative && rate > 0 ? 1 / rate : infinity; }

private:
    void fade(Grid<real, D>& q, real dt) const {
        const real left = std::exp(-rate * dt);
        for_each_cell(q.extent(), [&](const Index<D>& I) { q(I) = ambient + left * (q(I) - ambient); });
    }
};

/// dT/dt = −rate (T − ambient)     Newton's law of cooling
template <int D>
struct Cooling final : Relaxation<D> {
    Cooling(const scene::Table& table, const scene::Scene& scene)
        : Relaxation<D>("temperature", table.number("rate"), table.number("ambient"), scheme_of(scene)) {}
};

/// ds/dt = −rate s
template <int D>
struct Decay final : Relaxation<D> {
    Decay(const scene::Table& table, const scene::Scene& scene) : Relaxation<D>("smoke", table.number("rate"), 0, scheme_of(scene)) {}
};

const scene::Key& rate_key() {
    static const scene::Key key{.name = "rate",
                                .type = Type::number,
                                .doc = "Fraction lost per second.",
                                .unit = "1/s",
                                .required = true,
                                .min = 0,
                                .steerable = true};
    return key;
}

}  // namespace

EffectKind cooling() {
    return effect_kind<Cooling>(
        {"cooling",
         "Temperature relaxes to its surroundings (Newton's law).",
         {rate_key(), {.name = "ambient", .type = Type::number, .doc = "Temperature of the surroundings.", .unit = "K", .fallback = 0.0}},
         {"rate"}});
}

EffectKind decay() { return effect_kind<Decay>({"decay", "Smoke fades exponentially.", {rate_key()}, {"rate"}}); }

}  // namespace weir::smoke
