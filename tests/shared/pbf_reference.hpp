// One step of PBF by the plain double-precision reference over all pairs, from any state: what every backend is compared with.
#pragma once
#include "pbf/reference_solver.hpp"
#include "shared/surroundings.hpp"
#include "unit/pbf/scenes.hpp"

#include <algorithm>
#include <random>

namespace weir::test {

/// Shakes the particles by up to a fifth of a spacing and squeezes them downwards, so that constraints act everywhere.
template <int D>
void disturb(particles::Fluid<D>& fluid) {
    std::mt19937 random(7);
    std::uniform_real_distribution<real> jitter(-0.2, 0.2);
    for (int i = 0; i < fluid.count(); ++i) {
        Vec<D> x = fluid.position(i), u{};
        for (int a = 0; a < D; ++a) x[a] += fluid.domain.spacing * jitter(random), u[a] = jitter(random);
        x[1] *= 0.97;
        particles::Fluid<D>::put(fluid.x, i, fluid.domain.wrapped(fluid.domain.kept(x)));
        particles::Fluid<D>::put(fluid.v, i, fluid.velocity(i) + u);
    }
}

/// The same step by the reference.
template <int D>
struct Expected {
    particles::Fluid<D> after;
    real largest_lambda = 0, largest_move = 0;

    Expected(const pbf::Options& o, const particles::Fluid<D>& before, real dt) {
        pbf::ReferencePbfSolver<D> solver(o, before);
        solver.step(dt);
        after = solver.fluid();
        for (const real l : solver.lambda()) largest_lambda = std::max(largest_lambda, std::abs(l));
        for (int i = 0; i < before.count(); ++i) {
            const Vec<D> free = before.position(i) + dt * (before.velocity(i) + dt * before.gravity);
            largest_move = std::max(largest_move, std::abs(apart(after.domain, after.position(i), after.domain.kept(free))[1]));
        }
    }
    /// The largest difference along an axis.
    real farthest(const particles::Fluid<D>& other) const {
        real worst = 0;
        for (int i = 0; i < other.count(); ++i)
            for (const real c : apart(after.domain, other.position(i), after.position(i))) worst = std::max(worst, std::abs(c));
        return worst;
    }
};

}  // namespace weir::test
