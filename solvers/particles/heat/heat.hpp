// Heat of particles by the enthalpy method (Voller & Prakash 1987); the variable is the specific enthalpy h,
//     dh_i/dt = (1/ρ0) Σ_j V 2 (Θ_j − Θ_i) (−W'/r) / M + q_i,   Θ = ∫ k dT,
// with pairwise conduction of Cleary & Monaghan 1999 and the exact mean of the conductivity (kernels/heat_pair.inl), divided by the moment
// M = Σ_j V (−W'/r) x² of a lattice. Temperature and states follow from h. Not allocated without a substance.
#pragma once
#include "core/checkpoint.hpp"
#include "core/solver.hpp"
#include "particles/heat/vapour.hpp"
#include "particles/state/fluid.hpp"
#include "particles/state/scheme.hpp"
#include "particles/threads/passes.hpp"
#include "thermo/ambient.hpp"
#include "thermo/heat_curve.hpp"
#include "thermo/substance.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace weir::particles {

/// The sums over a lattice's pairs for the gradient kernel of a scheme.
struct LatticeSums {
    real moment = 1;    // Σ V (−W'/r) x²: 1 for a continuum
    real diagonal = 0;  // Σ V 2 (−W'/r) / moment: the coefficient of a particle's own temperature [1/m²]
};
template <int D>
LatticeSums lattice_sums(const Scheme& scheme, real spacing);
/// Minimum height above a wall of fixed temperature that conduction uses, so that no allowed step makes a particle warmer than the wall: 0
/// for smooth and wide kernels [m].
template <int D>
real closest_to_wall(const Scheme& scheme, real spacing);

/// Solid, liquid and vapour of a curve with a liquid state; conductivities indexed by thermo::State.
HeatStates heat_states(const thermo::HeatCurve& curve, const std::array<real, 3>& conductivity);

bool heat_is_named(const scene::Scene& scene);
/// "substance", "heat", "heaters", and walls with a flux; and "initial.temperature".
std::vector<scene::Key> heat_keys();
/// Returns whether a point is frozen at the start.
template <int D>
std::function<bool(const Vec<D>&)> frozen_at_start(const scene::Scene& scene);
scene::Key initial_temperature_key();
/// Specific enthalpy of particles from scene.emitters[i], from its temperature [J/kg].
real emitted_enthalpy(const scene::Scene& scene, std::size_t i);

template <int D>
class Heat {
public:
    Heat(const scene::Scene& scene, const Domain<D>& domain);
    /// Computes enthalpies from the initial temperatures; rejects values below 0 K and at which the liquid boils.
    void start(const scene::Scene& scene, Fluid<D>& fluid) const;

    const single::HeatParams& single_pairs() const { return single_pairs_; }
    const plain::HeatParams& plain_pairs() const { return plain_pairs_; }
    const single::HeatWalls& single_walls() const { return single_walls_; }
    const plain::HeatWalls& plain_walls() const { return plain_walls_; }
    const HeatStates& states() const { return states_; }
    /// Returns whether frozen pieces move (ice.hpp), with the density of the solid; otherwise they are fixed.
    bool free() const { return free_; }
    /// The rest density of a particle relative to the liquid's [1].
    real rest(real h) const { return heat_rest(h, &states_); }
    /// The solid's density relative to the liquid's, where frozen pieces move [1].
    real solid_rest() const { return 1 / (1 + states_.swells); }
    /// Returns whether particles freeze to this wall: it is below their melting point.
    bool freezing(int axis, int end) const { return freezing_[static_cast<std::size_t>(2 * axis + end)]; }
    /// Returns whether any wall has a fixed temperature.
    bool held() const { return held_; }
    /// Number of equal substeps of a step for stable explicit conduction; stores it.
    int parts(real dt);
    /// The largest step of explicit conduction [s].
    real stable_dt() const { return stable_dt_; }

    /// More than half frozen: fixed in place.
    bool frozen(real h) const { return heat_melted(h, &states_) < 0.5; }
    /// Number of particles frozen now.
    int count_frozen(const Fluid<D>& fluid);
    void set_frozen(int count) { frozen_ = count; }
    int frozen() const { return frozen_; }
    std::string concern() const;

    /// Enthalpy of a temperature, at most that at which the liquid begins to boil [J/kg].
    real enthalpy(real T) const { return std::min(curve_.enthalpy(T), states_.liquid_end); }
    /// Initial enthalpy of a liquid, or of its solid. Throws BadInput where it boils at the initial pressure [J/kg].
    real start_enthalpy(real T) const;
    /// nullptr: the scene has no boiling.
    Vapour<D>* vapour() const { return vapour_.get(); }
    /// Finds the depths of particles and their rest densities; false: none boils.
    bool place(const Fluid<D>& fluid) const { return vapour_ && vapour_->find(fluid, states_); }
    /// Increase of particle i's boiling enthalpy relative to zero depth, as of place().
    real shift(int i) const { return vapour_ ? vapour_->shift(i) : 0; }
    /// Conductivity integral of particle i with this enthalpy.
    real theta(int i, real h) const {
        if (!vapour_ || h <= states_.liquid_end) return heat_theta(h, 0, &states_);  // below boiling it does not depend on depth
        return heat_theta_at(heat_temperature(h, vapour_->shift(i), &states_), &states_);
    }

    /// A heater that is on in (time, time + dt], and its heat in that time [J].
    struct Heater {
        geometry::ShapePtr<D> shape;
        real start = 0, end = infinity, power = 0;  // [s], [s], [W]
        real gives(real time, real dt) const { return power * std::max<real>(0, std::min(end, time + dt) - std::max(start, time)); }
    };
    const std::vector<Heater>& heaters() const { return heaters_; }
    /// A wall with a heat flux [W/m²]; weight: the particle's share of the flux through an area, by its height above the wall, over its
    /// volume [1/m].
    struct Flux {
        int axis = 0, end = 0;
        real flux = 0;
    };
    const std::vector<Flux>& fluxes() const { return fluxes_; }
    real height(const Flux& wall, const Vec<D>& x) const {
        return wall.end ? hi_[wall.axis] - x[wall.axis] : x[wall.axis] - lo_[wall.axis];
    }
    real weight(real height) const { return std::max<real>(0, 1 - height / (2 * spacing_)) / spacing_; }
    /// Adds the heat of heaters and walls with a flux in the step that ended at fluid.time.
    void feed(Fluid<D>& fluid, real dt);
    /// A wall with heat transfer to the surroundings, α = `coefficient` [W/(m² K)]. Each particle with a share of the flux is coupled
    /// through the liquid in between: 1/(1/α + height/k).
    struct Exchange {
        int axis = 0, end = 0;
        real coefficient = 0;
    };
    const std::vector<Exchange>& exchanges() const { return exchanges_; }
    real surroundings(real t) const { return ambient_.temperature(t); }
    /// Adds the heat from surroundings of this temperature in a part of a step.
    void exchange(Fluid<D>& fluid, real outside, real part);
    /// Records heat from walls or heaters [J].
    void add(real joules) { added_ += joules; }

    /// Throws NumericalFailure where an enthalpy is not finite, or a liquid boils without effect for it.
    void check(const Fluid<D>& fluid) const;
    void check(real most) const;

    void show(const Fluid<D>& fluid, FieldSet& set) const;
    /// Sums over the particles seen by place().
    void sum_up(const Fluid<D>& fluid, std::vector<Integral>& list) const;
    void save(Checkpoint& to) const { to.put_value("particles.heat_added", added_); }
    void restore(const Checkpoint& from) { added_ = from.get_value<real>("particles.heat_added"); }
    std::size_t bytes() const {
        return (temperature_.capacity() + liquid_.capacity() + evaporated_.capacity()) * sizeof(real) + (vapour_ ? vapour_->bytes() : 0);
    }

private:
    bool boils_at_start(real T) const;
    real theta_of_wall(real T) const;
    void set_pairs(const Scheme& scheme);
    void set_ice(const scene::Scene& scene, const Domain<D>& domain, const thermo::Substance& substance);
    void read_sides(const scene::Scene& scene, const Domain<D>& domain);
    void read_exchange(const scene::Scene& scene, int axis, int end, const std::string& path);
    void limit_exchange();
    void read_heaters(const scene::Scene& scene, const Domain<D>& domain);

    thermo::HeatCurve curve_;
    HeatStates states_;
    single::HeatParams single_pairs_;
    plain::HeatParams plain_pairs_;
    single::HeatWalls single_walls_;
    plain::HeatWalls plain_walls_;
    Vec<D> lo_, hi_;
    real spacing_, rho0_;
    bool held_ = false, free_ = false;
    std::array<bool, 6> freezing_{};  // walls, two per axis
    real stable_dt_ = infinity;
    int parts_ = 0;   // of the last step
    int frozen_ = 0;  // particles
    std::vector<Heater> heaters_;
    std::vector<Flux> fluxes_;
    thermo::Ambient ambient_;
    std::vector<Exchange> exchanges_;
    std::unique_ptr<Vapour<D>> vapour_;
    real added_ = 0;                                               // [J]; in 2D per metre of depth
    mutable std::vector<real> temperature_, liquid_, evaporated_;  // of show()
};

}  // namespace weir::particles
