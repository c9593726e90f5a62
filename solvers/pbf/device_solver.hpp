// Position Based Fluids (Macklin & Müller 2013, Algorithm 1) with the whole step on a device: the same passes as PbfSolver, over the same
// text of the pair physics.
#pragma once
#include "core/solver.hpp"
#include "particles/device_fluid.hpp"
#include "pbf/options.hpp"

namespace weir::pbf {

template <int D>
class DevicePbfSolver final : public Solver {
public:
    explicit DevicePbfSolver(const scene::Scene& scene);
    /// Without a scene: from particles in a domain.
    DevicePbfSolver(const Options& options, particles::Fluid<D> start, const particles::DeviceEffects<D>& effects);

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

private:
    using Memory = backend::Memory;
    using Reduced = typename particles::DeviceFluid<D>::Reduced;
    static particles::DeviceSetup setup(const Options& options, const particles::Domain<D>& domain);
    void settle();
    void warm_start(real dt);
    void find_lambdas();
    void correct();
    void update(real dt, real slow);
    Reduced compression();

    Options options_;
    particles::DeviceFluid<D> fluid_;
    Memory density_, multiplier_;  // of sorted particles: rho / rho0; sum of lambda over this step, with warm start
    Passes passes_;
    real step_ = infinity, last_dt_ = 0;  // [s]
};

}  // namespace weir::pbf
