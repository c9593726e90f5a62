// The gas part of a closed rigid box above a liquid: pure vapour with a uniform pressure, determined by its mass, volume and temperature,
// which is that of the surface. It approaches the saturation pressure by evaporation or condensation,
//     dm/dt = K (p_sat(T) − p),    K = A e [kg/(s Pa)].
// At constant volume, evaporation takes u_v − u_l = L − p (1/ρ_v − 1/ρ_l): less than L, since there is no work of expansion.
#pragma once
#include "scene/scene.hpp"
#include "thermo/melting.hpp"
#include "thermo/substance.hpp"

#include <array>

namespace weir::thermo {

/// Pressure of vapour of this density [Pa]; below the critical pressure.
real pressure_of_vapour(const Substance& substance, real density, real T);

/// The line on which vapour is in equilibrium with matter of temperature T.
Boundary line_to_vapour(const Substance& substance, real T);

/// Energy of vapour in equilibrium at T, where the condensed phase has the enthalpy of `melting` [J/kg].
real energy_of_vapour(const Substance& substance, const Melting& melting, real T);

class ClosedGas {
public:
    static bool named(const scene::Scene& scene) { return scene.has("heat.enclosed_vapour"); }
    /// The key "enclosed_vapour" of the table "heat".
    static scene::Key key();
    /// A gas that shares `space` [m^D] with `liquid`, at the temperature of the surface. Rejects contradictory keys of a scene.
    ClosedGas(const scene::Scene& scene, SubstancePtr substance, const Melting& melting, real space, real liquid, real T);

    /// Mass that evaporates in dt from a surface with heat capacity `capacity` [J/K], which supplies the heat of evaporation [kg]. The
    /// pressures approach each other exponentially, with the rate of the linearized equations, so any step is stable.
    real evaporates(real K, real T, real capacity, real dt) const;
    /// Adds this mass, at the temperature of the surface. Returns the increase of the gas's energy.
    real take(real mass, const Melting& melting, real T, real liquid);

    real pressure() const { return p_; }
    real mass() const { return mass_; }
    real energy() const { return energy_; }
    std::array<real, 4> saved() const { return {mass_, energy_, volume_, p_}; }
    void restore(const std::array<real, 4>& saved) { mass_ = saved[0], energy_ = saved[1], volume_ = saved[2], p_ = saved[3]; }

private:
    void fill(real T, real liquid);

    SubstancePtr substance_;
    real space_, mass_, energy_ = 0, volume_ = 0, p_ = 0;
};

}  // namespace weir::thermo
