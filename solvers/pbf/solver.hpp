// Position Based Fluids (Macklin & Müller 2013, Algorithm 1) in two and three dimensions, on threads and vector lanes.
#pragma once
#include "core/effects.hpp"
#include "core/solver.hpp"
#include "particles/emitters.hpp"
#include "particles/flow.hpp"
#include "particles/fluid.hpp"
#include "particles/pairs.hpp"
#include "particles/solid_terms.hpp"
#include "pbf/options.hpp"
#include "scene/solver_kind.hpp"

namespace weir::pbf {

/// The registered solver "pbf".
scene::SolverKind kind();

template <int D>
class PbfSolver final : public Solver {
public:
    explicit PbfSolver(const scene::Scene& scene);

    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override;
    FieldSet fields() const override;
    std::vector<Integral> integrals() const override;
    real time() const override { return fluid_.time; }
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override { return effects_.plans(); }

    particles::Fluid<D>& fluid() { return fluid_; }
    const particles::Pairs& pairs() const { return pairs_; }
    particles::Pairs& pairs() { return pairs_; }
    const Options& options() const { return options_; }

private:
    struct Compression {
        real mean = 0, worst = 0;
    };
    void settle();
    void predict(real dt);
    void find_neighbours();
    void warm_start(real dt);
    void keep_multipliers(real dt);
    void find_lambdas();
    void correct();
    void collide();
    void update(real dt, real slow);
    Compression compression() const;
    particles::PbfPass pass(const float* from, float* to);

    Options options_;
    particles::Fluid<D> fluid_;
    particles::Emitters<D> emitters_;
    particles::single::PbfParams params_;
    particles::single::WallParams walls_;
    particles::Pairs pairs_;
    particles::SolidTerms<D> solids_;
    particles::Flow<D> flow_;
    Effects<particles::Flow<D>> effects_;
    std::array<std::vector<real>, D> x_star_;
    std::vector<float> density_;     // rho / rho0 of each sorted particle
    std::vector<float> multiplier_;  // sum of lambda of each sorted particle over this step, with warm start
    Passes passes_;
    real step_ = infinity;         // advised [s]
    real last_dt_ = 0;             // [s]
    real speed_ = not_applicable;  // of the fastest particle after the last step; not known before the first [m/s]
};

}  // namespace weir::pbf
