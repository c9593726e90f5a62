// Smoothed particle hydrodynamics with the whole step on a device: the same passes as SphSolver, over the same text of the pair physics.
#pragma once
#include "core/solver.hpp"
#include "particles/device_fluid.hpp"
#include "sph/options.hpp"
#include "sph/state.hpp"

namespace weir::sph {

template <int D>
class DeviceSphSolver final : public Solver {
public:
    explicit DeviceSphSolver(const scene::Scene& scene);

    StepReport step(real dt) override;
    real advised_dt() const override;
    FieldSet fields() const override;
    bool checks_itself() const override { return true; }
    std::vector<Integral> integrals() const override;
    real time() const override { return fluid_.time(); }
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override { return fluid_.bytes(); }
    std::vector<EffectPlan> effects() const override { return fluid_.effects(); }

    particles::Fluid<D>& fluid() { return fluid_.change(); }
    const particles::DeviceFluid<D>& on_device() const { return fluid_; }
    const Options& options() const { return options_; }
    real rest_density() const { return rho_rest_; }

private:
    using Memory = backend::Memory;
    DeviceSphSolver(const scene::Scene& scene, particles::Fluid<D> start, const Options& options);
    static particles::DeviceSetup setup(const Options& options, const particles::Fluid<D>& fluid);
    void find_densities();
    void find_pressures();
    void find_forces();
    void kick(real dt);
    void advance_densities(real dt);
    void drift(real dt);

    Options options_;
    particles::DeviceFluid<D> fluid_;
    Memory params_, velocities_, acceleration_, normals_;  // the latter of sorted particles: float4
    RestDensity rest_density_;
    bool sticky_solids_ = false;  // whether the liquid sticks to any
    real rho_rest_ = 1, max_acceleration_ = 0, max_dt_ = infinity;
    Passes passes_;
};

}  // namespace weir::sph
