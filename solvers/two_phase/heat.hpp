// Heat in both fluids: ∂(ρcT)/∂t + ∇·(ρcT u) = ∇·(k ∇T), ρc = f ρ_l c_l + (1 − f) ρ_g c_g. Each fluid carries its own temperature in its
// own geometric fluxes (transport.hpp), as tracers of a phase (López-Herrera, Gañán-Calvo, Popinet & Herrada 2015): no heat crosses
// the interface by advection. Conduction is implicit and has one temperature per cell (heat_conduction.hpp), that of both contents
// together; in mixed cells the fluids' own temperatures approach it. Buoyancy is that of Boussinesq: du/dt = −Σ f_i ρ_i β_i (T − T_0) g / ρ
// on faces. No change of phase, and a constant surface tension.
#pragma once
#include "core/solver.hpp"
#include "two_phase/heat_conduction.hpp"
#include "two_phase/transport.hpp"

#include <memory>
#include <vector>

namespace weir::two_phase {

template <int D>
class Heat {
public:
    /// The keys of the table of a fluid.
    static std::vector<scene::Key> keys_of_a_fluid();
    static scene::Variant schema();
    /// Rejects scenes without the keys that heat requires. `rho`: densities of the fluids.
    Heat(const scene::Scene& scene, const MacState<D>& state, const Densities& rho);
    /// The temperatures at t = 0.
    void start(const scene::Scene& scene, MacState<D>& state);

    /// What the transport carries.
    PhaseValues<D>* carried() { return &own_; }
    /// What dust takes along; call it after the transport.
    CarriedByDust<D> carried_by_dust();
    /// After the transport: the temperature of cells, and the heat that entered with the fluids.
    void finish_transport(MacState<D>& state);
    void conduct(MacState<D>& state, const Padded<D>& f, const FaceFractions<D>& faces, real dt);
    void add_buoyancy(MacState<D>& state, const FaceFractions<D>& faces, const Vec<D>& gravity, real dt) const;
    void check(const MacState<D>& state) const;
    /// Of the last solve for conduction.
    int iterations() const { return conduction_ ? conduction_->iterations() : 0; }

    void add_integrals(const MacState<D>& state, bool open, std::vector<Integral>& list) const;
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const;

private:
    std::array<real, 2> range_of(const MacState<D>& state) const;
    void mix(MacState<D>& state) const;
    void share(const Grid<real, D>& fraction, const Grid<real, D>& T, real dt);
    static Grid<real, D>& temperature(MacState<D>& state) { return state["temperature"]; }
    static const Grid<real, D>& temperature(const MacState<D>& state) { return *state.find("temperature"); }

    Densities rho_, capacity_;                       // [kg/m³], [J/(m³ K)]
    Densities expansion_;                            // ρ β of both fluids [kg/(m³ K)]
    real ambient_ = 0;                               // T_0 [K]
    PhaseValues<D> own_;                             // temperatures of each fluid [K]
    std::unique_ptr<HeatConduction<D>> conduction_;  // nullptr where neither fluid conducts
    real added_ = 0, entered_ = 0;                   // heat that came in by conduction, and with fluid [J; J/m]
};

}  // namespace weir::two_phase
