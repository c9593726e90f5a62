// Heat that particles carry: specific enthalpy h is what is kept, as in the enthalpy method (Voller & Prakash 1987),
//     dh_i/dt = (1/ρ0) Σ_j V 2 (Θ_j − Θ_i) (−W'/r) / M + q_i,   Θ = ∫ k dT,
// conduction between pairs of Cleary & Monaghan 1999 with the exact mean of the conductivity (kernels/heat_pair.inl), over the moment
// M = Σ_j V (−W'/r) x² of a lattice. Temperature and states follow from h; a scene that names no substance has nothing of this.
#pragma once
#include "core/checkpoint.hpp"
#include "core/solver.hpp"
#include "matter/ambient.hpp"
#include "particles/fluid.hpp"
#include "particles/passes.hpp"
#include "particles/scheme.hpp"
#include "particles/vapour.hpp"
#include "thermo/heat_curve.hpp"
#include "thermo/substance.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace weir::particles {

/// What the sum over a lattice's pairs is for the gradient kernel of a scheme.
struct LatticeSums {
    real moment = 1;    // Σ V (−W'/r) x²: 1 for a continuum
    real diagonal = 0;  // Σ V 2 (−W'/r) / moment: what a particle's own temperature is multiplied by [1/m²]
};
template <int D>
LatticeSums lattice_sums(const Scheme& scheme, real spacing);
/// The height above a wall of a temperature below which a particle is taken to stand there, so that no step of conduction which is allowed
/// makes it warmer than the wall: 0 of kernels that are smooth and wide [m].
template <int D>
real closest_to_wall(const Scheme& scheme, real spacing);

/// Solid, liquid and vapour of a curve that has a liquid; conductivities by thermo::State.
HeatStates heat_states(const thermo::HeatCurve& curve, const std::array<real, 3>& conductivity);

bool heat_is_named(const scene::Scene& scene);
/// "substance", "heat", "heaters", and walls with a flux; and "initial.temperature".
std::vector<scene::Key> heat_keys();
/// Whether a place is frozen at the start.
template <int D>
std::function<bool(const Vec<D>&)> frozen_at_start(const scene::Scene& scene);
scene::Key initial_temperature_key();
/// Of what scene.emitters[i] lets in, of its temperature [J/kg].
real emitted_enthalpy(const scene::Scene& scene, std::size_t i);

template <int D>
class Heat {
public:
    Heat(const scene::Scene& scene, const Domain<D>& domain);
    /// Enthalpies from the temperatures at the start, which it refuses below 0 K and where the liquid boils.
    void start(const scene::Scene& scene, Fluid<D>& fluid) const;

    const single::HeatParams& single_pairs() const { return single_pairs_; }
    const plain::HeatParams& plain_pairs() const { return plain_pairs_; }
    const single::HeatWalls& single_walls() const { return single_walls_; }
    const plain::HeatWalls& plain_walls() const { return plain_walls_; }
    const HeatStates& states() const { return states_; }
    /// Whether what is frozen moves, in pieces (ice.hpp), and takes the room of a solid; else it is held in place.
    bool free() const { return free_; }
    /// The rest density of a particle over the liquid's [1].
    real rest(real h) const { return heat_rest(h, &states_); }
    /// The solid's density over the liquid's, where what is frozen moves [1].
    real solid_rest() const { return 1 / (1 + states_.swells); }
    /// Whether particles hold to this wall: it is colder than they freeze at.
    bool freezing(int axis, int end) const { return freezing_[static_cast<std::size_t>(2 * axis + end)]; }
    /// Whether heat passes from walls that are held at a temperature.
    bool held() const { return held_; }
    /// Into how many equal parts a step is cut in each of which explicit conduction is stable; and remembers it.
    int parts(real dt);
    /// The largest step of explicit conduction [s].
    real stable_dt() const { return stable_dt_; }

    /// More than half frozen: held in place.
    bool frozen(real h) const { return heat_melted(h, &states_) < 0.5; }
    /// How many are at the moment.
    int count_frozen(const Fluid<D>& fluid);
    void set_frozen(int count) { frozen_ = count; }
    int frozen() const { return frozen_; }
    std::string concern() const;

    /// Of a temperature; no more than the liquid has where it begins to boil [J/kg].
    real enthalpy(real T) const { return std::min(curve_.enthalpy(T), states_.liquid_end); }
    /// Of a liquid, or what it freezes to, at the start. Throws BadInput where it boils under the pressure of the first moment [J/kg].
    real start_enthalpy(real T) const;
    /// What the scene lets boil; nullptr: nothing.
    Vapour<D>* vapour() const { return vapour_.get(); }
    /// How deep the particles are and what density they are to have; false: none boils.
    bool place(const Fluid<D>& fluid) const { return vapour_ && vapour_->find(fluid, states_); }
    /// By how much more enthalpy particle i boils than at no depth, as place() found it.
    real shift(int i) const { return vapour_ ? vapour_->shift(i) : 0; }
    /// Of particle i with this enthalpy.
    real theta(int i, real h) const {
        if (!vapour_ || h <= states_.liquid_end) return heat_theta(h, 0, &states_);  // the same below boiling, at any depth
        return heat_theta_at(heat_temperature(h, vapour_->shift(i), &states_), &states_);
    }

    /// A heater at work in (time, time + dt]: what it gives in that [J].
    struct Heater {
        geometry::ShapePtr<D> shape;
        real start = 0, end = infinity, power = 0;  // [s], [s], [W]
        real gives(real time, real dt) const { return power * std::max<real>(0, std::min(end, time + dt) - std::max(start, time)); }
    };
    const std::vector<Heater>& heaters() const { return heaters_; }
    /// A wall through which so much heat comes [W/m²]; weight: how much of what comes through an area a particle at this height above it
    /// takes, over the volume of the particle [1/m].
    struct Flux {
        int axis = 0, end = 0;
        real flux = 0;
    };
    const std::vector<Flux>& fluxes() const { return fluxes_; }
    real height(const Flux& wall, const Vec<D>& x) const {
        return wall.end ? hi_[wall.axis] - x[wall.axis] : x[wall.axis] - lo_[wall.axis];
    }
    real weight(real height) const { return std::max<real>(0, 1 - height / (2 * spacing_)) / spacing_; }
    /// What heaters and walls with a flux give in the step that ended at fluid.time.
    void feed(Fluid<D>& fluid, real dt);
    /// A wall through which the surroundings give α = `coefficient` for each kelvin by which they are warmer than its inner face
    /// [W/(m² K)]. Each particle that takes a part of the flux sees the wall through the liquid between: 1/(1/α + height/k).
    struct Exchange {
        int axis = 0, end = 0;
        real coefficient = 0;
    };
    const std::vector<Exchange>& exchanges() const { return exchanges_; }
    real surroundings(real t) const { return ambient_.temperature(t); }
    /// What the surroundings of this temperature give in a part of a step.
    void exchange(Fluid<D>& fluid, real outside, real part);
    /// Heat that has come from walls or heaters [J].
    void add(real joules) { added_ += joules; }

    /// Throws NumericalFailure where an enthalpy is not finite, or a liquid boils that may not.
    void check(const Fluid<D>& fluid) const;
    void check(real most) const;

    void show(const Fluid<D>& fluid, FieldSet& set) const;
    /// Of particles that place() has seen.
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
    std::array<bool, 6> freezing_{};  // walls, two an axis
    real stable_dt_ = infinity;
    int parts_ = 0;   // of the last step
    int frozen_ = 0;  // particles
    std::vector<Heater> heaters_;
    std::vector<Flux> fluxes_;
    matter::Ambient ambient_;
    std::vector<Exchange> exchanges_;
    std::unique_ptr<Vapour<D>> vapour_;
    real added_ = 0;                                               // [J]; in 2D a metre
    mutable std::vector<real> temperature_, liquid_, evaporated_;  // of show()
};

}  // namespace weir::particles
