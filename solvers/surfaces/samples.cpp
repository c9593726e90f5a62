#include "surfaces/samples.hpp"

#include <algorithm>

namespace weir::surfaces {

namespace {
constexpr int beyond = 2;  // ghost planes on each side: the neighbours of points in the first and last layer
}

void Samples::make_room(const Partition& cut) {
    const int count = n[static_cast<std::size_t>(slowest())];
    if (cut.empty()) {
        depth.resize(nullptr, 0, plane(), count, 0);
        own = held = {0, count}, layers = {0, count - 1};
        return;
    }
    const int rank = communicator().rank();
    const auto planes = std::make_shared<const Slab>(cut, rank, beyond, false);  // of this surface alone: those of the next may differ
    depth = PlaneStore<float>(planes.get(), 0, plane(), count, 0, 0.0F);
    slab = planes;
    layers = layers_of(cut, rank), own = {cut.begin(rank), cut.end(rank, count)};
    held = {std::max(0, own.begin - beyond), std::min(count, own.end + beyond)};
}

void Samples::exchange(const Partition& cut) {
    if (cut.empty()) return;
    communicator().refresh(cut, {depth.data(), plane() * sizeof(float), n[static_cast<std::size_t>(slowest())], 0, depth.held()}, beyond,
                           false);
}

Samples::Between Samples::between(std::size_t axis, real x) const {
    const real index = std::clamp((x - first[axis]) / spacing[axis], 0.0, real(n[axis] - 1));
    const std::size_t low = std::min(static_cast<std::size_t>(index), static_cast<std::size_t>(std::max(0, n[axis] - 2)));
    return {low, index - real(low)};
}

int Samples::layer_of(const Vec<3>& x) const { return static_cast<int>(between(static_cast<std::size_t>(slowest()), x[slowest()]).low); }

bool Samples::is_near(const Vec<3>& x) const {
    constexpr real by = 0.1;
    const int a = slowest();
    const real index = (x[a] - first[a]) / spacing[static_cast<std::size_t>(a)];
    return (layers.begin == 0 || index >= layers.begin - by) &&
           (layers.end + 1 >= n[static_cast<std::size_t>(a)] || index <= layers.end + by);
}

real Samples::at(const Vec<3>& x) const {
    std::array<std::size_t, 3> low{}, step{};
    std::array<real, 3> part{};
    for (std::size_t a = 0; a < 3; ++a) {
        const Between here = between(a, x[a]);
        low[a] = here.low, part[a] = here.part, step[a] = n[a] > 1 ? 1 : 0;
    }
    const auto wide = static_cast<std::size_t>(n[0]), high = static_cast<std::size_t>(n[1]);
    const float* f = depth.data() + low[0] + wide * (low[1] + high * low[2]);
    const std::size_t dx = step[0], dy = step[1] * wide, dz = step[2] * wide * high;
    const auto along = [&](std::size_t from) { return (1 - part[0]) * real(f[from]) + part[0] * real(f[from + dx]); };
    const auto over = [&](std::size_t from) { return (1 - part[1]) * along(from) + part[1] * along(from + dy); };
    return (1 - part[2]) * over(0) + part[2] * over(dz);
}

}  // namespace weir::surfaces
