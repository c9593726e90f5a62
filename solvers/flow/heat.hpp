// Heat with melting and freezing by the enthalpy method (Voller & Prakash 1987): what is kept and carried is the specific enthalpy H,
//     ρ (∂H/∂t + u·∇H) = ∇·(k ∇T(H)) + q,
// T(H) is the substance's curve at the pressure of the scene, on whose plateau a cell is part ice and part melt; f is the part of melt. Ice
// resists the flow by Carman and Kozeny's drag, −C (1 − f)²/(f³ + ε) u, taken implicitly and together with the pressure, so that where all
// is ice nothing moves:
//     u = β (u* − (dt/ρ) ∇p),  β = 1 / (1 + (dt/ρ) C (1 − f)²/(f³ + ε)),  ∇·(β ∇p) = (ρ/dt) ∇·(β u*).
#pragma once
#include "core/grid.hpp"
#include "core/solver.hpp"
#include "flow/effects.hpp"
#include "matter/melting.hpp"
#include "staggered/conduction.hpp"
#include "staggered/ghosts.hpp"
#include "staggered/heat_supply.hpp"
#include "staggered/ice.hpp"

#include <optional>

namespace weir::flow {

using matter::Melting;

template <int D>
class Heat {
public:
    static bool named(const scene::Scene& scene) { return scene.has("substance"); }
    static std::vector<scene::Key> keys();
    /// The fields that it carries or keeps.
    static void needs(FieldPlan& plan);

    /// Refuses what it cannot be told together with: `state` has its solids.
    Heat(const scene::Scene& scene, MacState<D>& state);
    /// Enthalpies from the temperatures at the start, which it refuses below 0 K and above boiling.
    void start(MacState<D>& s, const scene::Scene& scene);
    /// The hand heats too.
    void follow(std::shared_ptr<Hand> hand, MacState<D>& s) { supply_.follow(std::move(hand), melting_, s["enthalpy"]); }
    /// H += (dt/ρ) (∇·(k ∇T) + q), and T of it (conduction.hpp).
    void conduct(MacState<D>& s, real dt);
    /// u += dt g ∫β dT along y, β the substance's expansion from its melting point (Boussinesq); nothing in ice.
    void lift(MacState<D>& s, real dt) const;
    bool lifts() const { return lightness_.has_value(); }
    /// u* becomes β u*, and the state's mobility is β. Whether that may have changed.
    bool slow(MacState<D>& s, real dt);
    /// Beyond which explicit conduction breaks [s]; and with it the time to the next switch of a heater.
    real stable_dt(const MacState<D>& s) const;
    real max_dt(const MacState<D>& s) const;

    const Grid<real, D>& liquid() const { return liquid_; }
    std::vector<Integral> integrals(const MacState<D>& s) const;
    void save(Checkpoint& to) const { to.put_value("heat_added", added_); }
    void restore(const Checkpoint& from, MacState<D>& s);
    std::size_t bytes() const;

private:
    void read_sides(MacState<D>& s);
    void note(MacState<D>& s);

    thermo::SubstancePtr substance_;
    Melting melting_;                             // at the pressure of the moment
    real gravity_;                                // that acts on what is lighter [m/s²]
    std::optional<matter::Lightness> lightness_;  // where it does
    real cfl_;
    real drag_;                    // C [kg/(m³ s)]
    bool explicit_, beside_flow_;  // in one stage; while it flows, not after: with fluxes, whose steady states know no step
    Conduction<D> conduction_;
    HeatSupply<D> supply_;
    Ice<D> ice_;
    Grid<real, D> liquid_;
    std::vector<real> coldest_;             // of each plane [J/kg]
    bool any_ice_ = false, slows_ = false;  // anywhere; and in the last step
    real added_ = 0;                        // by sides and heaters since the start [J, in 2D a metre]
};

}  // namespace weir::flow
