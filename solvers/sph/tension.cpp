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
    pairs.refresh_images(normal_.data(), false);
    for (int k = pairs.size(); k < pairs.size() + pairs.table().lanes; ++k)  // the dummy
        for (int c = 0; c < 4; ++c) normal_[static_cast<std::size_t>(4 * k + c)] = 0;
    job.velocities = normal_.data();
    job.acceleration = flow.change.data();
    pairs.list().each_chunk([&](const ListChunk& chunk) { table.tension(job, chunk); });
    flow.add_change(dt);
}

template class SurfaceTension<2>;
template class SurfaceTension<3>;

}  // namespace weir::sph
