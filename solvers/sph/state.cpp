#include "sph/state.hpp"

#include "core/parallel.hpp"
#include "particles/state/flow.hpp"
#include "sph/rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::sph {

template <int D>
particles::Fluid<D> first_fluid(const scene::Scene& scene) {
    auto fluid = particles::initial_fluid<D>(scene);
    particles::refuse_idle_walls(scene, fluid.domain, scene.effect("viscosity") != nullptr, "add effects.viscosity");
    return fluid;
}

template <int D>
bool sticky(const geometry::Solids<D>& solids) {
    bool any = false;
    for (std::size_t i = 0; i < solids.count(); ++i) any = any || solids[i].no_slip;
    return any;
}

template <int D>
particles::single::PbfParams smoothing_params(const particles::single::SphParams& p, const particles::Fluid<D>& fluid) {
    const real scale = particles::cell_volume<D>(fluid.domain.spacing) / fluid.mass;
    particles::single::PbfParams s{};
    s.h = p.h, s.h2 = p.h2, s.guard = p.guard;
    s.self = static_cast<float>(static_cast<real>(p.self) * scale);
    s.density = static_cast<float>(static_cast<real>(p.density) * scale);
    s.gradient = static_cast<float>(static_cast<real>(p.gradient) * scale);
    return s;
}

RestDensity::RestDensity(const scene::Scene& scene, real rho0) : rho0_(rho0) {
    const auto* e = scene.effect("rest_density");
    if (!e) return;
    times_ = e->numbers("times");
    values_ = e->numbers("values");
    if (times_.size() != values_.size() || times_.empty())
        scene.refuse("effects.rest_density", "times and values must be lists of the same length, at least one");
}

real RestDensity::at(real time) const {
    if (times_.empty()) return rho0_;
    if (time <= times_.front()) return values_.front();
    for (std::size_t k = 1; k < times_.size(); ++k)
        if (time < times_[k]) return values_[k - 1] + (values_[k] - values_[k - 1]) * (time - times_[k - 1]) / (times_[k] - times_[k - 1]);
    return values_.back();
}

template <int D>
std::string start_pressure(const scene::Scene& scene, const Options& options, particles::Fluid<D>& fluid) {
    std::string hint;
    if (scene.has("initial.surface")) {
        if (!options.continuity)
            scene.refuse("initial.surface", "initial.surface requires a density by its rate", "set scheme.density = \"continuity\"");
        const Vec<D> surface = scene.vec<D>("initial.surface");
        for (int i = 0; i < fluid.count(); ++i)
            fluid.carried[static_cast<std::size_t>(i)] = std::max<real>(0, fluid.rho0 * dot(fluid.gravity, fluid.position(i) - surface));
    } else if (options.continuity && !fluid.warm && !scene.effect("rest_density")) {
        hint = start_at_rest(fluid);
    } else {
        return hint;
    }
    for (std::size_t i = 0; i < fluid.density.size(); ++i) fluid.density[i] = options.density(fluid.carried[i], fluid.density[i]);
    return hint;
}

template <int D>
real step_limit(const Options& o, const particles::Fluid<D>& fluid, real speed, real acceleration) {
    const real s = 0.5 * o.support * fluid.domain.spacing;
    const real acoustic = 0.4 * s / ((o.sound + speed) * (1 + 0.6 * o.artificial));
    const real viscous = o.viscosity > 0 ? 0.125 * s * s / o.viscosity : infinity;
    const real strongest = acceleration + norm(fluid.gravity);
    return std::min({acoustic, viscous, strongest > 0 ? 0.25 * std::sqrt(s / strongest) : infinity});
}

template <int D>
real tension_limit(const Options& o, const particles::Fluid<D>& fluid) {
    const real s = 0.5 * o.support * fluid.domain.spacing;
    return o.sigma > 0 ? 0.25 * std::sqrt(fluid.rho0 * s * s * s / (2 * pi * o.sigma)) : infinity;
}

template <int D>
StepLimit stable_step(const Options& o, const particles::Fluid<D>& fluid, real speed) {
    if (std::isnan(speed)) speed = fluid.max_speed();
    return {0.5 * o.support * fluid.domain.spacing / (o.sound + speed), "sound crosses half the support"};
}

/// Density varies by about the square of the Mach number: by a hundredth at 0.1, by a tenth at this one.
std::string too_fast(const Options& o, real speed, real time) {
    constexpr real most = 0.3;
    if (!(speed > most * o.sound)) return {};
    return fmt::format(
        "the fastest particle moves at {:.4g} m/s at t = {:.4g} s, Mach {:.2g} of a speed of sound of {:.4g} m/s: beyond Mach {:g} "
        "density changes by more than a tenth; scheme.sound_speed = {:.4g} would keep it within a hundredth",
        speed, time, speed / o.sound, o.sound, most, 10 * speed);
}

template <int D>
void advance_time(particles::Fluid<D>& fluid, real dt) {
    fluid.time += dt;
    if (!fluid.domain.solids.empty()) fluid.domain.solids.set_time(fluid.time);
}

template <int D>
void drift(particles::Fluid<D>& fluid, int i, real dt) {
    using particles::Fluid;
    const Vec<D> u = fluid.velocity(i), free = fluid.position(i) + dt * u, x = fluid.domain.kept(free, fluid.corrections);
    Vec<D> kept = u;
    for (int a = 0; a < D; ++a)
        if (x[a] != free[a]) kept[a] = (x[a] - fluid.position(i)[a]) / dt;
    Fluid<D>::put(fluid.v, i, kept);
    Fluid<D>::put(fluid.x, i, x);
}

template <int D>
void drift(particles::Fluid<D>& fluid, real dt) {
    advance_time(fluid, dt);
    parallel_for(0, fluid.count(), [&](int i) { drift(fluid, i, dt); });
}

template <int D>
Vec<D> meet_body(const Options& o, const particles::plain::SphParams& p, const particles::Fluid<D>& fluid, int i, real rise, real dt,
                 particles::Meeting<D>& m) {
    const auto& solids = fluid.domain.solids;
    const std::size_t solid = fluid.domain.first_body() + static_cast<std::size_t>(m.body);
    const real plane = norm(m.pull), phi = std::max<real>(0, solids.distance(m.at)), rho = fluid.density[static_cast<std::size_t>(i)];
    if (plane == 0) return {};
    const real before = fluid.carried[static_cast<std::size_t>(i)], pressure = o.tension ? before + rise : std::max<real>(0, before + rise);
    const Vec<D> normal = m.pull / plane;  // into the body
    Vec<D> by = -2 * before / rho * m.pull, beyond = -2 * (pressure - before) / rho * m.pull;
    if (o.wall_forces()) {  // as sph_wall_force in kernels/sph_pair.inl
        const real faded = std::min<real>(1, std::max<real>(0, before) * p.per_depth);
        Vec<D> g;
        for (int a = 0; a < D; ++a) g[a] = p.gravity[a];
        by -= m.part * faded * g;
        beyond -= dot(g, normal) * phi * plane * faded * normal;
    }
    m.stiff = pressure != 0 ? 4 * o.sound * o.sound * dt * dt : 0;
    if (solids[solid].no_slip) {
        const Vec<D> slip = solids.velocity(m.at) - fluid.velocity(i);
        const real drag = 2 * o.viscosity * plane / m.open / std::max<real>(phi, p.closest);
        by += drag * (slip - dot(slip, normal) * normal);
        m.friction = dt * drag;
    }
    m.given = dt * (by + beyond);
    return beyond;
}

template <int D>
void find_pushes(particles::BodiesInLiquid<D>& bodies, const particles::Fluid<D>& fluid, const std::vector<int>& near, real dt) {
    bodies.meetings().clear();
    for (const int i : near) bodies.push_out(fluid.domain, i, fluid.position(i) + dt * fluid.velocity(i), dt);
}

template <int D>
void apply_reaction(const particles::BodiesInLiquid<D>& bodies, particles::Fluid<D>& fluid) {
    using particles::Fluid;
    for (const auto& m : bodies.meetings())
        if (m.body >= 0) Fluid<D>::put(fluid.v, m.particle, fluid.velocity(m.particle) + bodies.back(m));
}

template <int D>
void move_bodies(particles::BodiesInLiquid<D>& bodies, particles::Fluid<D>& fluid, const std::vector<int>& near, real dt) {
    fluid.domain.solids.set_time(fluid.time + dt);
    bodies.move(fluid.domain, dt);
    find_pushes(bodies, fluid, near, dt);
    if (!bodies.meetings().empty()) bodies.exchange(fluid.domain, dt, false);
    bodies.end(fluid.domain, dt, dt);
}

template void apply_reaction(const particles::BodiesInLiquid<2>&, particles::Fluid<2>&);
template void apply_reaction(const particles::BodiesInLiquid<3>&, particles::Fluid<3>&);
template void move_bodies(particles::BodiesInLiquid<2>&, particles::Fluid<2>&, const std::vector<int>&, real);
template void move_bodies(particles::BodiesInLiquid<3>&, particles::Fluid<3>&, const std::vector<int>&, real);
template Vec<2> meet_body(const Options&, const particles::plain::SphParams&, const particles::Fluid<2>&, int, real, real,
                          particles::Meeting<2>&);
template Vec<3> meet_body(const Options&, const particles::plain::SphParams&, const particles::Fluid<3>&, int, real, real,
                          particles::Meeting<3>&);
template void find_pushes(particles::BodiesInLiquid<2>&, const particles::Fluid<2>&, const std::vector<int>&, real);
template void find_pushes(particles::BodiesInLiquid<3>&, const particles::Fluid<3>&, const std::vector<int>&, real);
template particles::Fluid<2> first_fluid(const scene::Scene&);
template particles::Fluid<3> first_fluid(const scene::Scene&);
template bool sticky(const geometry::Solids<2>&);
template bool sticky(const geometry::Solids<3>&);
template StepLimit stable_step(const Options&, const particles::Fluid<2>&, real);
template StepLimit stable_step(const Options&, const particles::Fluid<3>&, real);
template void advance_time(particles::Fluid<2>&, real);
template void advance_time(particles::Fluid<3>&, real);
template void drift(particles::Fluid<2>&, int, real);
template void drift(particles::Fluid<3>&, int, real);
template void drift(particles::Fluid<2>&, real);
template void drift(particles::Fluid<3>&, real);
template particles::single::PbfParams smoothing_params(const particles::single::SphParams&, const particles::Fluid<2>&);
template particles::single::PbfParams smoothing_params(const particles::single::SphParams&, const particles::Fluid<3>&);
template std::string start_pressure(const scene::Scene&, const Options&, particles::Fluid<2>&);
template std::string start_pressure(const scene::Scene&, const Options&, particles::Fluid<3>&);
template real step_limit(const Options&, const particles::Fluid<2>&, real, real);
template real step_limit(const Options&, const particles::Fluid<3>&, real, real);
template real tension_limit(const Options&, const particles::Fluid<2>&);
template real tension_limit(const Options&, const particles::Fluid<3>&);

}  // namespace weir::sph
