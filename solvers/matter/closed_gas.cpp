#include "matter/closed_gas.hpp"

#include "core/error.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weir::matter {

using thermo::State;

/// Fixed-point iteration p ← p ρ/ρ(T, p), a contraction.
real pressure_of_vapour(const thermo::Substance& substance, real density, real T) {
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

thermo::Boundary line_to_vapour(const thermo::Substance& substance, real T) {
    return T < substance.triple()->T ? thermo::Boundary::sublimation : thermo::Boundary::saturation;
}

real energy_of_vapour(const thermo::Substance& substance, const Melting& melting, real T) {
    const auto line = line_to_vapour(substance, T);
    const real expands = 1 / substance.warmer_density(line, T) - 1 / substance.colder_density(line, T);
    return melting.enthalpy(T) + substance.latent_heat(line, T) - substance.pressure(line, T) * expands;
}

scene::Key ClosedGas::key() {
    return {.name = "enclosed_vapour",
            .type = scene::Type::number,
            .doc =
                "The box is closed and rigid, and what is not liquid is the substance's vapour alone; this is its mass at the start (in 2D "
                "of a metre of depth). Its one pressure is of its mass, its volume and the surface's temperature, and takes the place of "
                "vapour_pressure.",
            .unit = "kg",
            .min = 0};
}

ClosedGas::ClosedGas(const scene::Scene& scene, thermo::SubstancePtr substance, const Melting& melting, real space, real liquid, real T)
    : substance_(std::move(substance)), space_(space), mass_(scene.number("heat.enclosed_vapour")) {
    if (!(scene.number("heat.evaporation") > 0))
        scene.refuse("heat.enclosed_vapour", "the vapour is closed in, and nothing evaporates or condenses", "heat.evaporation above 0");
    if (scene.number("heat.vapour_pressure") != 0)
        scene.refuse("heat.vapour_pressure", "a gas that is closed in has the pressure of its own mass",
                     "heat.enclosed_vapour, or heat.vapour_pressure");
    if (!(space_ > liquid)) scene.refuse("heat.enclosed_vapour", "the liquid fills the box: there is no room for vapour");
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

}  // namespace weir::matter
