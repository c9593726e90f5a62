// Position Based Fluids (Macklin & Müller 2013, Algorithm 1) with the whole step on a device: the same passes as PbfSolver, over the same
// text of the pair physics.
#pragma once
#include "particles/opencl/device_solver.hpp"
#include "pbf/method.hpp"

namespace weir::pbf {

template <int D>
class DevicePbfSolver final : public Pbf<particles::DeviceSolver<D>> {
public:
    explicit DevicePbfSolver(const scene::Scene& scene);
    /// Without a scene: from particles in a domain.
    DevicePbfSolver(const Options& options, const particles::Fluid<D>& start, const particles::DeviceEffects<D>& effects);
    StepReport step(real dt) override;

private:
    using Base = Pbf<particles::DeviceSolver<D>>;
    using Base::fluid_, Base::passes_, Base::options_, Base::step_, Base::last_dt_, Base::bodies_, Base::beside_;
    using typename Base::Memory, typename Base::Reduced;

    void predict_at_rest() override;
    void iterate_afresh() override;
    void warm_start(real dt);
    void find_lambdas();
    void correct();
    void start_bodies(real dt);
    void push_bodies_ahead();
    void carry_bodies(bool iterates);
    void push_bodies();
    void update(real dt, real slow) override;
    /// On the device from the sorted particles; on the host from the state.
    Reduced find_compression();
    real worst_compression() override { return find_compression().largest; }
    Compression compression() const override;

    real give_ = 0, carried_dt_ = 0;  // with bodies, and their data on the host: see PbfSolver
    std::array<std::vector<real>, D> predicted_;
    std::vector<float> four_, multipliers_, densities_, rests_;
    Memory density_, multiplier_;  // of sorted particles: rho / rho0; sum of lambda over this step, with warm start
};

}  // namespace weir::pbf
