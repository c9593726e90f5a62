// Heat with melting and freezing by the enthalpy method (Voller & Prakash 1987): the advected variable is the specific enthalpy H,
//     ρ (∂H/∂t + u·∇H) = ∇·(k ∇T(H)) + q,
// T(H) is the substance's curve at the scene's pressure; on its plateau a cell is part ice and part melt, and f is the liquid fraction. Ice
// resists the flow by Carman-Kozeny drag, −C (1 − f)²/(f³ + ε) u, implicit and coupled with the pressure, so that pure ice is at rest:
//     u = β (u* − (dt/ρ) ∇p),  β = 1 / (1 + (dt/ρ) C (1 − f)²/(f³ + ε)),  ∇·(β ∇p) = (ρ/dt) ∇·(β u*).
#pragma once
#include "core/solver.hpp"
#include "mac/grid/ghosts.hpp"
#include "mac/heat/conduction.hpp"
#include "mac/heat/heat_supply.hpp"
#include "mac/heat/ice.hpp"
#include "parallel/grid.hpp"
#include "smoke/effects.hpp"
#include "thermo/melting.hpp"

#include <optional>

namespace weir::smoke {

using thermo::Melting;

template <int D>
class Heat {
public:
    static bool named(const scene::Scene& scene) { return scene.has("substance"); }
    static std::vector<scene::Key> keys();
    /// The fields that it advects or stores.
    static void needs(FieldPlan& plan);

    /// Rejects unsupported combinations; `state` must have its solids.
    Heat(const scene::Scene& scene, MacState<D>& state);
    /// Computes enthalpies from the initial temperatures; rejects values below 0 K and above boiling.
    void start(MacState<D>& s, const scene::Scene& scene);
    /// Adds interactive heating.
    void follow(std::shared_ptr<BrushForcing> forcing, MacState<D>& s) { supply_.follow(std::move(forcing), melting_, s["enthalpy"]); }
    /// H += (dt/ρ) (∇·(k ∇T) + q), and T of it (conduction.hpp).
    void conduct(MacState<D>& s, real dt);
    /// u += dt g ∫β dT along y, β the substance's thermal expansion, from its melting point (Boussinesq); no force in ice.
    void apply_buoyancy(MacState<D>& s, real dt) const;
    bool has_buoyancy() const { return lightness_.has_value(); }
    /// Multiplies u* by β and sets the state's mobility to β. Returns whether β may have changed.
    bool apply_ice_drag(MacState<D>& s, real dt);
    /// Stability limit of explicit conduction [s]; max_dt adds the time to the next switching of a heater.
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
    Melting melting_;                             // at the present pressure
    real gravity_;                                // that drives buoyancy [m/s²]
    std::optional<thermo::Lightness> lightness_;  // where there is buoyancy
    real cfl_;
    real drag_;                    // C [kg/(m³ s)]
    bool explicit_, beside_flow_;  // one explicit stage; in flux form, conduction within each flow stage: steady states independent of dt
    Conduction<D> conduction_;
    HeatSupply<D> supply_;
    Ice<D> ice_;
    Grid<real, D> liquid_;
    std::vector<real> coldest_;             // minimum of each plane [J/kg]
    bool any_ice_ = false, slows_ = false;  // anywhere; in the last step
    real added_ = 0;                        // from sides and heaters since the start [J, in 2D per metre of depth]
};

}  // namespace weir::smoke
