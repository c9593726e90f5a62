#include "sph/device_solver.hpp"

#include "particles/state/fastest_flow.hpp"

#include <algorithm>

namespace weir::sph {

using particles::Fluid;

namespace {

template <int D>
particles::DeviceSetup setup(const Options& options, const Fluid<D>& fluid) {
    particles::DeviceSetup s;
    s.kernels = smoothing_params(sph_params<particles::single::SphParams, D>(options, fluid.domain.spacing, fluid.rho0), fluid);
    s.files = {"sph_state.inl", "sph_pair.inl", "sph.cl"};
    if (options.continuity) s.defines += "-DWEIR_CONTINUITY ";
    if (options.diffusion > 0) s.defines += "-DWEIR_DIFFUSION ";
    if (options.artificial > 0) s.defines += "-DWEIR_ARTIFICIAL ";
    if (options.viscosity > 0) s.defines += "-DWEIR_VISCOUS ";
    if (options.gamma != 1) s.defines += "-DWEIR_TAIT ";
    if (options.tension) s.defines += "-DWEIR_PULL ";
    if (options.wall_forces()) s.defines += "-DWEIR_WALL_FORCES ";
    if (options.sigma > 0) s.defines += "-DWEIR_TENSION ";
    if (sticky(fluid.domain.solids)) s.defines += "-DWEIR_STICKY_SOLIDS ";
    if (fluid.domain.solids.moving()) s.defines += "-DWEIR_MOVING_SOLIDS ";
    return s;
}

template <int D>
Fluid<D> start_of(const scene::Scene& scene) {
    particles::refuse_what_devices_lack(scene);
    return first_fluid<D>(scene);
}

}  // namespace

template <int D>
DeviceSphSolver<D>::DeviceSphSolver(const scene::Scene& scene) : DeviceSphSolver(scene, start_of<D>(scene)) {}

template <int D>
DeviceSphSolver<D>::DeviceSphSolver(const scene::Scene& scene, Fluid<D>&& start)
    : DeviceSphSolver(Options(scene, particles::fastest_flow(scene, start)), scene, start) {}

template <int D>
DeviceSphSolver<D>::DeviceSphSolver(const Options& options, const scene::Scene& scene, const Fluid<D>& start)
    : Base(options, start, particles::DeviceEffects<D>(scene), setup(options, start)), sticky_solids_(sticky(start.domain.solids)) {
    this->start_from(scene, fluid_.change());
    fluid_.plan().want(velocities_, 4 * sizeof(float));
    fluid_.plan().want(acceleration_, 4 * sizeof(float));
    if (options_.sigma > 0) fluid_.plan().want(normals_, 4 * sizeof(float));
    exact_ = sph_params<particles::plain::SphParams, D>(options_, start.domain.spacing, start.rho0);
    params_ = fluid_.constant(sph_params<particles::single::SphParams, D>(options_, start.domain.spacing, start.rho0));
    fluid_.settle_in();
}

/// Müller et al. 2003, section 3: density, pressure, forces; then v += dt a, x += dt v.
template <int D>
StepReport DeviceSphSolver<D>::step(real dt) {
    fluid_.add_inflow(dt);
    rho_rest_ = rest_density_.at(fluid_.time());
    fluid_.find_neighbours(fluid_.x);
    fluid_.expand();
    if (!options_.continuity) find_densities();  // eq. 3
    find_pressures();                            // eq. 12
    find_forces();                               // eq. 10 and 14
    if (bodies_) meet_bodies(dt);                // and on bodies
    kick(dt);
    if (bodies_) carry_bodies(dt);
    fluid_.stop_frozen();                            // frozen particles
    if (options_.continuity) advance_densities(dt);  // Colagrossi & Landrini 2003, eq. 10
    if (bodies_) move_bodies(dt);
    drift(dt);
    if (bodies_) apply_reaction();  // by particles inside bodies
    fluid_.finish(dt);              // XSPH, vorticity
    fluid_.stop_frozen_again();
    this->conduct(dt);  // only where the scene names a substance
    const real speed = this->find_speed();
    const auto c = fluid_.reduce("compressions", {fluid_.count(), rho_rest_, fluid_.order, fluid_.rests, fluid_.density, fluid_.parts()});
    const real mean = fluid_.count() ? c.sum / fluid_.count() : 0;  // over all particles of the step, including those that leave now
    fluid_.end_step();
    fluid_.record(passes_);
    return this->report(dt, speed, {mean, c.largest});
}

template <int D>
void DeviceSphSolver<D>::find_densities() {
    const auto& f = fluid_;
    const auto behind_walls = static_cast<float>(std::min(rho_rest_, f.rest_density()));
    fluid_.run("sph_densities", {f.count(), f.stride(), params_, f.wall_params, f.terms, behind_walls, f.rests, f.a, f.neighbours, f.list,
                                 f.order, f.density});
}

template <int D>
void DeviceSphSolver<D>::find_pressures() {
    const auto& f = fluid_;
    const real c2 = options_.sound * options_.sound;
    if (bodies_) fluid_.read(f.carried, rise_);
    const std::array<double, 2> state{options_.gamma == 1 ? c2 : c2 * rho_rest_ / options_.gamma, options_.gamma};
    fluid_.run("find_pressures", {f.count(), f.stride(), state, rho_rest_, f.rests, f.order, f.v, f.density, f.carried, f.a, velocities_});
}

template <int D>
void DeviceSphSolver<D>::find_forces() {
    const auto& f = fluid_;
    fluid_.run("sph_forces",
               {f.count(), f.stride(), params_, f.wall_params, f.terms, f.a, velocities_, f.neighbours, f.list, acceleration_});
    if (sticky_solids_)
        fluid_.run("drag_at_solids", {f.count(), f.stride(), f.state_params, params_, 2 * options_.viscosity, f.poses, f.a, f.near_solid,
                                      f.terms, f.order, f.v, acceleration_});
}

/// Forces of bodies on particles, including terms that the passes omit: see SphSolver.
template <int D>
void DeviceSphSolver<D>::meet_bodies(real dt) {
    const auto timed = passes_.time("bodies");
    Fluid<D>& state = fluid_.borrow();
    for (std::size_t i = 0; i < rise_.size(); ++i) rise_[i] = state.carried[i] - rise_[i];
    bodies_->begin(state.domain, state.time, dt);
    beside_->find_near();
    beside_->meet(fluid_.a);
    fluid_.read(acceleration_, accelerations_, 4);
    sph::meet_bodies(
        options_, exact_, state, *bodies_, [&](int k) { return beside_->owners()[static_cast<std::size_t>(k)]; }, rise_, dt, beside_bodies_,
        accelerations_.data());
    fluid_.write(accelerations_, acceleration_);
}

template <int D>
void DeviceSphSolver<D>::carry_bodies(real dt) {
    const auto timed = passes_.time("bodies");
    bodies_->exchange(fluid_.domain(), dt, true);
    apply_reaction();
    fluid_.place_solids();
}

template <int D>
void DeviceSphSolver<D>::apply_reaction() {
    if (bodies_->meetings().empty()) return;
    Fluid<D>& state = fluid_.borrow();
    sph::apply_reaction(*bodies_, state);
    fluid_.send(state.v, fluid_.v);
}

template <int D>
void DeviceSphSolver<D>::move_bodies(real dt) {
    const auto timed = passes_.time("bodies");
    sph::move_bodies(*bodies_, fluid_.borrow(), beside_bodies_, dt);
}

/// v += dt a, with surface tension, gravity and other fields.
template <int D>
void DeviceSphSolver<D>::kick(real dt) {
    const auto& f = fluid_;
    max_acceleration_ = std::sqrt(fluid_.reduce("accelerations", {f.count(), acceleration_, f.parts()}).largest);
    if (options_.sigma > 0) {
        fluid_.run("normals", {f.count(), f.stride(), params_, f.wall_params, f.terms, f.a, f.neighbours, f.list, normals_});
        fluid_.run("tension", {f.count(), f.stride(), params_, dt, f.a, normals_, f.neighbours, f.list, f.order, f.v});
    }
    fluid_.run("kick", {f.count(), f.stride(), f.state_params, dt, f.pull(dt), f.order, f.x, acceleration_, f.v});
}

/// d rho / dt = rate, as in SphSolver.
template <int D>
void DeviceSphSolver<D>::advance_densities(real dt) {
    const auto& f = fluid_;
    fluid_.run("load_excess", {f.count(), f.stride(), f.rest_density(), f.rests, f.order, f.v, f.density, velocities_});
    fluid_.run("advance_densities", {f.count(), f.stride(), f.state_params, f.poses, f.near_solid, params_, f.wall_params, f.terms, dt,
                                     f.rest_density(), f.a, velocities_, f.neighbours, f.list, f.order, f.density});
}

/// x += dt v, kept inside the walls and outside the solids.
template <int D>
void DeviceSphSolver<D>::drift(real dt) {
    fluid_.pass_time(dt);
    fluid_.run("drift", {fluid_.count(), fluid_.stride(), fluid_.state_params, fluid_.poses, dt, fluid_.corrections, fluid_.x, fluid_.v});
    fluid_.carry_ice(dt);
}

template class DeviceSphSolver<2>;
template class DeviceSphSolver<3>;

}  // namespace weir::sph
