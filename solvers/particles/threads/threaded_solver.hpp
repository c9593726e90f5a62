// A particle solver on threads and SIMD lanes: the sorted particles of a step with their neighbours (pairs.hpp), the terms of solids, and
// the effects of every method (flow.hpp).
#pragma once
#include "core/effects.hpp"
#include "particles/boundaries/solid_terms.hpp"
#include "particles/state/brush.hpp"
#include "particles/state/flow.hpp"
#include "particles/state/scheme.hpp"
#include "particles/state/solver.hpp"
#include "particles/threads/pairs.hpp"

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
    /// Bytes of the method's own arrays.
    virtual std::size_t own_bytes() const = 0;
    /// Emitters, sinks and interactive forcing, before a step.
    void apply_sources_and_sinks(real dt) {
        this->forget_whole();
        this->emitters_.apply(fluid_, dt);
        if (sources_) sources_->apply_sources_and_sinks(fluid_);
        corrections_before_ = fluid_.corrections;  // emitters are replicated on all ranks
    }
    /// Finds the pairs at these positions, closer than the radius [m]. In parallel particles migrate first, and until drop_ghosts() the
    /// state also contains ghost particles, for which the positions and these arrays of the state are valid.
    void find_pairs(std::array<std::vector<real>, D>& at, real radius, std::initializer_list<std::vector<real>*> read);
    void drop_ghosts();
    /// Number of state particles that this rank owns.
    int own() const { return fluid_.shared ? migration_.own() : fluid_.count(); }
    /// Ends a step: counts it, reorders the state at intervals, wraps or removes particles beyond sides. excess: of own particles;
    /// acceleration: their maximum. Returns the maximum speed before sides were crossed, and global values of the others.
    struct StepEnd {
        real speed, acceleration;
        Compression compression;
    };
    StepEnd end_step(const SumAndMost& excess, real acceleration);
    /// In parallel, sums the boundary corrections over the ranks.
    void sum_up_corrections();
    real speed() const final;
    /// Conduction at the positions of the step's passes, which are those of the pairs.
    void conduct(real dt) final;
    /// Returns whether heat can be computed in one pass with the densities at these positions: no term changes it before conduct().
    bool conducts_alone() const {
        const Heat<D>* heat = this->heat_.get();
        return heat && !sources_ && heat->heaters().empty() && heat->fluxes().empty() && heat->exchanges().empty();
    }
    /// That pass, for a density pass of the method; conduct() continues from its result.
    void find_density_and_heat(const PbfPass& density);
    /// After the neighbour search: the rest densities of particles that may boil.
    void expand();
    /// Of sorted particles, relative to the liquid's; nullptr: no boiling and no moving ice.
    const float* rest() const { return this->ice_ || (this->vapour() && this->vapour()->boils()) ? rest_.data() : nullptr; }
    using HostSolver<D>::fluid_;
    single::PbfParams kernels_{};  // the method's, for PBF, XSPH and vorticity
    single::WallParams walls_;
    Pairs pairs_;
    SolidTerms<D> solids_;
    Flow<D> flow_;
    Effects<Flow<D>> effects_;
    BrushOnParticles<D>* sources_ = nullptr;  // one of the effects

private:
    void load_theta();
    HeatPass heat_pass();

    bool warmed_ = false;                   // the first rates of the step are available
    std::vector<real> warming_, by_walls_;  // of sorted particles [J/(kg s)]
    std::vector<float> rest_;
    void reduce_over_ranks(StepEnd& end, const SumAndMost& excess);
    void add_corrections(const BoundaryCorrections& rank);

    Migration migration_;
    ParticleExchange::Arrays arrays_;
    BoundaryCorrections corrections_before_;
    typename Fluid<D>::Quantity broken_{};
    mutable real fastest_ = not_applicable;  // in parallel: over all particles now; unknown after a restart [m/s]
};

}  // namespace weir::particles
