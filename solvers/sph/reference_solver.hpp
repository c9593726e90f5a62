// Smoothed particle hydrodynamics in plain double precision over all pairs on one thread: the step of SphSolver in its simplest form, the
// reference for every backend. Its passes allocate their results.
#pragma once
#include "particles/reference/reference_solver.hpp"
#include "sph/method.hpp"

namespace weir::sph {

template <int D>
class ReferenceSphSolver final : public Sph<particles::ReferenceSolver<D, particles::ReferenceSph>> {
public:
    explicit ReferenceSphSolver(const scene::Scene& scene);
    /// Without a scene: from particles in a domain; gravity is the fluid's.
    ReferenceSphSolver(const Options& options, particles::Fluid<D> start);
    StepReport step(real dt) override;

private:
    using Base = Sph<particles::ReferenceSolver<D, particles::ReferenceSph>>;
    using Base::fluid_, Base::emitters_, Base::reference_, Base::passes_, Base::options_, Base::speed_, Base::bodies_;
    using Base::rest_density_, Base::rho_rest_, Base::max_acceleration_;
    using Points = std::vector<particles::Point>;

    ReferenceSphSolver(const scene::Scene& scene, particles::Fluid<D>&& start);
    Points velocities() const;
    void find_neighbours();
    void find_densities();
    Points accelerations();
    void add_drag_of_solids(Points& to) const;
    void kick(real dt);
    void meet_bodies(Points& accelerations, real dt);
    void advance_densities(real dt);
    void conduct(real dt) override { this->conduct_at(x_, dt); }
    std::size_t own_bytes() const override { return x_.capacity() * sizeof(particles::Point); }

    std::vector<int> beside_bodies_;
    std::vector<double> rise_;  // change of the pressure in the last step
    Points x_;                  // positions at the start of the step
};

}  // namespace weir::sph
