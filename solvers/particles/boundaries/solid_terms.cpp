#include "particles/boundaries/solid_terms.hpp"

#include <algorithm>
#include <cmath>

namespace weir::particles {

namespace {
#define SCALAR double
#include "particles/kernels/prelude_double.h"
using plain::WallParams;
#include "particles/kernels/pair.inl"
}  // namespace

template <int D>
void SolidTerms<D>::mark(Pairs& pairs) {
    if (domain_.solids.empty()) return;
    const real reach = 1 / walls_.inv_h + 2 * domain_.spacing;  // the support, plus the displacement by the corrections of one step
    flag_.resize(static_cast<std::size_t>(pairs.size()));
    pairs.fit(terms_, 4);
    std::fill(terms_.begin(), terms_.end(), 0.0f);
    pairs.each([&](int k) { flag_[static_cast<std::size_t>(k)] = domain_.solids.distance(world(pairs.a() + 4 * k)) < reach; });
    near_.clear();
    near_.reserve(flag_.size());
    for (int k = pairs.shares().own().begin; k < pairs.shares().own().end; ++k)
        if (flag_[static_cast<std::size_t>(k)]) near_.push_back(k);
}

template <int D>
const float* SolidTerms<D>::at(const Pairs&, const float* positions) {
    if (domain_.solids.empty()) return nullptr;
    parallel_for(0, static_cast<int>(near_.size()), [&](int i) {
        const int k = near_[static_cast<std::size_t>(i)];
        const Vec<D> x = world(positions + 4 * k);
        const real phi = std::max<real>(0, domain_.solids.distance(x));
        float* term = terms_.data() + 4 * k;
        std::fill(term, term + 4, 0.0f);
        if (phi * walls_.inv_h >= 1) return;
        const Vec<D> n = domain_.solids.normal(x, 1e-3 * domain_.spacing);
        const real pull = wall_series(phi, walls_.slope, walls_.inv_h);
        for (int a = 0; a < D; ++a) term[a] = static_cast<float>(-pull * n[a]);
        term[3] = static_cast<float>(wall_series(phi, walls_.fraction, walls_.inv_h));
    });
    return terms_.data();
}

template <int D>
void meet_bodies(const Domain<D>& domain, const plain::WallParams& walls, const std::vector<int>& near, const float* positions,
                 const float* terms, std::vector<Meeting<D>>& to) {
    const std::size_t bodies = domain.first_body();
    to.resize(near.size());
    parallel_for(0, static_cast<int>(near.size()), [&](int i) {
        Meeting<D>& m = to[static_cast<std::size_t>(i)];
        m = {};
        const int k = m.particle = near[static_cast<std::size_t>(i)];
        const float* term = terms + 4 * k;
        if (term[3] == 0) return;
        m.at = world_of(domain, positions + 4 * k);
        const std::size_t solid = domain.solids.nearest(m.at);
        if (solid < bodies) return;
        m.body = static_cast<std::ptrdiff_t>(solid - bodies);
        real part[3] = {0, 0, 0}, lean[3] = {0, 0, 0};
        for (int a = 0; a < D; ++a) {
            const auto x = static_cast<real>(positions[4 * k + a]);
            part[a] = wall_part(x, &walls, a), lean[a] = wall_lean(x, &walls, a);
        }
        const real way[3] = {static_cast<real>(term[0]), static_cast<real>(term[1]), static_cast<real>(term[2])};
        m.open = walls_leave(part, lean, way);
        for (int a = 0; a < D; ++a) m.pull[a] = m.open * static_cast<real>(term[a]);
        m.part = m.open * static_cast<real>(term[3]);
    });
}

template <int D>
void SolidTerms<D>::push_out(const Pairs& pairs, float* positions, BoundaryCorrections& corrections) const {
    if (domain_.solids.empty()) return;
    parallel_for(0, static_cast<int>(near_.size()), [&](int i) {
        const int k = near_[static_cast<std::size_t>(i)];
        const Vec<D> x = world(positions + 4 * k);
        if (domain_.solids.distance(x) >= domain_.margin) return;
        const Vec<D> y = pairs.is_image(k) ? domain_.kept(x) : domain_.kept(x, corrections);
        for (int a = 0; a < D; ++a) positions[4 * k + a] = pairs.local(y[a], a);
    });
}

template void meet_bodies(const Domain<2>&, const plain::WallParams&, const std::vector<int>&, const float*, const float*,
                          std::vector<Meeting<2>>&);
template void meet_bodies(const Domain<3>&, const plain::WallParams&, const std::vector<int>&, const float*, const float*,
                          std::vector<Meeting<3>>&);
template class SolidTerms<2>;
template class SolidTerms<3>;

}  // namespace weir::particles
