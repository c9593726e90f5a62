// Initialization of an SPH scene on any backend: the rest density over time, the initial pressure, kernels for the velocity passes, step
// limits.
#pragma once
#include "core/parallel.hpp"
#include "particles/boundaries/bodies_in_liquid.hpp"
#include "particles/state/fluid.hpp"
#include "particles/threads/passes.hpp"
#include "sph/options.hpp"

#include <string>
#include <vector>

namespace weir::sph {

/// The scene's liquid at the start. Throws BadScene for no-slip walls without viscosity.
template <int D>
particles::Fluid<D> first_fluid(const scene::Scene& scene);

/// Returns whether any solid is no-slip.
template <int D>
bool sticky(const geometry::Solids<D>& solids);

/// The kernels of SPH for XSPH and vorticity.
template <int D>
particles::single::PbfParams smoothing_params(const particles::single::SphParams& params, const particles::Fluid<D>& fluid);

/// The effect rest_density: linear between the given times, constant outside; without it the fluid's own.
class RestDensity {
public:
    RestDensity(const scene::Scene& scene, real rho0);
    explicit RestDensity(real rho0) : rho0_(rho0) {}
    bool constant() const { return times_.empty(); }
    real at(real time) const;

private:
    std::vector<double> times_, values_;
    real rho0_;
};

/// The hydrostatic pressure, below initial.surface or, where the scene does not give it, of liquid at rest (rest.hpp), and the
/// corresponding densities. Returns a warning for the user, or an empty text.
template <int D>
std::string start_pressure(const scene::Scene& scene, const Options& options, particles::Fluid<D>& fluid);

/// The limits of Monaghan 1992 and Morris 1997 with the smoothing length s = support / 2: sound, viscosity, force.
template <int D>
real step_limit(const Options& options, const particles::Fluid<D>& fluid, real speed, real acceleration);

/// The period of the shortest capillary wave resolved by the support (Brackbill, Kothe & Zemach 1992).
template <int D>
real tension_limit(const Options& options, const particles::Fluid<D>& fluid);

/// Sound crosses half the support in it. speed: maximum over the particles after the last step; NaN before the first [m/s].
template <int D>
StepLimit stable_step(const Options& options, const particles::Fluid<D>& fluid, real speed);
/// A warning about particles of this speed, in one line; otherwise empty.
std::string too_fast(const Options& options, real speed, real time);

/// The velocity change of a particle i by a coupled body, before the body's own change: by the pressure, extrapolated into the body as
/// behind a wall, and by the drag of a no-slip body. The pressure is that at the end of the step, extrapolated by its change in the last
/// step (`rise`). With that at the start, a massless body oscillates against the displaced water with a period of six steps, undamped.
/// Returns the part that the pair passes omit for solids [m/s^2]: due to that change, and to the pressure gradient normal to the body's
/// surface.
template <int D>
Vec<D> meet_body(const Options& options, const particles::plain::SphParams& params, const particles::Fluid<D>& fluid, int i, real rise,
                 real dt, particles::Meeting<D>& m);
/// The same for all coupling pairs, whose sorted particles k belong to owner(k) of the state: `beside` are these; the omitted terms are
/// added to the accelerations (float4). rise: change of the pressures in the last step.
template <int D, class Owner>
void meet_bodies(const Options& options, const particles::plain::SphParams& params, const particles::Fluid<D>& fluid,
                 particles::BodiesInLiquid<D>& bodies, Owner&& owner, const std::vector<real>& rise, real dt, std::vector<int>& beside,
                 float* acceleration) {
    auto& meetings = bodies.meetings();
    beside.resize(meetings.size());
    parallel_for(0, static_cast<int>(meetings.size()), [&](int at) {
        auto& m = meetings[static_cast<std::size_t>(at)];
        const int k = m.particle, i = beside[static_cast<std::size_t>(at)] = owner(k);
        m.particle = i;
        if (m.body < 0) return;
        const Vec<D> beyond = meet_body(options, params, fluid, i, bodies.over_last(dt) * rise[static_cast<std::size_t>(i)], dt, m);
        for (int a = 0; a < D; ++a) acceleration[4 * k + a] += static_cast<float>(beyond[a]);
    });
}
/// Adds to v the part of the bodies' forces that their own change removes.
template <int D>
void apply_reaction(const particles::BodiesInLiquid<D>& bodies, particles::Fluid<D>& fluid);
/// Finds coupling pairs with the bodies that particles would drift into.
template <int D>
void find_pushes(particles::BodiesInLiquid<D>& bodies, const particles::Fluid<D>& fluid, const std::vector<int>& near, real dt);
/// X += dt V, and these pairs. Afterwards the bodies have their velocities at the end of the step.
template <int D>
void move_bodies(particles::BodiesInLiquid<D>& bodies, particles::Fluid<D>& fluid, const std::vector<int>& near, real dt);

/// x += dt v. A particle that would enter a wall or a solid is moved back and loses its normal velocity.
template <int D>
void drift(particles::Fluid<D>& fluid, real dt);
/// The same in two parts: advances time, and moves a particle.
template <int D>
void advance_time(particles::Fluid<D>& fluid, real dt);
template <int D>
void drift(particles::Fluid<D>& fluid, int i, real dt);

}  // namespace weir::sph
