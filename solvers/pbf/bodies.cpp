#include "pbf/bodies.hpp"

#include <algorithm>

namespace weir::pbf {

using particles::BodiesInLiquid;
using particles::Domain;
using particles::Fluid;

template <int D>
bool push_ahead(BodiesInLiquid<D>& bodies, Fluid<D>& fluid, std::type_identity_t<std::array<std::vector<real>, D>>& x_star, real dt) {
    auto& meetings = bodies.meetings();
    meetings.clear();
    for (int i = 0; i < fluid.count(); ++i) {
        const Vec<D> free = fluid.position(i) + dt * fluid.velocity(i), kept = Fluid<D>::get(x_star, i);
        if (norm(kept - free) > 0) bodies.push_out(fluid.domain, i, free, dt);
    }
    if (meetings.empty()) return false;
    bodies.exchange(fluid.domain, dt, false);
    bodies.move(fluid.domain, dt);
    for (const auto& m : meetings) Fluid<D>::put(x_star, m.particle, Fluid<D>::get(x_star, m.particle) + dt * bodies.back(m));
    return true;
}

template <int D>
void carry(BodiesInLiquid<D>& bodies, Domain<D>& domain, const Multipliers& all, real give, real dt) {
    auto& meetings = bodies.meetings();
    for (auto& m : meetings) {
        if (m.body < 0) continue;
        const real lambda = static_cast<real>(all.four[4 * m.particle + 3]);
        const real sum = all.sum ? static_cast<real>(all.sum[m.particle]) : lambda;
        const float excess = all.density ? all.density[m.particle] - (all.rest ? all.rest[m.particle] : 1.0f) : 0.0f;
        m.given = lambda / dt * m.pull;
        m.stiff = sum < 0 ? stiffness(lambda, static_cast<real>(excess), give) : 0;  // pressure pushes but does not pull
    }
    bodies.exchange(domain, dt, false);
    for (const auto& m : meetings) {
        if (m.body < 0 || m.stiff == 0) continue;
        const auto change = static_cast<float>(dt * m.stiff * bodies.closing(m));
        all.four[4 * m.particle + 3] += change;
        if (all.sum) all.sum[m.particle] += change;
    }
}

template <int D>
bool push_on(BodiesInLiquid<D>& bodies, Domain<D>& domain, const std::vector<int>& near, const float* before, float* four, real dt) {
    auto& meetings = bodies.meetings();
    meetings.clear();
    for (const int k : near) {
        const float* place = before;
        before += D;
        if (std::equal(place, place + D, four + 4 * k)) continue;
        Vec<D> free;
        for (int a = 0; a < D; ++a) free[a] = static_cast<real>(place[a]) + domain.centre()[a];
        bodies.push_out(domain, k, free, dt);
    }
    if (meetings.empty()) return false;
    bodies.exchange(domain, dt, false);
    bodies.move(domain, dt);
    for (const auto& m : meetings) {
        const Vec<D> back = dt * bodies.back(m);
        for (int a = 0; a < D; ++a) four[4 * m.particle + a] += static_cast<float>(back[a]);
    }
    return true;
}

#define WEIR_INSTANTIATE(D)                                                                                                 \
    template bool push_ahead(BodiesInLiquid<D>&, Fluid<D>&, std::type_identity_t<std::array<std::vector<real>, D>>&, real); \
    template void carry(BodiesInLiquid<D>&, Domain<D>&, const Multipliers&, real, real);                                    \
    template bool push_on(BodiesInLiquid<D>&, Domain<D>&, const std::vector<int>&, const float*, float*, real);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::pbf
