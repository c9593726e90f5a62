#include "sph/reference_solver.hpp"

#include "particles/state/fastest_flow.hpp"

#include <algorithm>
#include <cmath>

namespace weir::sph {

using particles::Fluid;
using particles::Point;

namespace {

#define WEIR_FN inline
#include "particles/kernels/sph_state.inl"

const particles::ReferenceEffects& effects() {
    static const particles::ReferenceEffects list{{"gravity", "integrate"},           {"viscosity", "forces"},
                                                  {"artificial_viscosity", "forces"}, {"density_diffusion", "density"},
                                                  {"surface_tension", "forces"},      {"rest_density", "neighbours"}};
    return list;
}

template <int D>
Fluid<D> start_of(const scene::Scene& scene) {
    particles::refuse_what_the_reference_lacks(scene, effects());
    return first_fluid<D>(scene);
}

}  // namespace

template <int D>
ReferenceSphSolver<D>::ReferenceSphSolver(const scene::Scene& scene) : ReferenceSphSolver(scene, start_of<D>(scene)) {}

template <int D>
ReferenceSphSolver<D>::ReferenceSphSolver(const scene::Scene& scene, Fluid<D>&& start)
    : ReferenceSphSolver{Options(scene, particles::fastest_flow(scene, start)), std::move(start)} {
    this->take(scene, sph::effects());
    this->start_from(scene, fluid_);
}

template <int D>
ReferenceSphSolver<D>::ReferenceSphSolver(const Options& options, Fluid<D> start) : Base(options, std::move(start)) {
    reference_.p = sph_params<particles::plain::SphParams, D>(options_, fluid_.domain.spacing, fluid_.rho0);
    reference_.summed = !options_.continuity;
}

/// Müller et al. 2003, section 3: density, pressure, forces; then v += dt a, x += dt v.
template <int D>
StepReport ReferenceSphSolver<D>::step(real dt) {
    emitters_.apply(fluid_, dt);
    find_neighbours();
    find_densities();                                // eq. 3 and 12
    kick(dt);                                        // eq. 10 and 14
    this->stop_frozen();                             // frozen particles
    if (options_.continuity) advance_densities(dt);  // Colagrossi & Landrini 2003, eq. 10
    if (bodies_) sph::move_bodies(*bodies_, fluid_, beside_bodies_, dt);
    drift(fluid_, dt);
    if (bodies_) apply_reaction(*bodies_, fluid_);  // by particles inside bodies
    this->carry_ice(dt);
    this->conduct(dt);  // only where the scene names a substance
    const real speed = speed_ = this->speed();
    real sum = 0, worst = 0;
    for (int i = 0; i < fluid_.count(); ++i) {
        const real excess = fluid_.density[static_cast<std::size_t>(i)] / this->rest_of(i) - 1;
        sum += std::max<real>(0, excess), worst = std::max(worst, excess);
    }
    const real mean = fluid_.count() ? sum / fluid_.count() : 0;
    this->end_step();
    return this->report(dt, speed, {mean, worst});
}

template <int D>
typename ReferenceSphSolver<D>::Points ReferenceSphSolver<D>::velocities() const {
    Points v;
    for (int i = 0; i < fluid_.count(); ++i) v.push_back(particles::point_of(fluid_.velocity(i)));
    return v;
}

template <int D>
void ReferenceSphSolver<D>::find_neighbours() {
    const auto timed = passes_.time("neighbours");
    x_.clear();
    for (int i = 0; i < fluid_.count(); ++i) x_.push_back(particles::point_of(fluid_.position(i) - fluid_.domain.centre()));
    reference_.find_neighbours(x_);
    add_solids(reference_, fluid_.domain, x_);
    this->expand();
    rho_rest_ = rest_density_.at(fluid_.time);
    reference_.p.wall_rho = std::min(rho_rest_, fluid_.rho0);
}

/// Also computes pressures.
template <int D>
void ReferenceSphSolver<D>::find_densities() {
    const auto timed = passes_.time("density");
    if (!options_.continuity) fluid_.density = reference_.densities(x_);
    rise_ = fluid_.carried;
    for (int i = 0; i < fluid_.count(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        fluid_.carried[at] = options_.pressure(fluid_.density[at], this->rest_of(i));
        rise_[at] = fluid_.carried[at] - rise_[at];
    }
}

template <int D>
typename ReferenceSphSolver<D>::Points ReferenceSphSolver<D>::accelerations() {
    const auto timed = passes_.time("forces");
    Points a = reference_.accelerations(x_, velocities(), fluid_.density, fluid_.carried);
    add_drag_of_solids(a);
    real largest = 0;
    for (const Point& p : a) largest = std::max(largest, p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    max_acceleration_ = std::sqrt(largest);
    if (options_.sigma > 0) {
        const Points tension = reference_.tensions(x_, fluid_.density);
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) a[i][c] += tension[i][c];
    }
    return a;
}

/// Drag of no-slip solids: 2 nu plane / phi along the surface (Morris et al. 1997, sec. 3.2).
template <int D>
void ReferenceSphSolver<D>::add_drag_of_solids(Points& to) const {
    const auto& solids = fluid_.domain.solids;
    for (std::size_t i = 0; i < reference_.solid.size(); ++i) {
        const Vec<D> x = fluid_.position(static_cast<int>(i)), pull = particles::vec_of<D>(reference_.solid[i]);
        const real plane = norm(pull), phi = std::max(solids.distance(x), 0.25 * fluid_.domain.spacing);
        if (plane == 0 || !solids[solids.nearest(x)].no_slip) continue;
        const Vec<D> slip = solids.velocity(x) - fluid_.velocity(static_cast<int>(i)),
                     along = slip - dot(slip, pull) / (plane * plane) * pull;
        for (int a = 0; a < D; ++a) to[i][static_cast<std::size_t>(a)] += 2 * options_.viscosity * plane / phi * along[a];
    }
}

/// v += dt a, with gravity.
template <int D>
void ReferenceSphSolver<D>::kick(real dt) {
    Points a = accelerations();
    const auto timed = passes_.time("integrate");
    if (bodies_) meet_bodies(a, dt);
    for (int i = 0; i < fluid_.count(); ++i)
        Fluid<D>::put(fluid_.v, i, fluid_.velocity(i) + dt * (particles::vec_of<D>(a[static_cast<std::size_t>(i)]) + fluid_.gravity));
    if (!bodies_) return;
    bodies_->exchange(fluid_.domain, dt, true);
    apply_reaction(*bodies_, fluid_);
}

/// Forces of bodies on particles, including terms that the accelerations omit.
template <int D>
void ReferenceSphSolver<D>::meet_bodies(Points& a, real dt) {
    bodies_->begin(fluid_.domain, fluid_.time, dt);
    particles::meet_bodies(reference_, fluid_.domain, x_, bodies_->meetings());
    beside_bodies_.clear();
    for (auto& m : bodies_->meetings()) {
        const Vec<D> beyond = meet_body(options_, reference_.p, fluid_, m.particle,
                                        bodies_->over_last(dt) * rise_[static_cast<std::size_t>(m.particle)], dt, m);
        for (int b = 0; b < D; ++b) a[static_cast<std::size_t>(m.particle)][static_cast<std::size_t>(b)] += beyond[b];
        beside_bodies_.push_back(m.particle);
    }
}

/// d rho / dt = rate, with the new velocities at the old positions, as in SphSolver. Images behind moving solids move with them.
template <int D>
void ReferenceSphSolver<D>::advance_densities(real dt) {
    const auto timed = passes_.time("density");
    auto rate = reference_.rates(x_, velocities(), fluid_.density, fluid_.rho0);
    for (std::size_t i = 0; i < reference_.solid.size(); ++i)
        rate[i] -= 2 * fluid_.density[i] *
                   dot(fluid_.domain.solids.velocity(fluid_.position(static_cast<int>(i))), particles::vec_of<D>(reference_.solid[i]));
    for (std::size_t i = 0; i < rate.size(); ++i) {
        real& rho = fluid_.density[i];
        rho = density_kept(rho * density_growth(dt * rate[i] / rho), fluid_.rho0);
    }
}

template class ReferenceSphSolver<2>;
template class ReferenceSphSolver<3>;

}  // namespace weir::sph
