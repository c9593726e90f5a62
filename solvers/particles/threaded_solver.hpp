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
        this->emitters_.apply(fluid_, dt);
        if (sources_) sources_->pour_and_drain(fluid_);
    }
    /// Over ranks a step is of a rank's own particles from here on, where the pairs are found, to gather_state(), which brings everybody's
    /// positions and velocities, these arrays of the state too, and what walls corrected.
    void begin_own();
    void gather_state(std::initializer_list<std::vector<real>*> more);
    /// Counts a step; the state follows the sorted order now and then; what has crossed a side is taken back or out.
    void end_step();
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
    std::vector<std::vector<real>*> gathered_;
    Clamps clamps_before_;  // of begin_own()
};

}  // namespace weir::particles
