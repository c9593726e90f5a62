#include "pbf/device_solver.hpp"

#include "pbf/bodies.hpp"

#include <algorithm>

namespace weir::pbf {

namespace {

template <int D>
particles::DeviceSetup setup(const Options& options, const particles::Domain<D>& domain) {
    particles::DeviceSetup s;
    s.kernels = pbf_params<particles::single::PbfParams, D>(options, domain.spacing);
    s.files = {"pbf.cl"};
    if (options.warm_start > 0) s.defines += "-DWEIR_KEEP ";
    if (options.pressure_k > 0) s.defines += "-DWEIR_PRESSURE ";
    return s;
}

template <int D>
particles::Fluid<D> start_of(const scene::Scene& scene) {
    particles::refuse_what_devices_lack(scene);
    return first_fluid<D>(scene);
}

}  // namespace

template <int D>
DevicePbfSolver<D>::DevicePbfSolver(const scene::Scene& scene)
    : DevicePbfSolver(Options(scene), start_of<D>(scene), particles::DeviceEffects<D>(scene)) {
    step_ = even_step(scene, fluid_.change());
}

template <int D>
DevicePbfSolver<D>::DevicePbfSolver(const Options& options, const particles::Fluid<D>& start, const particles::DeviceEffects<D>& effects)
    : Base(options, start, effects, setup(options, start.domain)) {
    fluid_.plan().want(density_, sizeof(float));
    fluid_.plan().want(multiplier_, sizeof(float));
    fluid_.settle_in();
    give_ = give_at_walls<D>(options_, start.domain.spacing);
    this->settle();
}

/// The numbers at the right are the lines of Algorithm 1.
template <int D>
StepReport DevicePbfSolver<D>::step(real dt) {
    fluid_.add_inflow(dt);
    if (bodies_) start_bodies(dt);
    fluid_.predict(dt);  //  1-4
    if (bodies_) push_bodies_ahead();
    fluid_.find_neighbours(fluid_.x_star);  //  5-7
    fluid_.expand();
    if (bodies_) beside_->find_near();
    warm_start(dt);
    int iterations = 0;  //  8
    for (; iterations < this->most_iterations(); ++iterations) {
        find_lambdas();  //  9-11
        if (options_.tolerance > 0 && find_compression().sum <= options_.tolerance * fluid_.count()) break;
        if (bodies_) carry_bodies(true);
        correct();  // 12-19
    }
    const real slow = std::max(dt, last_dt_);
    update(dt, slow);  // 20-21, 23-24
    if (bodies_) bodies_->end(fluid_.domain(), dt, slow), carried_dt_ = 0;
    last_dt_ = dt;
    fluid_.finish(dt);  // 22
    fluid_.stop_frozen_again();
    this->conduct(dt);  // only where the scene names a substance
    const real speed = this->find_speed();
    const Reduced c = find_compression();
    const real mean = fluid_.count() ? c.sum / fluid_.count() : 0;  // over all particles of the step, including those that leave now
    fluid_.end_step();
    fluid_.record(passes_);
    return this->report(dt, speed, iterations, {mean, c.largest});
}

template <int D>
void DevicePbfSolver<D>::predict_at_rest() {
    fluid_.predict(0);
    fluid_.find_neighbours(fluid_.x_star);
    fluid_.expand();
}

template <int D>
void DevicePbfSolver<D>::iterate_afresh() {
    fluid_.clear(multiplier_, sizeof(float));
    find_lambdas();
    correct();
}

/// Warm start from the multipliers of the previous step: see PbfSolver.
template <int D>
void DevicePbfSolver<D>::warm_start(real dt) {
    if (options_.warm_start == 0) return;
    const auto& f = fluid_;
    fluid_.run("start_multipliers", {f.count(), options_.warm_start * dt * dt, f.order, f.carried, f.a, f.b, multiplier_});
    if (carried_dt_ > 0) carry_bodies(false);
    correct();
}

/// lambda_i of eq. 11, from density and gradients, walls in both.
template <int D>
void DevicePbfSolver<D>::find_lambdas() {
    const auto& f = fluid_;
    fluid_.run("lambda", {f.count(), f.stride(), f.kernel_params, f.wall_params, f.terms, f.rests, f.a, f.neighbours, f.list, f.b, density_,
                          multiplier_});
}

/// x* += Δp, eq. 12 and 14, with the walls of the domain and its solids.
template <int D>
void DevicePbfSolver<D>::correct() {
    const auto& f = fluid_;
    fluid_.run("correct", {f.count(), f.stride(), f.state_params, f.kernel_params, f.wall_params, f.terms, f.rests, f.corrections, f.b,
                           f.neighbours, f.list, f.a});
    if (carried_dt_ > 0)
        push_bodies();
    else
        fluid_.leave_solids();
}

/// As in PbfSolver.
template <int D>
void DevicePbfSolver<D>::start_bodies(real dt) {
    const auto timed = passes_.time("bodies");
    carried_dt_ = dt;
    bodies_->fall(fluid_.domain(), fluid_.time(), dt);
}

template <int D>
void DevicePbfSolver<D>::push_bodies_ahead() {
    const auto timed = passes_.time("bodies");
    fluid_.fetch(fluid_.x_star, predicted_);
    if (!push_ahead(*bodies_, fluid_.borrow(), predicted_, carried_dt_)) return;
    fluid_.send(predicted_, fluid_.x_star);
    fluid_.place_solids();
}

template <int D>
void DevicePbfSolver<D>::carry_bodies(bool iterates) {
    const auto timed = passes_.time("bodies");
    const bool keeps = options_.warm_start > 0;
    std::vector<float>& four = beside_->meet(fluid_.b);
    if (keeps) fluid_.read(multiplier_, multipliers_);
    if (iterates) fluid_.read(density_, densities_);
    if (iterates && fluid_.rests.bytes > 0) fluid_.read(fluid_.rests, rests_);
    carry(*bodies_, fluid_.domain(),
          {four.data(), keeps ? multipliers_.data() : nullptr, iterates ? densities_.data() : nullptr,
           iterates && fluid_.rests.bytes > 0 ? rests_.data() : nullptr},
          give_, carried_dt_);
    fluid_.write(four, fluid_.b);
    if (keeps) fluid_.write(multipliers_, multiplier_);
}

template <int D>
void DevicePbfSolver<D>::push_bodies() {
    const auto timed = passes_.time("bodies");
    bodies_->move(fluid_.domain(), carried_dt_);
    fluid_.place_solids();
    const std::vector<float>& before = beside_->places();
    fluid_.leave_solids();
    fluid_.read(fluid_.a, four_, 4);
    if (!push_on(*bodies_, fluid_.domain(), beside_->near(), before.data(), four_.data(), carried_dt_)) return;
    fluid_.write(four_, fluid_.a);
    fluid_.place_solids();
    fluid_.renew_terms();
}

/// v = (x* - x) / dt, x = x*, and the density there; with dt = 0 only positions.
template <int D>
void DevicePbfSolver<D>::update(real dt, real slow) {
    const auto& f = fluid_;
    fluid_.run("densities", {f.count(), f.stride(), f.kernel_params, f.wall_params, f.terms, f.rests, f.a, f.neighbours, f.list, density_});
    fluid_.run("update", {f.count(), f.stride(), f.state_params, f.poses, dt, slow, f.rest_density(), f.order, f.a, f.x_star, density_,
                          multiplier_, f.x, f.v, f.density, f.carried});
    if (dt > 0) fluid_.finish_ice_motion(slow);
}

template <int D>
typename DevicePbfSolver<D>::Reduced DevicePbfSolver<D>::find_compression() {
    return fluid_.reduce("pbf_compressions", {fluid_.count(), fluid_.rests, density_, fluid_.parts()});
}

template <int D>
Compression DevicePbfSolver<D>::compression() const {
    if (this->heat_) this->heat_->place(fluid_.host());
    return particles::compression_of(fluid_.host(), fluid_.rest_density(), this->vapour());
}

template class DevicePbfSolver<2>;
template class DevicePbfSolver<3>;

}  // namespace weir::pbf
