// A particle solver on threads and vector lanes: the sorted particles of a step with their neighbours (pairs.hpp), what solids add there,
// and the effects that every method has (flow.hpp).
#pragma once
#include "core/effects.hpp"
#include "particles/flow.hpp"
#include "particles/hand.hpp"
#include "particles/pairs.hpp"
#include "particles/scheme.hpp"
#include "particles/solid_terms.hpp"
#include "particles/solver.hpp"

namespace weir::particles {

template <int D>
class ThreadedSolver : public HostSolver<D> {
public:
    std::size_t bytes() const final;
    std::vector<EffectPlan> effects() const final { return effects_.plans(); }
    const Pairs& pairs() const { return pairs_; }
    Pairs& pairs() { return pairs_; }

protected:
    ThreadedSolver(const Scheme& scheme, const scene::Scene& scene, Fluid<D>&& start);
    Pairs::NeighbourCounts neighbour_counts() const final { return pairs_.neighbour_counts(); }
    real max_dt() const final { return effects_.max_dt(flow_); }
    /// That the method's own arrays take.
    virtual std::size_t own_bytes() const = 0;
    /// Emitters, sinks and the hand, before a step.
    void pour_and_drain(real dt) {
        this->forget_whole();
        this->emitters_.apply(fluid_, dt);
        if (sources_) sources_->pour_and_drain(fluid_);
        clamps_before_ = fluid_.clamps;  // emitters are everybody's
    }
    /// The pairs of particles at these places, closer than the radius [m]. Over ranks particles change hands, and from here to dismiss()
    /// the state also has those that others show, of which the places and these arrays of the state are known.
    void find_pairs(std::array<std::vector<real>, D>& at, real radius, std::initializer_list<std::vector<real>*> read);
    void dismiss();
    /// Particles of the state that are this rank's.
    int own() const { return fluid_.shared ? migration_.own() : fluid_.count(); }
    /// Counts a step; the state follows the sorted order now and then; what has crossed a side is taken back or out. excess: of own
    /// particles; acceleration: the largest of them. Gives the speed before sides were crossed, and the others as they are of all.
    struct StepEnd {
        real speed, acceleration;
        Compression compression;
    };
    StepEnd end_step(const SumAndMost& excess, real acceleration);
    /// Over ranks, what walls corrected on all of them.
    void sum_up_clamps();
    real speed() const final;
    /// Where the passes of the step were: their positions are the pairs'.
    void conduct(real dt) final;
    /// Whether heat can be found in one pass with the densities of these places: nothing changes it before conduct().
    bool conducts_alone() const {
        const Heat<D>* heat = this->heat_.get();
        return heat && !sources_ && heat->heaters().empty() && heat->fluxes().empty() && heat->exchanges().empty();
    }
    /// That pass, for a method's own of densities: conduct() goes on from there.
    void find_density_and_heat(const PbfPass& density);
    /// After the pairs are found: what density particles are to have, where the scene lets them boil.
    void expand();
    /// Of sorted particles, over the liquid's; null: nothing boils, and no ice moves.
    const float* rest() const { return this->ice_ || (this->vapour() && this->vapour()->boils()) ? rest_.data() : nullptr; }
    using HostSolver<D>::fluid_;
    single::PbfParams kernels_{};  // the method's, as PBF, XSPH and vorticity read them
    single::WallParams walls_;
    Pairs pairs_;
    SolidTerms<D> solids_;
    Flow<D> flow_;
    Effects<Flow<D>> effects_;
    HandOnParticles<D>* sources_ = nullptr;  // one of the effects

private:
    void load_theta();
    HeatPass heat_pass();

    bool warmed_ = false;                   // the first rates of the step are there
    std::vector<real> warming_, by_walls_;  // of sorted particles [J/(kg s)]
    std::vector<float> rest_;
    void tell_of_all(StepEnd& end, const SumAndMost& excess);
    void add_clamps(const Clamps& rank);

    Migration migration_;
    HandOver::Arrays arrays_;
    Clamps clamps_before_;
    typename Fluid<D>::Quantity broken_{};
    mutable real fastest_ = not_applicable;  // over ranks: of all particles as they are now; not known after a restart [m/s]
};

}  // namespace weir::particles
