// Position Based Fluids (Macklin & Müller 2013, Algorithm 1) in two and three dimensions, on threads and SIMD lanes.
#pragma once
#include "particles/threads/threaded_solver.hpp"
#include "pbf/method.hpp"
#include "scene/solver_kind.hpp"

namespace weir::pbf {

/// The registered solver "pbf".
scene::SolverKind kind();

template <int D>
class PbfSolver final : public Pbf<particles::ThreadedSolver<D>> {
public:
    explicit PbfSolver(const scene::Scene& scene);
    StepReport step(real dt) override;

private:
    using Base = Pbf<particles::ThreadedSolver<D>>;
    using Base::fluid_, Base::kernels_, Base::walls_, Base::pairs_, Base::solids_, Base::flow_, Base::effects_;
    using Base::passes_, Base::options_, Base::bodies_, Base::speed_, Base::step_, Base::last_dt_;

    void predict_at_rest() override;
    void iterate_afresh() override;
    void predict(real dt);
    void find_neighbours();
    void warm_start(real dt);
    void keep_multipliers(real dt);
    void find_lambdas();
    void correct();
    void collide();
    void keep_frozen_positions();
    void start_bodies(real dt);
    void push_bodies_ahead();
    void carry_bodies(const float* density);
    void push_bodies();
    void end_bodies(real dt, real slow);
    void update(real dt, real slow) override;
    particles::SumAndMost excess() const;
    Compression compression() const override;
    particles::PbfPass pass(const float* from, float* to, const float* solid);
    std::size_t own_bytes() const override;

    std::array<std::vector<real>, D> x_star_;
    std::vector<float> density_;      // rho / rho0 of each sorted particle
    std::vector<int> sorted_;         // sorted index of each state particle, with moving ice
    std::vector<float> before_push_;  // positions of particles near solids, before they are moved out
    real give_ = 0;                   // response to the motion of walls [m^2]
    real carried_dt_ = 0;             // length of the step where bodies move in it, otherwise 0 [s]
    std::vector<float> multiplier_;   // sum of lambda of each sorted particle over this step, with warm start
};

}  // namespace weir::pbf
