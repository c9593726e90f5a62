// One step of PBF by the plain double-precision reference over all pairs, from any state: what every backend is compared with.
#pragma once
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

/// The same step by the reference: predict, iterate over all pairs in double precision.
template <int D>
struct Expected {
    particles::Domain<D> domain;  // as it is at the end of the step
    std::vector<particles::Point> x;
    real largest_lambda = 0, largest_move = 0;

    Expected(const pbf::Options& o, const particles::Fluid<D>& before, real dt) : domain(before.domain) {
        domain.solids.set_time(before.time + dt);
        const real d = domain.spacing;
        particles::ReferencePbf reference;
        reference.p = pbf::pbf_params<particles::plain::PbfParams, D>(o, d);
        reference.walls = domain.template walls<particles::plain::WallParams>(pbf::density_kernel<D>(o, d), pbf::gradient_kernel<D>(o, d));
        reference.kernel = static_cast<int>(o.smoothing);
        reference.period = periods(domain);
        for (int i = 0; i < before.count(); ++i) {
            Vec<D> u = before.velocity(i);
            u[1] -= dt * 9.81;
            const Vec<D> local = domain.kept(before.position(i) + dt * u) - domain.centre();
            particles::Point p{0, 0, 0};
            for (int a = 0; a < D; ++a) p[static_cast<std::size_t>(a)] = local[a];
            x.push_back(p);
        }
        const auto start = x;
        reference.find_neighbours(x);
        std::vector<double> sums(x.size(), 0.0);
        for (int iteration = 0; iteration < o.iterations; ++iteration) {
            add_solids(reference, domain, x);
            const auto lambda = reference.lambdas(x, o.warm_start > 0 ? &sums : nullptr);
            for (const real l : lambda) largest_lambda = std::max(largest_lambda, std::abs(l));
            x = reference.corrected(x, lambda);
            leave_solids(x);
        }
        for (std::size_t i = 0; i < x.size(); ++i) largest_move = std::max(largest_move, std::abs(x[i][1] - start[i][1]));
        for (auto& p : x)
            for (int a = 0; a < D; ++a) p[static_cast<std::size_t>(a)] += domain.centre()[a];
    }
    void leave_solids(std::vector<particles::Point>& places) const {
        if (domain.solids.empty()) return;
        for (auto& p : places) {
            Vec<D> at = domain.centre();
            for (int a = 0; a < D; ++a) at[a] += p[static_cast<std::size_t>(a)];
            at = domain.kept(at) - domain.centre();
            for (int a = 0; a < D; ++a) p[static_cast<std::size_t>(a)] = at[a];
        }
    }
    /// The largest difference along an axis.
    real farthest(const particles::Fluid<D>& after) const {
        real worst = 0;
        for (int i = 0; i < after.count(); ++i) {
            Vec<D> there;
            for (int a = 0; a < D; ++a) there[a] = x[static_cast<std::size_t>(i)][static_cast<std::size_t>(a)];
            for (const real c : apart(domain, after.position(i), there)) worst = std::max(worst, std::abs(c));
        }
        return worst;
    }
};

}  // namespace weir::test
