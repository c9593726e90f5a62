#include "pbf/device_solver.hpp"

#include "particles/flow.hpp"

#include <algorithm>

namespace weir::pbf {

using particles::DeviceSetup;

template <int D>
DeviceSetup DevicePbfSolver<D>::setup(const Options& options, const particles::Domain<D>& domain) {
    DeviceSetup s;
    s.device = options.backend.device;
    s.kernel = static_cast<int>(options.smoothing);
    s.files = {"pbf.cl"};
    if (options.warm_start > 0) s.defines += "-DWEIR_KEEP ";
    if (options.pressure_k > 0) s.defines += "-DWEIR_PRESSURE ";
    s.kernels = pbf_params<particles::single::PbfParams, D>(options, domain.spacing);
    s.walls = domain.template walls<particles::single::WallParams>(density_kernel<D>(options, domain.spacing),
                                                                   gradient_kernel<D>(options, domain.spacing));
    s.support = options.support * domain.spacing;
    return s;
}

namespace {

template <int D>
particles::Fluid<D> start_of(const scene::Scene& scene) {
    particles::refuse_what_devices_lack(scene);
    auto fluid = particles::initial_fluid<D>(scene);
    particles::refuse_idle_walls(scene, fluid.domain, false, instead_of_sticking);
    return fluid;
}

}  // namespace

template <int D>
DevicePbfSolver<D>::DevicePbfSolver(const scene::Scene& scene)
    : DevicePbfSolver(Options(scene), start_of<D>(scene), particles::DeviceEffects<D>(scene)) {
    step_ = even_step(scene, fluid_.change());
}

template <int D>
DevicePbfSolver<D>::DevicePbfSolver(const Options& options, particles::Fluid<D> start, const particles::DeviceEffects<D>& effects)
    : options_(options), fluid_(start, effects, setup(options_, start.domain)) {
    fluid_.plan().want(density_, sizeof(float));
    fluid_.plan().want(multiplier_, sizeof(float));
    fluid_.settle_in();
    settle();
}

/// Numbers at the right are the lines of Algorithm 1.
template <int D>
StepReport DevicePbfSolver<D>::step(real dt) {
    fluid_.let_in(dt);
    fluid_.predict(dt);                     //  1-4
    fluid_.find_neighbours(fluid_.x_star);  //  5-7
    warm_start(dt);
    int iterations = 0;  //  8
    const int most = options_.tolerance > 0 ? options_.max_iterations : options_.iterations;
    for (; iterations < most; ++iterations) {
        find_lambdas();  //  9-11
        if (options_.tolerance > 0 && compression().sum <= options_.tolerance * fluid_.count()) break;
        correct();  // 12-19
    }
    update(dt, std::max(dt, last_dt_));  // 20-21, 23-24
    last_dt_ = dt;
    fluid_.finish(dt);  // 22
    const real speed = fluid_.max_speed();
    const Reduced c = compression();
    const real mean = fluid_.count() ? c.sum / fluid_.count() : 0;  // of all that were there, also those that leave now
    fluid_.end_step();
    fluid_.record(passes_);
    return {.dt = dt,
            .cfl = dt * speed / fluid_.domain().spacing,
            .iterations = iterations,
            .density_error = mean,
            .max_density_error = c.largest};
}

/// Takes the density error of the initial lattice out of the positions alone, as PbfSolver does.
template <int D>
void DevicePbfSolver<D>::settle() {
    for (int i = 0; i < options_.settle; ++i) {
        if (i % settle_between_lists == 0) {
            if (i > 0 && compression().largest <= settle_good_enough) break;
            fluid_.predict(0);
            fluid_.find_neighbours(fluid_.x_star);
        }
        fluid_.clear(multiplier_, sizeof(float));
        find_lambdas();
        correct();
        if ((i + 1) % settle_between_lists == 0 || i + 1 == options_.settle) update(0, 0);
    }
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
    fluid_.run("lambda",
               {f.count(), f.stride(), f.kernel_params, f.wall_params, f.terms, f.a, f.neighbours, f.list, f.b, density_, multiplier_});
}

/// x* += Δp, eq. 12 and 14, the walls of the domain, and its solids.
template <int D>
void DevicePbfSolver<D>::correct() {
    const auto& f = fluid_;
    fluid_.run("correct", {f.count(), f.stride(), f.kernel_params, f.wall_params, f.terms, f.b, f.neighbours, f.list, f.a});
    fluid_.leave_solids();
}

/// v = (x* - x) / dt, x = x*, and the density there; with dt = 0 positions alone.
template <int D>
void DevicePbfSolver<D>::update(real dt, real slow) {
    const auto& f = fluid_;
    fluid_.run("densities", {f.count(), f.stride(), f.kernel_params, f.wall_params, f.terms, f.a, f.neighbours, f.list, density_});
    fluid_.run("update", {f.count(), f.stride(), f.state_params, f.poses, dt, slow, f.rest_density(), f.order, f.a, f.x_star, density_,
                          multiplier_, f.x, f.v, f.density, f.carried});
}

template <int D>
typename DevicePbfSolver<D>::Reduced DevicePbfSolver<D>::compression() {
    return fluid_.reduce("pbf_compressions", {fluid_.count(), density_, fluid_.parts()});
}

template <int D>
real DevicePbfSolver<D>::advised_dt() const {
    return std::min(step_, fluid_.max_dt());
}

template <int D>
FieldSet DevicePbfSolver<D>::fields() const {
    FieldSet set;
    fluid_.host().show(set);
    return set;
}

template <int D>
std::vector<Integral> DevicePbfSolver<D>::integrals() const {
    auto list = fluid_.host().integrals();
    const auto neighbours = fluid_.neighbour_counts();
    list.push_back({"mean_neighbours", "1", neighbours.mean});
    list.push_back({"max_neighbours", "1", neighbours.most});
    const auto& rho = fluid_.host().density;
    const auto excess = [&](int i) { return std::max<real>(0, rho[static_cast<std::size_t>(i)] / fluid_.rest_density() - 1); };
    const int n = fluid_.count();
    list.push_back({"mean_compression", "1", n ? particles::block_sum(n, excess) / n : 0});
    list.push_back({"max_compression", "1", particles::block_max(n, excess)});
    return list;
}

template <int D>
void DevicePbfSolver<D>::save(Checkpoint& to) const {
    fluid_.save(to);
    to.put_value("pbf.last_dt", last_dt_);
}
template <int D>
void DevicePbfSolver<D>::restore(const Checkpoint& from) {
    fluid_.restore(from);
    last_dt_ = from.get_value<real>("pbf.last_dt");
}

template class DevicePbfSolver<2>;
template class DevicePbfSolver<3>;

}  // namespace weir::pbf
