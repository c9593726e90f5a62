#include "surface/leapfrog.hpp"

#include "core/plane_checkpoint.hpp"

#include <algorithm>
#include <string>

namespace weir::surface {

/// Of the step: a force that acts for less, or for more, would make a pressure of motion alone too large, or too small, by as much. What is
/// missing then, acts in the steps after.
constexpr real least_kick = 0.5, most_kick = 1.5;

template <int D>
Leapfrog<D>::Leapfrog(const MacVelocity<D>& u, bool whole) : rate_(u.cells, u.h, u.origin), whole_(whole) {}

template <int D>
void Leapfrog<D>::add(MacVelocity<D>& u, real time) const {
    for (int a = 0; a < D; ++a)
        for_each_line(u[a].extent(), [&](const Index<D>&, std::size_t at) {
            real* to = u[a].data() + at;
            const real* rate = rate_[a].data() + at;
            const int count = u[a].extent()[0];
#pragma omp simd
            for (int i = 0; i < count; ++i) to[i] += time * rate[i];
        });
}

template <int D>
real Leapfrog<D>::kick(real dt, bool on_grid) {
    if (whole_ || (on_grid && any_)) ahead_ = 0.5 * dt;
    const real kick = std::clamp(1.5 * dt - ahead_, least_kick * dt, most_kick * dt);
    ahead_ += kick - dt;
    any_ = true;
    return kick;
}

template <int D>
void Leapfrog<D>::keep(const MacVelocity<D>& u, const FaceMarks<D>& known) {
    for (int a = 0; a < D; ++a)
        for_each_line(u[a].extent(), [&](const Index<D>&, std::size_t at) {
            const real* from = u[a].data() + at;
            const std::uint8_t* mark = known[static_cast<std::size_t>(a)].data() + at;
            real* to = rate_[a].data() + at;
            const int count = u[a].extent()[0];
#pragma omp simd
            for (int i = 0; i < count; ++i) to[i] = mark[i] != 0 ? from[i] : infinity;
        });
}

template <int D>
void Leapfrog<D>::find_rate(const MacVelocity<D>& u, real dt) {
    const real inv = 1 / dt;
    for (int a = 0; a < D; ++a)
        for_each_line(u[a].extent(), [&](const Index<D>&, std::size_t at) {
            const real* from = u[a].data() + at;
            real* rate = rate_[a].data() + at;
            const int count = u[a].extent()[0];
#pragma omp simd
            for (int i = 0; i < count; ++i) rate[i] = rate[i] < infinity ? (from[i] - rate[i]) * inv : 0;
        });
}

template <int D>
void Leapfrog<D>::retreat(MacVelocity<D>& u, real kick) {
    find_rate(u, kick);
    add(u, -ahead_);
}

template <int D>
void Leapfrog<D>::save(Checkpoint& to) const {
    for (int a = 0; a < D; ++a) put_planes(to, "leapfrog.rate." + std::to_string(a), rate_[a]);
    to.put_value("leapfrog.ahead", std::array<real, 2>{ahead_, any_ ? 1.0 : 0.0});
}

template <int D>
void Leapfrog<D>::restore(const Checkpoint& from) {
    if (!from.has("leapfrog.ahead")) return;
    for (int a = 0; a < D; ++a) get_planes(from, "leapfrog.rate." + std::to_string(a), rate_[a]);
    const auto [ahead, any] = from.get_value<std::array<real, 2>>("leapfrog.ahead");
    ahead_ = ahead, any_ = any != 0;
}

template class Leapfrog<2>;
template class Leapfrog<3>;

}  // namespace weir::surface
