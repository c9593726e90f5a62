// Smoothed particle hydrodynamics in plain double precision over all pairs on one thread: the step of SphSolver, as simply as it can be
// written, with which every backend is compared. Its passes allocate what they return.
#pragma once
#include "core/effects.hpp"
#include "core/solver.hpp"
#include "particles/emitters.hpp"
#include "particles/reference.hpp"
#include "sph/options.hpp"
#include "sph/state.hpp"

namespace weir::sph {

template <int D>
class ReferenceSphSolver final : public Solver {
public:
    explicit ReferenceSphSolver(const scene::Scene& scene);
    /// Without a scene: from particles in a domain; gravity is the fluid's.
    ReferenceSphSolver(const Options& options, particles::Fluid<D> start);

    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override { return stable_step(options_, fluid_, speed_); }
    std::string concern() const override { return too_fast(options_, speed_, fluid_.time); }
    FieldSet fields() const override;
    std::vector<Integral> integrals() const override;
    real time() const override { return fluid_.time; }
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override { return plans_; }

    particles::Fluid<D>& fluid() { return fluid_; }
    const Options& options() const { return options_; }

private:
    using Points = std::vector<particles::Point>;
    Points velocities() const;
    void find_neighbours();
    void find_densities();
    Points accelerations();
    void add_drag_of_solids(Points& to) const;
    void kick(real dt);
    void advance_densities(real dt);

    particles::Fluid<D> fluid_;
    Options options_;
    particles::Emitters<D> emitters_;
    particles::ReferenceSph reference_;
    Points x_;  // where the step began
    RestDensity rest_density_;
    std::vector<EffectPlan> plans_;
    real rho_rest_ = 1;
    real max_acceleration_ = 0;
    real speed_ = not_applicable;  // of the fastest particle after the last step [m/s]
    Passes passes_;
    real max_dt_ = infinity;
};

}  // namespace weir::sph
