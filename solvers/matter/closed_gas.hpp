// The part of a closed rigid box above a liquid: vapour alone, with one pressure of its mass, its volume and its temperature, which is the
// surface's. It comes to the saturation pressure as liquid evaporates or vapour condenses,
//     dm/dt = K (p_sat(T) − p),    K = A e [kg/(s Pa)].
// In a volume that stays, what evaporates takes u_v − u_l = L − p (1/ρ_v − 1/ρ_l): less than L by the work of an expansion that there is
// not.
#pragma once
#include "matter/melting.hpp"
#include "scene/scene.hpp"
#include "thermo/substance.hpp"

#include <array>

namespace weir::matter {

/// Of vapour of this density, which is nearly in proportion to p [Pa]; below the critical pressure.
real pressure_of_vapour(const thermo::Substance& substance, real density, real T);

/// The line on which vapour is in balance with what is as warm as T.
thermo::Boundary line_to_vapour(const thermo::Substance& substance, real T);

/// Energy of vapour in balance at T, in which what is condensed has the enthalpy of `melting` [J/kg].
real energy_of_vapour(const thermo::Substance& substance, const Melting& melting, real T);

class ClosedGas {
public:
    static bool named(const scene::Scene& scene) { return scene.has("heat.enclosed_vapour"); }
    /// The key "enclosed_vapour" of the table "heat".
    static scene::Key key();
    /// In `space` that it shares with `liquid` [m^D], at the temperature of the surface. Refuses what contradicts a gas of its own.
    ClosedGas(const scene::Scene& scene, thermo::SubstancePtr substance, const Melting& melting, real space, real liquid, real T);

    /// How much evaporates in dt from a surface whose `capacity` [J/K] feels the heat of evaporation: the pressures approach each other
    /// exponentially, at the rate of their linear equations, so that no step is too long [kg].
    real evaporates(real K, real T, real capacity, real dt) const;
    /// Takes this much over, and is as warm as the surface. Answers by how much its energy has grown.
    real take(real mass, const Melting& melting, real T, real liquid);

    real pressure() const { return p_; }
    real mass() const { return mass_; }
    real energy() const { return energy_; }
    std::array<real, 4> saved() const { return {mass_, energy_, volume_, p_}; }
    void restore(const std::array<real, 4>& saved) { mass_ = saved[0], energy_ = saved[1], volume_ = saved[2], p_ = saved[3]; }

private:
    void fill(real T, real liquid);

    thermo::SubstancePtr substance_;
    real space_, mass_, energy_ = 0, volume_ = 0, p_ = 0;
};

}  // namespace weir::matter
