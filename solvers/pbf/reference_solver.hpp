// Position Based Fluids (Macklin & Müller 2013, Algorithm 1) in plain double precision over all pairs on one thread: the step of PbfSolver,
// as simply as it can be written, with which every backend is compared. Its passes allocate what they return.
#pragma once
#include "core/effects.hpp"
#include "core/solver.hpp"
#include "particles/emitters.hpp"
#include "particles/reference.hpp"
#include "pbf/options.hpp"

namespace weir::pbf {

template <int D>
class ReferencePbfSolver final : public Solver {
public:
    explicit ReferencePbfSolver(const scene::Scene& scene);
    /// Without a scene: from particles in a domain; gravity is the fluid's.
    ReferencePbfSolver(const Options& options, particles::Fluid<D> start);

    StepReport step(real dt) override;
    real advised_dt() const override { return step_; }
    StepLimit stable_dt() const override { return stable_step(options_, fluid_, speed_); }
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
    const std::vector<double>& lambda() const { return lambda_; }  // of the last iteration

private:
    struct Compression {
        real mean = 0, worst = 0;
    };
    void settle();
    void predict(real dt);
    void warm_start(real dt);
    void find_lambdas();
    void correct();
    void update(real dt, real slow);
    Compression compression() const;

    Options options_;
    particles::Fluid<D> fluid_;
    particles::Emitters<D> emitters_;
    particles::ReferencePbf reference_;
    std::vector<Vec<D>> predicted_;
    std::vector<particles::Point> x_star_;
    std::vector<double> density_, lambda_, multiplier_;  // rho / rho0; of one iteration; of all in this step, with warm start
    std::vector<EffectPlan> plans_;
    Passes passes_;
    real step_ = infinity;         // advised [s]
    real last_dt_ = 0;             // [s]
    real speed_ = not_applicable;  // of the fastest particle after the last step [m/s]
};

}  // namespace weir::pbf
