// What a scene of SPH becomes on any backend: the rest density over time, the first pressure, kernels for the passes over velocities,
// limits of the time step.
#pragma once
#include "core/parallel.hpp"
#include "particles/bodies_in_liquid.hpp"
#include "particles/fluid.hpp"
#include "particles/passes.hpp"
#include "sph/options.hpp"

#include <string>
#include <vector>

namespace weir::sph {

/// The scene's liquid at the start. Throws BadScene where walls are stuck to without viscosity.
template <int D>
particles::Fluid<D> first_fluid(const scene::Scene& scene);

/// Whether the liquid sticks to any.
template <int D>
bool sticky(const geometry::Solids<D>& solids);

/// The kernels of SPH as XSPH and vorticity read them.
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

/// The pressure of a liquid at rest, below initial.surface or, where the scene does not name it, where a liquid rests (rest.hpp), and the
/// densities that go with that. Answers what a user should know of it.
template <int D>
std::string start_pressure(const scene::Scene& scene, const Options& options, particles::Fluid<D>& fluid);

/// The limits of Monaghan 1992 and Morris 1997 with the smoothing length s = support / 2: sound, viscosity, force.
template <int D>
real step_limit(const Options& options, const particles::Fluid<D>& fluid, real speed, real acceleration);

/// The period of the shortest capillary wave that the support holds (Brackbill, Kothe & Zemach 1992).
template <int D>
real tension_limit(const Options& options, const particles::Fluid<D>& fluid);

/// Sound crosses half the support in it. speed: of the fastest particle after the last step; not a number before the first [m/s].
template <int D>
StepLimit stable_step(const Options& options, const particles::Fluid<D>& fluid, real speed);
/// What is wrong with particles of this speed, in one line; empty where nothing is.
std::string too_fast(const Options& options, real speed, real time);

/// What a body gives to a particle i that meets it, before the body's own change: the push of the pressure, which goes on inside the body
/// as it does behind a wall, and the drag of one that the liquid sticks to. The pressure is that of the step's end, as the last step
/// changed it
/// (`rise`): with that of its begin a body that weighs nothing beats against the water that it moves, in six steps, and nothing damps it.
/// Returns the part that the passes over pairs give no solid [m/s^2]: of that change, and of the pressure behind the body what grows across
/// its surface.
template <int D>
Vec<D> meet_body(const Options& options, const particles::plain::SphParams& params, const particles::Fluid<D>& fluid, int i, real rise,
                 real dt, particles::Meeting<D>& m);
/// The same of all meetings, whose sorted particles k belong to owner(k) of the state: `beside` are these, and what the passes leave out
/// comes to the accelerations (float4). rise: of the pressures in the last step.
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
/// v gets what the bodies' own change takes off what they gave.
template <int D>
void give_back(const particles::BodiesInLiquid<D>& bodies, particles::Fluid<D>& fluid);
/// Meetings with the bodies that particles would drift into.
template <int D>
void find_pushes(particles::BodiesInLiquid<D>& bodies, const particles::Fluid<D>& fluid, const std::vector<int>& near, real dt);
/// X += dt V, and these meetings. Their bodies' velocities are those of the step's end then.
template <int D>
void move_bodies(particles::BodiesInLiquid<D>& bodies, particles::Fluid<D>& fluid, const std::vector<int>& near, real dt);

/// x += dt v. What would enter a wall or a solid is put back and loses its speed into it.
template <int D>
void drift(particles::Fluid<D>& fluid, real dt);
/// The same in two parts: time goes on, and a particle moves.
template <int D>
void advance_time(particles::Fluid<D>& fluid, real dt);
template <int D>
void drift(particles::Fluid<D>& fluid, int i, real dt);

}  // namespace weir::sph
