#include "sph/reference_solver.hpp"

#include "particles/fastest_flow.hpp"
#include "particles/flow.hpp"

#include <algorithm>
#include <cmath>

namespace weir::sph {

using particles::Fluid;
using particles::Point;

namespace {

#define WEIR_FN inline
#include "particles/kernels/sph_state.inl"

template <int D>
Fluid<D> start_of(const scene::Scene& scene) {
    particles::refuse_what_the_reference_lacks(
        scene, {"gravity", "viscosity", "artificial_viscosity", "density_diffusion", "surface_tension", "rest_density"});
    auto fluid = particles::initial_fluid<D>(scene);
    particles::refuse_idle_walls(scene, fluid.domain, scene.effect("viscosity") != nullptr, "name effects.viscosity");
    return fluid;
}

/// The speed of sound is ten times the fastest flow of the scene's liquid.
template <int D>
Options options_of(const scene::Scene& scene) {
    Fluid<D> fluid = start_of<D>(scene);
    return {scene, particles::fastest_flow(scene, fluid)};
}

}  // namespace

template <int D>
ReferenceSphSolver<D>::ReferenceSphSolver(const scene::Scene& scene) : ReferenceSphSolver(options_of<D>(scene), start_of<D>(scene)) {
    emitters_ = particles::Emitters<D>(scene, fluid_.domain);
    rest_density_ = RestDensity(scene, fluid_.rho0);
    max_dt_ = scene.root().number_or("time.max_dt", infinity);
    start_pressure(scene, options_, fluid_);
    for (const auto& [name, pass] : {std::pair{"gravity", "integrate"},
                                     {"viscosity", "forces"},
                                     {"artificial_viscosity", "forces"},
                                     {"surface_tension", "forces"},
                                     {"density_diffusion", "density"},
                                     {"rest_density", "neighbours"}})
        if (scene.effect(name)) plans_.push_back({.name = name, .inside = pass});
}

template <int D>
ReferenceSphSolver<D>::ReferenceSphSolver(const Options& options, Fluid<D> start)
    : fluid_(std::move(start)), options_(options), rest_density_(fluid_.rho0), rho_rest_(fluid_.rho0) {
    const auto& domain = fluid_.domain;
    reference_.p = sph_params<particles::plain::SphParams, D>(options_, domain.spacing, fluid_.rho0);
    reference_.walls = domain.template walls<particles::plain::WallParams>(density_kernel<D>(options_, domain.spacing),
                                                                           gradient_kernel<D>(options_, domain.spacing));
    reference_.kernel = static_cast<int>(options_.smoothing);
    reference_.period = domain.frame().period;
    reference_.summed = !options_.continuity;
}

/// Müller et al. 2003, section 3: density, pressure, forces; then v += dt a, x += dt v.
template <int D>
StepReport ReferenceSphSolver<D>::step(real dt) {
    emitters_.apply(fluid_, dt);
    find_neighbours();
    find_densities();                                // eq. 3 and 12
    kick(dt);                                        // eq. 10 and 14
    if (options_.continuity) advance_densities(dt);  // Colagrossi & Landrini 2003, eq. 10
    drift(fluid_, dt);
    const real speed = speed_ = fluid_.max_speed();
    real sum = 0, worst = 0;
    for (const real rho : fluid_.density) sum += std::max<real>(0, rho / rho_rest_ - 1), worst = std::max(worst, rho / rho_rest_ - 1);
    const real mean = fluid_.count() ? sum / fluid_.count() : 0;
    ++fluid_.steps;
    fluid_.cross_sides();
    return {.dt = dt, .cfl = dt * (speed + options_.sound) / fluid_.domain.spacing, .density_error = mean, .max_density_error = worst};
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
    rho_rest_ = rest_density_.at(fluid_.time);
    reference_.p.wall_rho = std::min(rho_rest_, fluid_.rho0);
}

/// And pressures.
template <int D>
void ReferenceSphSolver<D>::find_densities() {
    const auto timed = passes_.time("density");
    if (!options_.continuity) fluid_.density = reference_.densities(x_);
    std::transform(fluid_.density.begin(), fluid_.density.end(), fluid_.carried.begin(),
                   [&](real rho) { return options_.pressure(rho, rho_rest_); });
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

/// Of solids that are stuck to: 2 nu plane / phi along the surface (Morris et al. 1997, sec. 3.2).
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
    const Points a = accelerations();
    const auto timed = passes_.time("integrate");
    for (int i = 0; i < fluid_.count(); ++i)
        Fluid<D>::put(fluid_.v, i, fluid_.velocity(i) + dt * (particles::vec_of<D>(a[static_cast<std::size_t>(i)]) + fluid_.gravity));
}

/// d rho / dt = rate, with the new velocities from the old places, as SphSolver does. Walls' images in solids move with them.
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

template <int D>
real ReferenceSphSolver<D>::advised_dt() const {
    return std::min({step_limit<D>(options_, fluid_, fluid_.max_speed(), max_acceleration_), max_dt_, tension_limit<D>(options_, fluid_)});
}

template <int D>
FieldSet ReferenceSphSolver<D>::fields() const {
    FieldSet set;
    fluid_.show(set);
    set.fields.push_back({"pressure", "Pa", Where::particle, "particles", {std::span<const real>(fluid_.carried)}});
    return set;
}

template <int D>
std::vector<Integral> ReferenceSphSolver<D>::integrals() const {
    auto list = fluid_.integrals();
    particles::add_neighbour_counts(reference_.neighbours, list);
    return list;
}

template <int D>
void ReferenceSphSolver<D>::save(Checkpoint& to) const {
    fluid_.save(to);
    emitters_.save(to);
    to.put_value("sph.max_acceleration", max_acceleration_);
    to.put_value("sph.speed", speed_);
}
template <int D>
void ReferenceSphSolver<D>::restore(const Checkpoint& from) {
    fluid_.restore(from);
    emitters_.restore(from);
    max_acceleration_ = from.get_value<real>("sph.max_acceleration");
    speed_ = from.has("sph.speed") ? from.get_value<real>("sph.speed") : not_applicable;  // the device does not keep it
}

template <int D>
std::size_t ReferenceSphSolver<D>::bytes() const {
    return fluid_.bytes() + x_.capacity() * sizeof(Point) + particles::bytes_of(reference_.neighbours);
}

template class ReferenceSphSolver<2>;
template class ReferenceSphSolver<3>;

}  // namespace weir::sph
