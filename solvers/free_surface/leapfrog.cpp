#include "free_surface/leapfrog.hpp"

#include "parallel/plane_checkpoint.hpp"

#include <algorithm>
#include <string>

namespace weir::free_surface {

/// Limits of a kick, relative to the step: a force that acts for a shorter or longer time changes the pressure due to motion alone by that
/// factor. The remaining time is applied in later steps.
constexpr real least_kick = 0.5, most_kick = 1.5;

template <int D>
Leapfrog<D>::Leapfrog(const MacVelocity<D>& u) : rate_(u.cells, u.h, u.origin), at_end_(rate_) {}

/// f(a, first index, count) for every line of faces.
template <int D, class F>
static void for_each_line_of(const MacVelocity<D>& u, F&& f) {
    for (int a = 0; a < D; ++a) for_each_line(u[a].extent(), [&](const Index<D>&, std::size_t at) { f(a, at, u[a].extent()[0]); });
}

template <int D>
void Leapfrog<D>::advance(MacVelocity<D>& u, real dt) const {
    const real time = 0.5 * dt - ahead_;
    if (time == 0) return;
    for_each_line_of(u, [&](int a, std::size_t at, int count) {
        real* to = u[a].data() + at;
        const real* rate = rate_[a].data() + at;
#pragma omp simd
        for (int i = 0; i < count; ++i) to[i] += time * rate[i];
    });
}

template <int D>
real Leapfrog<D>::kick(real dt, bool on_grid) {
    if (on_grid && any_) ahead_ = 0.5 * dt;
    const real kick = std::clamp(1.5 * dt - ahead_, least_kick * dt, most_kick * dt);
    ahead_ += kick - dt;
    any_ = true;
    return kick;
}

template <int D>
real Leapfrog<D>::whole_kick(real dt) {
    any_ = true;
    return dt;
}

template <int D>
void Leapfrog<D>::keep(const MacVelocity<D>& u) {
    for_each_line_of(u, [&](int a, std::size_t at, int count) { std::copy_n(u[a].data() + at, count, rate_[a].data() + at); });
}

template <int D>
void Leapfrog<D>::keep(const MacVelocity<D>& u, const FaceMarks<D>& known) {
    for_each_line_of(u, [&](int a, std::size_t at, int count) {
        const real* from = u[a].data() + at;
        const std::uint8_t* mark = known[static_cast<std::size_t>(a)].data() + at;
        real* to = rate_[a].data() + at;
#pragma omp simd
        for (int i = 0; i < count; ++i) to[i] = mark[i] != 0 ? from[i] : infinity;
    });
}

template <int D>
void Leapfrog<D>::finish(const MacVelocity<D>& u, real kick) {
    const real inv = 1 / kick;
    for_each_line_of(u, [&](int a, std::size_t at, int count) {
        const real* from = u[a].data() + at;
        real* rate = rate_[a].data() + at;
#pragma omp simd
        for (int i = 0; i < count; ++i) rate[i] = rate[i] < infinity ? (from[i] - rate[i]) * inv : 0;
    });
}

template <int D>
const MacVelocity<D>& Leapfrog<D>::at_end(const MacVelocity<D>& u, const Frame<D>& frame) const {
    if (ahead_ == 0) return u;
    for_each_line_of(u, [&](int a, std::size_t at, int count) {
        const real *from = u[a].data() + at, *rate = rate_[a].data() + at;
        real* to = at_end_[a].data() + at;
#pragma omp simd
        for (int i = 0; i < count; ++i) to[i] = from[i] - ahead_ * rate[i];
    });
    refresh_faces(at_end_, frame, 1);
    return at_end_;
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

}  // namespace weir::free_surface
