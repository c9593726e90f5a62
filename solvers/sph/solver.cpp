#include "sph/solver.hpp"

#include "particles/state/fastest_flow.hpp"
#include "sph/tension.hpp"

#include <algorithm>
#include <cmath>

namespace weir::sph {

using particles::Fluid;
using particles::ListChunk;
using particles::SphPass;
using particles::single::SphParams;

namespace {

#define WEIR_FN inline
#include "particles/kernels/sph_state.inl"

}  // namespace

template <int D>
SphSolver<D>::SphSolver(const scene::Scene& scene) : SphSolver(scene, first_fluid<D>(scene)) {}

template <int D>
SphSolver<D>::SphSolver(const scene::Scene& scene, Fluid<D>&& start)
    : SphSolver{Options(scene, particles::fastest_flow(scene, start)), scene, std::move(start)} {}

template <int D>
SphSolver<D>::SphSolver(const Options& options, const scene::Scene& scene, Fluid<D>&& start)
    : Base(options, scene, std::move(start)),
      params_(sph_params<SphParams, D>(options_, fluid_.domain.spacing, fluid_.rho0)),
      exact_(sph_params<particles::plain::SphParams, D>(options_, fluid_.domain.spacing, fluid_.rho0)) {
    kernels_ = smoothing_params(params_, fluid_);
    if (scene.effect("surface_tension")) effects_.add("surface_tension", std::make_unique<SurfaceTension<D>>(params_, walls_, solids_));
    for (const auto& [name, pass] : {std::pair{"viscosity", "forces"},
                                     {"artificial_viscosity", "forces"},
                                     {"density_diffusion", "density"},
                                     {"rest_density", "neighbours"}})
        if (scene.effect(name)) effects_.declare({.name = name, .inside = pass});
    sticky_solids_ = sticky(fluid_.domain.solids);
    this->start_from(scene, fluid_);
}

/// Müller et al. 2003, section 3: density, pressure, forces; then v += dt a, x += dt v.
template <int D>
StepReport SphSolver<D>::step(real dt) {
    this->apply_sources_and_sinks(dt);
    find_neighbours();
    if (!options_.continuity) find_densities();        // eq. 3
    find_pressures();                                  // eq. 12
    find_forces();                                     // eq. 10 and 14
    if (bodies_) meet_bodies(dt);                      // and on bodies
    effects_.apply(Stage::force, flow_, dt, passes_);  // gravity and other fields
    kick(dt);
    if (bodies_) carry_bodies(dt);
    this->stop_frozen();                             // frozen particles
    if (options_.continuity) advance_densities(dt);  // Colagrossi & Landrini 2003, eq. 10
    if (bodies_) move_bodies(dt);
    drift(dt);
    if (bodies_) apply_reaction(*bodies_, fluid_);      // by particles inside bodies
    effects_.apply(Stage::finish, flow_, dt, passes_);  // XSPH, vorticity
    this->drop_ghosts();
    this->stop_frozen_again();
    this->conduct(dt);  // only where the scene names a substance
    const auto end = this->end_step(particles::excess_of(fluid_, rho_rest_, this->vapour()), max_acceleration_);
    speed_ = end.speed, max_acceleration_ = end.acceleration;
    return this->report(dt, end.speed, end.compression);
}

template <int D>
void SphSolver<D>::find_neighbours() {
    const auto timed = passes_.time("neighbours");
    find_pairs();
    pairs_.fit(density_, 1);
    pairs_.fit(velocity_, 4);
    pairs_.fit(acceleration_, 4);
    solids_.mark(pairs_);
    this->expand();
    rho_rest_ = rest_density_.at(fluid_.time);
    params_.wall_rho = static_cast<float>(std::min(rho_rest_, fluid_.rho0));
}

/// Halo exchange of velocities, and of densities with the continuity equation.
template <int D>
void SphSolver<D>::find_pairs() {
    const real radius = options_.support * fluid_.domain.spacing;
    if constexpr (D == 2)
        Base::find_pairs(fluid_.x, radius, {&fluid_.v[0], &fluid_.v[1], &fluid_.density});
    else
        Base::find_pairs(fluid_.x, radius, {&fluid_.v[0], &fluid_.v[1], &fluid_.v[2], &fluid_.density});
}

template <int D>
SphPass SphSolver<D>::pass() {
    return {&params_,
            &walls_,
            pairs_.size(),
            pairs_.a(),
            velocity_.data(),
            solids_.at(pairs_, pairs_.a()),
            density_.data(),
            acceleration_.data(),
            pairs_.list().first(),
            pairs_.list().rows(),
            options_.wall_forces(),
            this->rest()};
}

template <int D>
void SphSolver<D>::find_densities() {
    const auto timed = passes_.time("density");
    const auto& table = pairs_.table().sph[static_cast<int>(options_.smoothing)];
    const SphPass job = pass();
    pairs_.list().each_chunk([&](const ListChunk& chunk) { table.density(job, chunk); });
    pairs_.share(density_);
    pairs_.each_anywhere([&](int k) {
        if (!pairs_.is_image(k))
            fluid_.density[static_cast<std::size_t>(pairs_.owner(k))] = static_cast<real>(density_[static_cast<std::size_t>(k)]);
    });
}

/// d rho / dt = rate, in double precision. Like positions, densities use the new velocities at the old positions: symplectic Euler, under
/// which acoustic waves are neutral; a reflection at a wall loses energy to the error but never gains.
template <int D>
void SphSolver<D>::advance_densities(real dt) {
    const auto timed = passes_.time("density");
    flow_.share_velocity();
    load([&](int, int i) { return fluid_.density[static_cast<std::size_t>(i)] - fluid_.rho0 * this->ice_rest(i); });
    const auto& table = pairs_.table().sph[static_cast<int>(options_.smoothing)];
    const SphPass job = pass();
    const auto rate = table.rate[options_.diffusion > 0];
    pairs_.list().each_chunk([&](const ListChunk& chunk) { rate(job, chunk); });
    const auto& solids = fluid_.domain.solids;
    if (!solids.empty() && solids.moving())  // images behind them move with them
        solids_.each_near(pairs_.a(), [&](int k, const Vec<D>& at, const float* term) {
            const Vec<D> u = solids.velocity(at);
            real into = 0;
            for (int a = 0; a < D; ++a) into += u[a] * static_cast<real>(term[a]);
            density_[static_cast<std::size_t>(k)] -=
                static_cast<float>(2 * fluid_.density[static_cast<std::size_t>(pairs_.owner(k))] * into);
        });
    pairs_.each([&](int k) {
        if (pairs_.is_image(k)) return;
        real& rho = fluid_.density[static_cast<std::size_t>(pairs_.owner(k))];
        rho = density_kept(rho * density_growth(dt * static_cast<real>(density_[static_cast<std::size_t>(k)]) / rho), fluid_.rho0);
    });
}

/// Stores velocities with one more number, and 1 / rho in the positions, in the layout of the passes; images get their owners' values.
template <int D>
template <class F>
void SphSolver<D>::load(F&& more) {
    float* x = pairs_.a();
    pairs_.each_read([&](int k) {
        const auto at = static_cast<std::size_t>(k);
        const int i = pairs_.owner(k);
        const Vec<D> u = fluid_.velocity(i);
        x[4 * at + 3] = static_cast<float>(1 / fluid_.density[static_cast<std::size_t>(i)]);
        for (std::size_t a = 0; a < 3; ++a) velocity_[4 * at + a] = a < D ? static_cast<float>(u[a]) : 0;
        velocity_[4 * at + 3] = static_cast<float>(more(k, i));
    });
    pairs_.clear_dummies(velocity_);
}

template <int D>
void SphSolver<D>::find_pressures() {
    if (bodies_) rise_.resize(fluid_.id.size());
    load([&](int k, int i) {
        const real pressure = options_.pressure(fluid_.density[static_cast<std::size_t>(i)], this->rest_of(i));
        if (pairs_.is_image(k)) return pressure;
        real& carried = fluid_.carried[static_cast<std::size_t>(i)];
        if (bodies_) rise_[static_cast<std::size_t>(i)] = pressure - carried;
        carried = pressure;
        return pressure;
    });
}

template <int D>
void SphSolver<D>::find_forces() {
    const auto timed = passes_.time("forces");
    const auto& table = pairs_.table().sph[static_cast<int>(options_.smoothing)];
    const SphPass job = pass();
    unsigned terms = 0;
    if (!options_.continuity) terms |= particles::sph_summed;
    if (options_.artificial > 0) terms |= particles::sph_artificial;
    if (options_.viscosity > 0) terms |= particles::sph_viscous;
    const auto force = table.force[terms];
    pairs_.list().each_chunk([&](const ListChunk& chunk) { force(job, chunk); });
    if (sticky_solids_) drag_at_solids();
}

/// Drag of a no-slip solid, as of a wall: 2 nu plane / phi along its surface (Morris et al. 1997, sec. 3.2; kernels/sph_pair.inl).
template <int D>
void SphSolver<D>::drag_at_solids() {
    const auto& solids = fluid_.domain.solids;
    solids_.each_near(pairs_.a(), [&](int k, const Vec<D>& at, const float* term) {
        if (pairs_.is_image(k) || !solids[solids.nearest(at)].no_slip) return;
        Vec<D> pull{};  // opposite to the surface's normal; its length is the integral over the plane
        for (int a = 0; a < D; ++a) pull[a] = static_cast<real>(term[a]);
        const real plane = norm(pull);
        if (plane == 0) return;
        const Vec<D> slip = solids.velocity(at) - fluid_.velocity(pairs_.owner(k)), along = slip - dot(slip, pull) / (plane * plane) * pull;
        const real drag = 2 * options_.viscosity * plane / std::max(solids.distance(at), static_cast<real>(params_.closest));
        for (int a = 0; a < D; ++a) acceleration_[static_cast<std::size_t>(4 * k + a)] += static_cast<float>(drag * along[a]);
    });
}

/// Forces of bodies on particles, including terms that the pair passes omit.
template <int D>
void SphSolver<D>::meet_bodies(real dt) {
    const auto timed = passes_.time("bodies");
    bodies_->begin(fluid_.domain, fluid_.time, dt);
    solids_.meet(pairs_.a(), bodies_->meetings());
    sph::meet_bodies(
        options_, exact_, fluid_, *bodies_, [&](int k) { return pairs_.owner(k); }, rise_, dt, beside_bodies_, acceleration_.data());
}

/// V += dt F / (M + K); returns to particles the part of F that the bodies' own change removes.
template <int D>
void SphSolver<D>::carry_bodies(real dt) {
    const auto timed = passes_.time("bodies");
    bodies_->exchange(fluid_.domain, dt, true);
    apply_reaction(*bodies_, fluid_);
}

/// X += dt V. Particles that would end inside push the bodies.
template <int D>
void SphSolver<D>::move_bodies(real dt) {
    const auto timed = passes_.time("bodies");
    sph::move_bodies(*bodies_, fluid_, beside_bodies_, dt);
}

/// v += dt a; finds the largest a.
template <int D>
void SphSolver<D>::kick(real dt) {
    const auto timed = passes_.time("integrate");
    const float* acceleration = acceleration_.data();
    const auto& own = pairs_.shares().own();
    max_acceleration_ = std::sqrt(particles::block_max(own.count(), [&](int at) {
        const int k = own.begin + at;
        Vec<D> by;
        for (int a = 0; a < D; ++a) by[a] = static_cast<real>(acceleration[4 * k + a]);
        if (!pairs_.is_image(k)) {
            const int i = pairs_.owner(k);
            Fluid<D>::put(fluid_.v, i, fluid_.velocity(i) + dt * by);
        }
        return dot(by, by);
    }));
}

template <int D>
void SphSolver<D>::drift(real dt) {
    const auto timed = passes_.time("integrate");
    advance_time(fluid_, dt);
    parallel_for(0, this->own(), [&](int i) { sph::drift(fluid_, i, dt); });
    this->carry_ice(dt);
}

template <int D>
std::size_t SphSolver<D>::own_bytes() const {
    return (velocity_.capacity() + acceleration_.capacity() + density_.capacity()) * sizeof(float);
}

template class SphSolver<2>;
template class SphSolver<3>;

}  // namespace weir::sph
