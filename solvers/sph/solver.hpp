// Smoothed particle hydrodynamics (Müller, Charypar & Gross 2003; weakly compressible) in two and three dimensions, on the same engine
// as PBF: density, equation of state, forces, symplectic integration.
#pragma once
#include "core/effects.hpp"
#include "core/solver.hpp"
#include "particles/emitters.hpp"
#include "particles/flow.hpp"
#include "particles/fluid.hpp"
#include "particles/pairs.hpp"
#include "particles/solid_terms.hpp"
#include "scene/solver_kind.hpp"
#include "sph/options.hpp"
#include "sph/state.hpp"

namespace weir::sph {

/// The registered solver "sph".
scene::SolverKind kind();

template <int D>
class SphSolver final : public Solver {
public:
    explicit SphSolver(const scene::Scene& scene);

    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override;
    std::string concern() const override;
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
    const Options& options() const { return options_; }
    real rest_density() const { return rho_rest_; }

private:
    void find_neighbours();
    void find_densities();
    void advance_densities(real dt);
    void find_pressures();
    template <class F>
    void load(F&& more);
    void find_forces();
    void drag_at_solids();
    void kick(real dt);
    void drift(real dt);
    particles::SphPass pass();

    particles::Fluid<D> fluid_;
    Options options_;
    particles::Emitters<D> emitters_;
    particles::single::SphParams params_;
    particles::single::PbfParams smooth_;  // the same kernels as XSPH and vorticity read them
    particles::single::WallParams walls_;
    particles::Pairs pairs_;
    particles::SolidTerms<D> solids_;
    particles::Flow<D> flow_;
    Effects<particles::Flow<D>> effects_;
    std::vector<float> velocity_, acceleration_, density_;
    RestDensity rest_density_;
    bool sticky_solids_ = false;  // whether the liquid sticks to any
    real rho_rest_ = 1;
    real max_acceleration_ = 0;
    real speed_ = not_applicable;  // of the fastest particle after the last step; not known before the first [m/s]
    Passes passes_;
    real max_dt_ = infinity;
};

}  // namespace weir::sph
