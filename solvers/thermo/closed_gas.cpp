#include "thermo/closed_gas.hpp"

#include "core/error.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weir::thermo {

/// Fixed-point iteration p ← p ρ/ρ(T, p), a contraction.
real pressure_of_vapour(const Substance& substance, real density, real T) {
    if (density <= 0) return 0;
    const real most = 0.999 * substance.critical()->p;
    const real thin = 1e-3 * substance.triple()->p;  // where it is an ideal gas
    real p = std::min(thin * density / substance.density(State::vapour, {T, thin}), most);
    for (int i = 0; i < 100; ++i) {
        const real next = std::min(p * density / substance.density(State::vapour, {T, p}), most);
        if (std::abs(next - std::exchange(p, next)) < 1e-12 * next) break;
    }
    return p;
}

Boundary line_to_vapour(const Substance& substance, real T) {
    return T < substance.triple()->T ? Boundary::sublimation : Boundary::saturation;
}

real energy_of_vapour(const Substance& substance, const Melting& melting, real T) {
    const auto line = line_to_vapour(substance, T);
    const real expands = 1 / substance.warmer_density(line, T) - 1 / substance.colder_density(line, T);
    return melting.enthalpy(T) + substance.latent_heat(line, T) - substance.pressure(line, T) * expands;
}

scene::Key ClosedGas::key() {
    return {.name = "enclosed_vapour",
            .type = scene::Type::number,
            .doc =
                "Initial mass of the vapour (in 2D per metre of depth) in a closed rigid box that contains only liquid and vapour. Its "
                "uniform pressure follows from mass, volume and surface temperature and replaces vapour_pressure.",
            .unit = "kg",
            .min = 0};
}

ClosedGas::ClosedGas(const scene::Scene& scene, SubstancePtr substance, const Melting& melting, real space, real liquid, real T)
    : substance_(std::move(substance)), space_(space), mass_(scene.number("heat.enclosed_vapour")) {
    if (!(scene.number("heat.evaporation") > 0))
        scene.refuse("heat.enclosed_vapour", "the vapour is enclosed, but evaporation and condensation are off",
                     "heat.evaporation above 0");
    if (scene.number("heat.vapour_pressure") != 0)
        scene.refuse("heat.vapour_pressure", "the pressure of an enclosed gas follows from its mass",
                     "heat.enclosed_vapour, or heat.vapour_pressure");
    if (!(space_ > liquid)) scene.refuse("heat.enclosed_vapour", "the liquid fills the box: no volume is left for vapour");
    energy_ = mass_ * energy_of_vapour(*substance_, melting, T);
    fill(T, liquid);
}

void ClosedGas::fill(real T, real liquid) {
    volume_ = space_ - liquid;
    if (!(volume_ > 0)) throw NumericalFailure("pressure", "the liquid has filled the box");
    p_ = pressure_of_vapour(*substance_, mass_ / volume_, T);
}

/// d(p_sat − p)/dt = −(p_sat/(ρ_v V) + L/C dp_sat/dT) dm/dt, with all coefficients at the start of the step.
real ClosedGas::evaporates(real K, real T, real capacity, real dt) const {
    const auto line = line_to_vapour(*substance_, T);
    const real p = substance_->pressure(line, T);
    const real by_mass = p / (substance_->warmer_density(line, T) * volume_);
    const real by_heat = substance_->slope(line, T) * substance_->latent_heat(line, T) / capacity;
    const real rate = K * (by_mass + by_heat);
    return std::max(K * (p - p_) * -std::expm1(-rate * dt) / rate, -mass_);
}

real ClosedGas::take(real mass, const Melting& melting, real T, real liquid) {
    mass_ = std::max(mass_ + mass, real(0));
    fill(T, liquid);
    const real energy = mass_ * energy_of_vapour(*substance_, melting, T);
    return energy - std::exchange(energy_, energy);
}

}  // namespace weir::thermo
