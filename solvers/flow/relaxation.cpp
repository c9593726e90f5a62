// Fields that fade by themselves: heat lost to the surroundings, smoke that settles. Exact over any step.
#include "flow/effects.hpp"

namespace weir::flow {

namespace {

using scene::Type;

/// dT/dt = −rate (T − ambient)     Newton's law of cooling
template <int D>
struct Cooling final : MacEffect<D> {
    real rate, ambient;
    Cooling(const scene::Table& table, const scene::Scene&) : rate(table.number("rate")), ambient(table.number("ambient")) {}
    Stage stage() const override { return Stage::finish; }
    void needs(FieldPlan& plan) const override { plan.advected("temperature"); }
    void apply(MacState<D>& s, real dt) override {
        auto& T = s["temperature"];
        const real left = std::exp(-rate * dt);
        for_each_cell(T.extent(), [&](const Index<D>& I) { T(I) = ambient + left * (T(I) - ambient); });
    }
};

/// ds/dt = −rate s
template <int D>
struct Decay final : MacEffect<D> {
    real rate;
    Decay(const scene::Table& table, const scene::Scene&) : rate(table.number("rate")) {}
    Stage stage() const override { return Stage::finish; }
    void needs(FieldPlan& plan) const override { plan.advected("smoke"); }
    void apply(MacState<D>& s, real dt) override {
        auto& smoke = s["smoke"];
        const real left = std::exp(-rate * dt);
        for_each_cell(smoke.extent(), [&](const Index<D>& I) { smoke(I) *= left; });
    }
};

const scene::Key& rate_key() {
    static const scene::Key key{
        .name = "rate", .type = Type::number, .doc = "Part lost a second.", .unit = "1/s", .required = true, .min = 0};
    return key;
}

}  // namespace

EffectKind cooling() {
    return effect_kind<Cooling>(
        {"cooling",
         "Temperature relaxes to its surroundings (Newton's law).",
         {rate_key(), {.name = "ambient", .type = Type::number, .doc = "What it relaxes to.", .unit = "K", .fallback = 0.0}},
         {"rate"}});
}

EffectKind decay() { return effect_kind<Decay>({"decay", "Smoke fades exponentially.", {rate_key()}, {"rate"}}); }

}  // namespace weir::flow
