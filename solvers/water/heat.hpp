// Heat in a liquid with a free surface. The specific enthalpy H of cells is advected (semi-Lagrangian), conducted between liquid cells
// only, and exchanged with sides, heaters and the surface; ice stops the flow (mac/heat/ice.hpp). The balance is global: the mass follows
// the volume balance, the heat is that mass times the mean of H over the cells. Semi-Lagrangian advection does not conserve that mean, so
// it is corrected afterwards in the cells where H has changed. Evaporating liquid removes its own enthalpy and the heat of evaporation,
// which is taken from the surface cells:
//     dm/dt = A e (p_sat(T) − p_v),   M' = M − dm,   M' H̄' = M H̄ − dm (H_s + L).
// In an enclosed gas (thermo/closed_gas.hpp), whose pressure is p_v, evaporation is at constant volume.
#pragma once
#include "core/checkpoint.hpp"
#include "core/solver.hpp"
#include "free_surface/level_set.hpp"
#include "mac/heat/conduction.hpp"
#include "mac/heat/heat_supply.hpp"
#include "mac/heat/ice.hpp"
#include "thermo/closed_gas.hpp"

#include <optional>
#include <vector>

namespace weir::water {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

template <int D>
class LiquidHeat {
public:
    static bool named(const scene::Scene& scene) { return scene.has("substance"); }
    static std::vector<scene::Key> keys();

    /// Rejects unsupported combinations. The surface, the liquid cells and their volume must be known.
    LiquidHeat(const scene::Scene& scene, MacState<D>& s, const Frame<D>& frame, real volume);

    /// DH/Dt = 0 in the flow that moves the surface; call it before the surface moves.
    void carry(const MacState<D>& s, const LevelSet<D>& surface, real dt, Trace trace);
    /// Volume that evaporates in dt [m^D]: the surface is to be lowered by it. Negative for condensation.
    real evaporates(const MacState<D>& s, real area, real dt);
    /// Records the volume that has actually left the liquid, whose volume was `volume` before.
    void leaves(const MacState<D>& s, real lost, real volume);
    /// Adds interactive heating.
    void follow(std::shared_ptr<BrushForcing> forcing) { supply_.follow(std::move(forcing), melting_, enthalpy_); }
    /// ρ dH/dt = ∇·(k ∇T) + q in the liquid of s.cells, with this volume and surface area.
    void conduct(const MacState<D>& s, real volume, real area, real dt);
    /// Multiplies u* by β and sets s.mobility to β. Returns whether any face has drag.
    bool apply_ice_drag(MacState<D>& s, real dt);

    /// Time to the next switching of a heater or keyframe, and the limit of explicit exchange through the surface [s].
    real max_dt(const MacState<D>& s, real area) const;
    FieldView temperature() const { return {"temperature", "K", Where::cell, "", {temperature_.values()}}; }
    FieldView liquid() const { return {"liquid", "", Where::cell, "", {liquid_.values()}}; }
    std::vector<Integral> integrals(const MacState<D>& s, real volume) const;
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from, const MacState<D>& s);
    std::size_t bytes() const;

private:
    void note(const MacState<D>& s);
    void find_surface(const MacState<D>& s);
    void continue_outwards(const MacState<D>& s, int layers);
    real mean(const MacState<D>& s) const;
    void keep_mean(const MacState<D>& s);
    real surface_temperature() const;
    real surface_capacity(const MacState<D>& s) const;

    thermo::SubstancePtr substance_;
    thermo::Melting melting_;
    Frame<D> frame_;
    real drag_, exchange_, evaporation_, vapour_pressure_;
    Conduction<D> conduction_;
    HeatSupply<D> supply_;
    Grid<real, D> enthalpy_, temperature_, liquid_, moved_, source_;
    Grid<std::uint8_t, D> known_, known_next_;           // layers of cells around the liquid whose enthalpy is known
    std::vector<std::size_t> surface_cells_;             // of liquid, beside air
    std::int64_t cells_ = 0;                             // number of liquid cells
    real mean_ = 0;                                      // H̄ of the heat balance [J/kg]
    real pending_ = 0;                                   // heat of evaporation not yet taken from the surface [J]
    real added_ = 0, evaporated_ = 0, vapour_heat_ = 0;  // since the start [J], [m^D], [J]
    real coldest_ = 0, hottest_ = 0;                     // of the liquid's cells [K]
    std::optional<thermo::ClosedGas> gas_;               // nullopt where the scene names none
    Ice<D> ice_;
    bool any_ice_ = false;
};

}  // namespace weir::water
