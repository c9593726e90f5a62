// A particle solver in plain double precision over all pairs on one thread: the reference for every backend (reference.hpp). Time grows
// with the square of the number of particles, and its passes allocate their results.
#pragma once
#include "particles/reference/reference.hpp"
#include "particles/state/scheme.hpp"
#include "particles/state/solver.hpp"

#include <string>
#include <utility>
#include <vector>

namespace weir::particles {

/// The effects supported for a method, with the passes in which they act.
using ReferenceEffects = std::vector<std::pair<std::string, std::string>>;
void refuse_what_the_reference_lacks(const scene::Scene& scene, const ReferenceEffects& effects);

/// Physics: ReferencePbf or ReferenceSph.
template <int D, class Physics>
class ReferenceSolver : public HostSolver<D> {
public:
    std::size_t bytes() const final;
    std::vector<EffectPlan> effects() const final { return plans_; }

protected:
    ReferenceSolver(const Scheme& scheme, Fluid<D>&& start);
    /// Adds the emitters and effects of a scene.
    void take(const scene::Scene& scene, const ReferenceEffects& effects);
    Pairs::NeighbourCounts neighbour_counts() const final { return counts_of(reference_.neighbours); }
    /// Bytes of the method's own arrays.
    virtual std::size_t own_bytes() const = 0;
    void end_step();
    /// As on threads.
    void expand();
    /// Conduction between particles at x, whose neighbours are known.
    void conduct_at(const std::vector<Point>& x, real dt);

    using HostSolver<D>::fluid_;
    Physics reference_;  // its parameters p are the method's

private:
    std::vector<EffectPlan> plans_;
};

}  // namespace weir::particles
