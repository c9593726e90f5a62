#include "sph/tension.hpp"

namespace weir::sph {

using particles::ListChunk;
using particles::SphPass;

template <int D>
void SurfaceTension<D>::apply(particles::Flow<D>& flow, real dt) {
    auto& pairs = flow.pairs;
    pairs.fit(normal_, 4);
    pairs.fit(flow.change, 4);
    const auto& table = pairs.table().sph[flow.kernel];
    SphPass job{.p = &params_, .walls = &walls_, .count = pairs.size(), .positions = pairs.a()};
    job.solid = solids_.at(pairs, pairs.a());
    job.first = pairs.list().first(), job.rows = pairs.list().rows();
    job.acceleration = normal_.data();
    pairs.list().each_chunk([&](const ListChunk& chunk) { table.normal(job, chunk); });
    pairs.refresh(normal_.data(), false);
    pairs.clear_dummies(normal_);
    job.velocities = normal_.data();
    job.acceleration = flow.change.data();
    pairs.list().each_chunk([&](const ListChunk& chunk) { table.tension(job, chunk); });
    flow.add_change(dt);
}

template class SurfaceTension<2>;
template class SurfaceTension<3>;

}  // namespace weir::sph
