#include "pbf/device_solver.hpp"

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
    this->settle();
}

/// Numbers at the right are the lines of Algorithm 1.
template <int D>
StepReport DevicePbfSolver<D>::step(real dt) {
    fluid_.let_in(dt);
    fluid_.predict(dt);                     //  1-4
    fluid_.find_neighbours(fluid_.x_star);  //  5-7
    fluid_.expand();
    warm_start(dt);
    int iterations = 0;  //  8
    for (; iterations < this->most_iterations(); ++iterations) {
        find_lambdas();  //  9-11
        if (options_.tolerance > 0 && find_compression().sum <= options_.tolerance * fluid_.count()) break;
        correct();  // 12-19
    }
    update(dt, std::max(dt, last_dt_));  // 20-21, 23-24
    last_dt_ = dt;
    fluid_.finish(dt);  // 22
    fluid_.hold_again();
    this->conduct(dt);  // only where a substance is named
    const real speed = fluid_.max_speed();
    const Reduced c = find_compression();
    const real mean = fluid_.count() ? c.sum / fluid_.count() : 0;  // of all that were there, also those that leave now
    fluid_.end_step();
    fluid_.record(passes_);
    return this->report(dt, speed, iterations, {mean, c.largest});
}

template <int D>
void DevicePbfSolver<D>::stay() {
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

/// Starts from the multipliers of the step before: see PbfSolver.
template <int D>
void DevicePbfSolver<D>::warm_start(real dt) {
    if (options_.warm_start == 0) return;
    const auto& f = fluid_;
    fluid_.run("start_multipliers", {f.count(), options_.warm_start * dt * dt, f.order, f.carried, f.a, f.b, multiplier_});
    correct();
}

/// lambda_i of eq. 11, from density and gradients, walls in both.
template <int D>
void DevicePbfSolver<D>::find_lambdas() {
    const auto& f = fluid_;
    fluid_.run("lambda", {f.count(), f.stride(), f.kernel_params, f.wall_params, f.terms, f.rests, f.a, f.neighbours, f.list, f.b, density_,
                          multiplier_});
}

/// x* += Δp, eq. 12 and 14, the walls of the domain, and its solids.
template <int D>
void DevicePbfSolver<D>::correct() {
    const auto& f = fluid_;
    fluid_.run("correct", {f.count(), f.stride(), f.state_params, f.kernel_params, f.wall_params, f.terms, f.rests, f.clamps, f.b,
                           f.neighbours, f.list, f.a});
    fluid_.leave_solids();
}

/// v = (x* - x) / dt, x = x*, and the density there; with dt = 0 positions alone.
template <int D>
void DevicePbfSolver<D>::update(real dt, real slow) {
    const auto& f = fluid_;
    fluid_.run("densities", {f.count(), f.stride(), f.kernel_params, f.wall_params, f.terms, f.rests, f.a, f.neighbours, f.list, density_});
    fluid_.run("update", {f.count(), f.stride(), f.state_params, f.poses, dt, slow, f.rest_density(), f.order, f.a, f.x_star, density_,
                          multiplier_, f.x, f.v, f.density, f.carried});
    if (dt > 0) fluid_.arrive(slow);
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
