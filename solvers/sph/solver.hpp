// Smoothed particle hydrodynamics (Müller, Charypar & Gross 2003; weakly compressible) in two and three dimensions, on the same base as
// PBF: density, equation of state, forces, symplectic integration.
#pragma once
#include "particles/threads/threaded_solver.hpp"
#include "scene/solver_kind.hpp"
#include "sph/method.hpp"

namespace weir::sph {

/// The registered solver "sph".
scene::SolverKind kind();

template <int D>
class SphSolver final : public Sph<particles::ThreadedSolver<D>> {
public:
    explicit SphSolver(const scene::Scene& scene);
    StepReport step(real dt) override;

private:
    using Base = Sph<particles::ThreadedSolver<D>>;
    using Base::fluid_, Base::kernels_, Base::walls_, Base::pairs_, Base::solids_, Base::flow_, Base::effects_, Base::passes_;
    using Base::options_, Base::speed_, Base::bodies_, Base::rest_density_, Base::rho_rest_, Base::max_acceleration_;

    SphSolver(const scene::Scene& scene, particles::Fluid<D>&& start);
    SphSolver(const Options& options, const scene::Scene& scene, particles::Fluid<D>&& start);
    void find_neighbours();
    void find_pairs();
    void find_densities();
    void advance_densities(real dt);
    void find_pressures();
    template <class F>
    void load(F&& more);
    void find_forces();
    void drag_at_solids();
    void meet_bodies(real dt);
    void carry_bodies(real dt);
    void move_bodies(real dt);
    void kick(real dt);
    void drift(real dt);
    particles::SphPass pass();
    std::size_t own_bytes() const override;

    particles::single::SphParams params_;
    particles::plain::SphParams exact_;  // for bodies
    std::vector<float> velocity_, acceleration_, density_;
    std::vector<int> beside_bodies_;  // state indices of particles
    std::vector<real> rise_;          // change of the pressure in the last step, with bodies [Pa]
    bool sticky_solids_ = false;      // whether any solid is no-slip
};

}  // namespace weir::sph
