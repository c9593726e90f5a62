#include "particles/state/fastest_flow.hpp"

#include "parallel/communicator.hpp"
#include "rigid/bodies.hpp"

namespace weir::particles {

namespace {

/// Specific potential energy between x and the lowest corner of the domain [J/kg].
template <int D>
real depth_below(const Fluid<D>& fluid, const Vec<D>& x) {
    real sum = 0;
    for (int a = 0; a < D; ++a) {
        const real g = fluid.gravity[a], corner = g > 0 ? fluid.domain.hi[a] : fluid.domain.lo[a];
        sum += g * (corner - x[a]);
    }
    return std::max<real>(0, sum);
}

/// Maximum speed of the solids over the whole run, sampled on a coarse lattice near them.
template <int D>
real fastest_solid(Fluid<D>& fluid, real end) {
    auto& solids = fluid.domain.solids;
    if (solids.empty() || !solids.moving()) return 0;
    constexpr int times = 64, places = 8;
    const Vec<D> step = (1.0 / places) * (fluid.domain.hi - fluid.domain.lo);
    real fastest = 0;
    for (int k = 0; k <= times; ++k) {
        solids.set_time(end * k / times);
        Index<D> at{};
        for (int c = 0; c < (D == 2 ? places * places : places * places * places); ++c) {
            Vec<D> x = fluid.domain.lo;
            for (int a = 0; a < D; ++a) x[a] += step[a] * (at[a] + 0.5);
            if (solids.distance(x) < norm(step)) fastest = std::max(fastest, norm(solids.velocity(x)));
            for (int a = 0; a < D && ++at[a] == places; ++a) at[a] = 0;
        }
    }
    solids.set_time(0);
    return fastest;
}

}  // namespace

template <int D>
real fastest_flow(const scene::Scene& scene, Fluid<D>& fluid) {
    real squared = 0, fall = 0;
    const auto* field = scene.effect("central_force");
    for (int i = 0; i < fluid.count(); ++i) {
        const Vec<D> x = fluid.position(i), u = fluid.velocity(i);
        squared = std::max(squared, dot(u, u));
        fall = std::max(fall, depth_below(fluid, x));
        if (!field) continue;
        const Vec<D> r = field->number("omega") * (x - field->template vec<D>("centre"));
        squared = std::max(squared, dot(r, r));
    }
    if (fluid.shared)
        for (const auto& rank : of_ranks(std::array{squared, fall})) squared = std::max(squared, rank[0]), fall = std::max(fall, rank[1]);
    if (fluid.domain.bodies)
        for (const auto& body : fluid.domain.bodies->all()) fall = std::max(fall, depth_below(fluid, body.at));
    for (const auto& emitter : scene.root().tables("emitters")) {
        const Vec<D> u = emitter.has("velocity") ? emitter.template vec<D>("velocity") : Vec<D>{};
        squared = std::max(squared, dot(u, u));
        Vec<D> top;
        for (int a = 0; a < D; ++a) top[a] = fluid.gravity[a] > 0 ? fluid.domain.lo[a] : fluid.domain.hi[a];
        fall = std::max(fall, depth_below(fluid, top));
    }
    real fastest = std::max(std::sqrt(squared), fastest_solid(fluid, scene.number("time.end")));
    if (fluid.domain.bodies) fastest = std::max(fastest, fluid.domain.bodies->max_rate(1));
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) fastest = std::max(fastest, norm(fluid.domain.sides.side(a, end).velocity));
    return std::sqrt(fastest * fastest + 2 * fall);
}

template real fastest_flow(const scene::Scene&, Fluid<2>&);
template real fastest_flow(const scene::Scene&, Fluid<3>&);

}  // namespace weir::particles
