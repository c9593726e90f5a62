#include "thermo/melting.hpp"

#include "core/error.hpp"
#include "scene/names.hpp"
#include "thermo/heat_keys.hpp"
#include "thermo/scene_substance.hpp"

namespace weir::thermo {

namespace {

void refuse_density(const scene::Scene& scene, const Substance& substance, real melts) {
    const real ice = substance.colder_density(Boundary::melting, melts), melt = substance.warmer_density(Boundary::melting, melts);
    const real rho = scene.number("fluid.density");
    if (rho >= 0.9 * std::min(ice, melt) && rho <= 1.1 * std::max(ice, melt)) return;
    scene.refuse(
        "fluid.density",
        "fluid.density is " + scene::number_text(rho) + " kg/m^3, which does not match the density of " + std::string(substance.name()),
        "solid " + scene::number_text(std::round(ice * 10) / 10) + ", liquid " + scene::number_text(std::round(melt * 10) / 10) +
            " kg/m^3: this solver uses one density for solid and liquid");
}

}  // namespace

Melting melting_at(const Substance& substance, real pressure) {
    const auto curve = substance.heat_curve(pressure);
    if (curve.state(0) != State::solid || curve.states() < 2 || curve.state(1) != State::liquid)
        throw BadInput("at " + scene::number_text(pressure) + " Pa " + substance.name() + " is never a liquid that freezes");
    Melting m;
    m.T = curve.begins_at(1), m.h_solid = curve.highest(0), m.h_liquid = curve.lowest(1);
    m.c_solid = curve.heat_capacity(0), m.c_liquid = curve.heat_capacity(1);
    m.k_solid = substance.conduction(State::solid).conductivity;
    m.k_liquid = substance.conduction(State::liquid).conductivity;
    if (curve.states() > 2) m.boils_above = curve.highest(1);
    return m;
}

Melting melting_of(const scene::Scene& scene, const std::string& solver) {
    const auto substance = substance_of(scene);
    const auto curve = curve_of(scene, *substance);
    if (curve.state(0) != State::solid || curve.states() < 2 || curve.state(1) != State::liquid)
        scene.refuse(
            "heat.pressure",
            "at " + scene::number_text(scene.number("heat.pressure")) + " Pa " + substance->name() + " is never a liquid that freezes",
            "solver \"" + solver + "\" supports solid and liquid only");
    const Melting m = melting_at(*substance, scene.number("heat.pressure"));
    refuse_density(scene, *substance, m.T);
    return m;
}

/// Simpson's rule per step. The table ends where the liquid boils; without boiling, at three times the melting temperature.
Lightness::Lightness(const scene::Scene& scene) {
    const auto substance = substance_of(scene);
    const Melting m = melting_of(scene, "");
    melts_ = m.T;
    const real span = std::isfinite(m.boils_above) ? m.temperature(m.boils_above) - m.T : 2 * m.T;
    const real step = span / static_cast<real>(steps);
    per_step_ = 1 / step;
    for (std::size_t i = 0; i < steps; ++i) {
        const auto beta = [&](real part) { return substance->expansion(m.T + (static_cast<real>(i) + part) * step); };
        value_[i + 1] = value_[i] + step / 6 * (beta(0) + 4 * beta(0.5) + beta(1));
    }
}

}  // namespace weir::thermo
