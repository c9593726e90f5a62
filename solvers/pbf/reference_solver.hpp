// Position Based Fluids (Macklin & Müller 2013, Algorithm 1) in plain double precision over all pairs on one thread: the step of PbfSolver
// in its simplest form, the reference for every backend. Its passes allocate their results.
#pragma once
#include "particles/reference/reference_solver.hpp"
#include "pbf/method.hpp"

namespace weir::pbf {

template <int D>
class ReferencePbfSolver final : public Pbf<particles::ReferenceSolver<D, particles::ReferencePbf>> {
public:
    explicit ReferencePbfSolver(const scene::Scene& scene);
    /// Without a scene: from particles in a domain; gravity is the fluid's.
    ReferencePbfSolver(const Options& options, particles::Fluid<D> start, const scene::Scene* scene = nullptr);
    StepReport step(real dt) override;
    const std::vector<double>& lambda() const { return lambda_; }  // of the last iteration

private:
    using Base = Pbf<particles::ReferenceSolver<D, particles::ReferencePbf>>;
    using Base::fluid_, Base::emitters_, Base::reference_, Base::passes_, Base::options_, Base::bodies_, Base::speed_, Base::step_,
        Base::last_dt_;

    void predict_at_rest() override { predict(0); }
    void iterate_afresh() override;
    void predict(real dt);
    void warm_start(real dt);
    void find_lambdas();
    void correct();
    void start_bodies(real dt);
    void push_bodies_ahead();
    void carry_bodies(bool iterates);
    void push_bodies();
    void update(real dt, real slow) override;
    Compression compression() const override;
    void conduct(real dt) override { this->conduct_at(x_star_, dt); }
    std::size_t own_bytes() const override;

    real give_ = 0;        // response to the motion of walls [m^2]
    real carried_dt_ = 0;  // length of the step where bodies move in it, otherwise 0 [s]
    std::vector<Vec<D>> predicted_;
    std::vector<particles::Point> x_star_;
    std::vector<double> density_, lambda_, multiplier_;  // rho / rho0; of one iteration; of all in this step, with warm start
};

}  // namespace weir::pbf
