#include "sph/device_solver.hpp"

#include "particles/fastest_flow.hpp"
#include "particles/flow.hpp"

#include <algorithm>

namespace weir::sph {

using particles::Fluid;

namespace {

/// Whether the liquid sticks to any.
template <int D>
bool sticky(const geometry::Solids<D>& solids) {
    bool any = false;
    for (std::size_t i = 0; i < solids.count(); ++i) any = any || solids[i].no_slip;
    return any;
}

}  // namespace

template <int D>
particles::DeviceSetup DeviceSphSolver<D>::setup(const Options& options, const Fluid<D>& fluid) {
    const real d = fluid.domain.spacing;
    particles::DeviceSetup s;
    s.device = options.backend.device;
    s.kernel = static_cast<int>(options.smoothing);
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
    s.kernels = smoothing_params(sph_params<particles::single::SphParams, D>(options, d, fluid.rho0), fluid);
    s.walls = fluid.domain.template walls<particles::single::WallParams>(density_kernel<D>(options, d), gradient_kernel<D>(options, d));
    s.support = options.support * d;
    return s;
}

namespace {

template <int D>
Fluid<D> start_of(const scene::Scene& scene) {
    particles::refuse_what_devices_lack(scene);
    auto fluid = particles::initial_fluid<D>(scene);
    particles::refuse_idle_walls(scene, fluid.domain, scene.effect("viscosity") != nullptr, "name effects.viscosity");
    return fluid;
}

/// The fluid of a scene with the speed of sound that goes with it.
template <int D>
Options options_of(const scene::Scene& scene) {
    Fluid<D> fluid = start_of<D>(scene);
    return {scene, particles::fastest_flow(scene, fluid)};
}

}  // namespace

template <int D>
DeviceSphSolver<D>::DeviceSphSolver(const scene::Scene& scene) : DeviceSphSolver(scene, start_of<D>(scene), options_of<D>(scene)) {}

template <int D>
DeviceSphSolver<D>::DeviceSphSolver(const scene::Scene& scene, Fluid<D> start, const Options& options)
    : options_(options),
      fluid_(start, particles::DeviceEffects<D>(scene), setup(options_, start)),
      rest_density_(scene, start.rho0),
      sticky_solids_(sticky(start.domain.solids)),
      rho_rest_(start.rho0),
      max_dt_(scene.root().number_or("time.max_dt", infinity)) {
    start_pressure(scene, options_, fluid_.change());
    fluid_.plan().want(velocities_, 4 * sizeof(float));
    fluid_.plan().want(acceleration_, 4 * sizeof(float));
    if (options_.sigma > 0) fluid_.plan().want(normals_, 4 * sizeof(float));
    params_ = fluid_.constant(sph_params<particles::single::SphParams, D>(options_, start.domain.spacing, start.rho0));
    fluid_.settle_in();
}

/// Müller et al. 2003, section 3: density, pressure, forces; then v += dt a, x += dt v.
template <int D>
StepReport DeviceSphSolver<D>::step(real dt) {
    fluid_.let_in(dt);
    rho_rest_ = rest_density_.at(fluid_.time());
    fluid_.find_neighbours(fluid_.x);
    if (!options_.continuity) find_densities();  // eq. 3
    find_pressures();                            // eq. 12
    find_forces();                               // eq. 10 and 14
    kick(dt);
    if (options_.continuity) advance_densities(dt);  // Colagrossi & Landrini 2003, eq. 10
    drift(dt);
    fluid_.finish(dt);  // XSPH, vorticity
    const real speed = fluid_.max_speed();
    const auto c = fluid_.reduce("compressions", {fluid_.count(), rho_rest_, fluid_.density, fluid_.parts()});
    const real mean = fluid_.count() ? c.sum / fluid_.count() : 0;  // of all that were there, also those that leave now
    fluid_.end_step();
    fluid_.record(passes_);
    return {
        .dt = dt, .cfl = dt * (speed + options_.sound) / fluid_.domain().spacing, .density_error = mean, .max_density_error = c.largest};
}

template <int D>
void DeviceSphSolver<D>::find_densities() {
    const auto& f = fluid_;
    const auto behind_walls = static_cast<float>(std::min(rho_rest_, f.rest_density()));
    fluid_.run("sph_densities",
               {f.count(), f.stride(), params_, f.wall_params, f.terms, behind_walls, f.a, f.neighbours, f.list, f.order, f.density});
}

template <int D>
void DeviceSphSolver<D>::find_pressures() {
    const auto& f = fluid_;
    const real c2 = options_.sound * options_.sound;
    const std::array<double, 2> state{options_.gamma == 1 ? c2 : c2 * rho_rest_ / options_.gamma, options_.gamma};
    fluid_.run("find_pressures", {f.count(), f.stride(), state, rho_rest_, f.order, f.v, f.density, f.carried, f.a, velocities_});
}

template <int D>
void DeviceSphSolver<D>::find_forces() {
    const auto& f = fluid_;
    fluid_.run("sph_forces",
               {f.count(), f.stride(), params_, f.wall_params, f.terms, f.a, velocities_, f.neighbours, f.list, acceleration_});
    if (sticky_solids_)
        fluid_.run("drag_at_solids", {f.count(), f.stride(), f.state_params, params_, 2 * options_.viscosity, f.poses, f.a, f.near_solid,
                                      f.terms, f.order, f.v, acceleration_});
    max_acceleration_ = std::sqrt(fluid_.reduce("accelerations", {f.count(), acceleration_, f.parts()}).largest);
}

/// v += dt a, with surface tension, gravity and other fields.
template <int D>
void DeviceSphSolver<D>::kick(real dt) {
    const auto& f = fluid_;
    if (options_.sigma > 0) {
        fluid_.run("normals", {f.count(), f.stride(), params_, f.wall_params, f.terms, f.a, f.neighbours, f.list, normals_});
        fluid_.run("tension", {f.count(), f.stride(), params_, dt, f.a, normals_, f.neighbours, f.list, f.order, f.v});
    }
    fluid_.run("kick", {f.count(), f.stride(), f.state_params, dt, f.pull(dt), f.order, f.x, acceleration_, f.v});
}

/// d rho / dt = rate, as SphSolver does.
template <int D>
void DeviceSphSolver<D>::advance_densities(real dt) {
    const auto& f = fluid_;
    fluid_.run("load_excess", {f.count(), f.stride(), f.rest_density(), f.order, f.v, f.density, velocities_});
    fluid_.run("advance_densities", {f.count(), f.stride(), f.state_params, f.poses, f.near_solid, params_, f.wall_params, f.terms, dt,
                                     f.rest_density(), f.a, velocities_, f.neighbours, f.list, f.order, f.density});
}

/// x += dt v, kept inside the walls and outside the solids.
template <int D>
void DeviceSphSolver<D>::drift(real dt) {
    fluid_.pass_time(dt);
    fluid_.run("drift", {fluid_.count(), fluid_.stride(), fluid_.state_params, fluid_.poses, dt, fluid_.x, fluid_.v});
}

template <int D>
real DeviceSphSolver<D>::advised_dt() const {
    return std::min({step_limit<D>(options_, fluid_.setting(), fluid_.speed(), max_acceleration_), max_dt_, fluid_.max_dt(),
                     tension_limit<D>(options_, fluid_.setting())});
}

template <int D>
FieldSet DeviceSphSolver<D>::fields() const {
    FieldSet set;
    const auto& fluid = fluid_.host();
    fluid.show(set);
    set.fields.push_back({"pressure", "Pa", Where::particle, "particles", {std::span<const real>(fluid.carried)}});
    return set;
}

template <int D>
std::vector<Integral> DeviceSphSolver<D>::integrals() const {
    auto list = fluid_.host().integrals();
    const auto neighbours = fluid_.neighbour_counts();
    list.push_back({"mean_neighbours", "1", neighbours.mean});
    list.push_back({"max_neighbours", "1", neighbours.most});
    return list;
}

template <int D>
void DeviceSphSolver<D>::save(Checkpoint& to) const {
    fluid_.save(to);
    to.put_value("sph.max_acceleration", max_acceleration_);
}
template <int D>
void DeviceSphSolver<D>::restore(const Checkpoint& from) {
    fluid_.restore(from);
    max_acceleration_ = from.get_value<real>("sph.max_acceleration");
}

template class DeviceSphSolver<2>;
template class DeviceSphSolver<3>;

}  // namespace weir::sph
