// Smoothed particle hydrodynamics with the whole step on a device: the same passes as SphSolver, over the same text of the pair physics.
#pragma once
#include "particles/opencl/device_solver.hpp"
#include "sph/method.hpp"

namespace weir::sph {

template <int D>
class DeviceSphSolver final : public Sph<particles::DeviceSolver<D>> {
public:
    explicit DeviceSphSolver(const scene::Scene& scene);
    StepReport step(real dt) override;

private:
    using Base = Sph<particles::DeviceSolver<D>>;
    using Base::bodies_, Base::beside_;
    using Base::fluid_, Base::passes_, Base::options_, Base::rest_density_, Base::rho_rest_, Base::max_acceleration_;
    using typename Base::Memory;

    DeviceSphSolver(const scene::Scene& scene, particles::Fluid<D>&& start);
    DeviceSphSolver(const Options& options, const scene::Scene& scene, const particles::Fluid<D>& start);
    void find_densities();
    void find_pressures();
    void find_forces();
    void meet_bodies(real dt);
    void carry_bodies(real dt);
    void apply_reaction();
    void move_bodies(real dt);
    void kick(real dt);
    void advance_densities(real dt);
    void drift(real dt);

    Memory params_, velocities_, acceleration_, normals_;  // the latter of sorted particles: float4
    particles::plain::SphParams exact_;                    // for bodies
    std::vector<float> accelerations_;                     // and other data for bodies on the host: see SphSolver
    std::vector<int> beside_bodies_;
    std::vector<real> rise_;
    bool sticky_solids_ = false;  // whether any solid is no-slip
};

}  // namespace weir::sph
