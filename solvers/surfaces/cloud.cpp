#include "surfaces/cloud.hpp"

#include "parallel/ownership.hpp"
#include "surfaces/kernel.hpp"

#include <algorithm>
#include <utility>

namespace weir::surfaces {

namespace {

/// Layers of copies for a flat liquid: a stretched kernel reaches 3.75 spacings, and one moved inwards for lack of neighbours one more.
/// Kernels up to 4 layers away must have all their neighbours within three layers; kernels from layer 5 on then do not reach the slice.
constexpr int layers_beside = 6;
static_assert(layers_beside >= 4 + far_reach - 1 && 5 - farthest_move >= longest * far_reach);

void add_images(std::size_t axis, const Domain& domain, real band, Cloud& cloud) {
    const int count = cloud.count();
    for (int i = 0; i < count; ++i)
        domain.for_images(axis, cloud.x[axis][static_cast<std::size_t>(i)], band, [&](real image) {
            for (std::size_t a = 0; a < 3; ++a) cloud.x[a].push_back(a == axis ? image : cloud.x[a][static_cast<std::size_t>(i)]);
            cloud.source.push_back(cloud.particle(i));
        });
}

void add_layers(Cloud& cloud) {
    const int count = cloud.count();
    for (auto& x : cloud.x) x.reserve(static_cast<std::size_t>((2 * layers_beside + 1) * count));
    cloud.source.reserve(cloud.x[0].capacity());
    for (int layer = -layers_beside; layer <= layers_beside; ++layer)
        for (int i = 0; i < count && layer != 0; ++i) {
            for (std::size_t a = 0; a < 2; ++a) cloud.x[a].push_back(cloud.x[a][static_cast<std::size_t>(i)]);
            cloud.x[2].push_back(layer * cloud.spacing);
            cloud.source.push_back(cloud.particle(i));
        }
}

/// A particle in a message.
struct Carried {
    Vec<3> x{}, v{};
};

}  // namespace

void gather(const Components& position, const Domain& domain, real band, Cloud& cloud) {
    cloud.own = static_cast<int>(position[0].size());
    for (std::size_t a = 0; a < position.size(); ++a) cloud.x[a].assign(position[a].begin(), position[a].end());
    if (domain.flat) cloud.x[2].assign(cloud.x[0].size(), 0);
    cloud.source.clear();
    for (std::size_t a = 0; a < position.size(); ++a) add_images(a, domain, band, cloud);
    if (domain.flat) add_layers(cloud);
}

CloudExtent extent_of(const Cloud& cloud) {
    CloudExtent extent{.box = {}, .least = {}, .most = {}, .count = cloud.count()};
    extent.box = particles::CellSort().box(cloud.coordinates(), cloud.count(), extent.finite);
    for (std::size_t a = 0; a < 3 && cloud.own > 0; ++a) {
        const auto [least, most] = std::minmax_element(cloud.x[a].begin(), cloud.x[a].begin() + cloud.own);
        extent.least[a] = *least, extent.most[a] = *most;
    }
    return extent;
}

CloudExtent extent_of_all(const CloudExtent& own) {
    CloudExtent all;
    bool any = false;
    for (const CloudExtent& one : of_ranks(own)) {
        all.finite = all.finite && one.finite;
        if (one.count == 0) continue;
        const CloudExtent before = any ? all : one;
        for (std::size_t a = 0; a < 3; ++a) {
            all.box.lo[a] = std::min(before.box.lo[a], one.box.lo[a]), all.box.hi[a] = std::max(before.box.hi[a], one.box.hi[a]);
            all.least[a] = std::min(before.least[a], one.least[a]), all.most[a] = std::max(before.most[a], one.most[a]);
        }
        all.count += one.count, any = true;
    }
    return all;
}

Components part_of(const FieldSet& fields, const FieldView& field) {
    Components part;
    const auto rank = static_cast<std::size_t>(communicator().rank()), ranks = static_cast<std::size_t>(communicator().ranks());
    for (const std::span<const real>& all : field.data) {
        const std::size_t begin = all.size() * rank / ranks, end = all.size() * (rank + 1) / ranks;
        part.push_back(fields.particles_in_parts ? all : all.subspan(begin, end - begin));
    }
    return part;
}

ReceivedParticles receive_particles(const Components& position, const Components& velocity, const Domain& domain, std::size_t axis,
                                    real band, const std::function<std::span<const int>(real)>& readers) {
    ListsOfRanks<Carried> lists(static_cast<std::size_t>(communicator().ranks()));
    std::vector<std::size_t> last(lists.size(), position[0].size());  // per rank, the last particle sent to it
    for (std::size_t i = 0; i < position[0].size(); ++i) {
        Carried one;
        for (std::size_t a = 0; a < position.size(); ++a) one.x[a] = position[a][i];
        for (std::size_t a = 0; a < velocity.size(); ++a) one.v[a] = velocity[a][i];
        const auto give = [&](real x) {
            for (const int rank : readers(x)) {
                const auto r = static_cast<std::size_t>(rank);
                if (std::exchange(last[r], i) != i) lists[r].push_back(one);
            }
        };
        give(position[axis][i]);
        domain.for_images(axis, position[axis][i], band, give);
    }
    ReceivedParticles received;
    const ListsOfRanks<Carried> come = exchange_lists(std::move(lists));
    std::size_t count = 0;
    for (const auto& list : come) count += list.size();
    for (std::size_t a = 0; a < position.size(); ++a) received.x[a].reserve(count);
    for (std::size_t a = 0; a < velocity.size(); ++a) received.v[a].reserve(count);
    for (const auto& list : come)
        for (const Carried& one : list) {
            for (std::size_t a = 0; a < position.size(); ++a) received.x[a].push_back(one.x[a]);
            for (std::size_t a = 0; a < velocity.size(); ++a) received.v[a].push_back(one.v[a]);
        }
    return received;
}

}  // namespace weir::surfaces
