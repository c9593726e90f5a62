#include "reconstruction/prepare.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace weir::reconstruction {

namespace {

/// In units of Samples::unit; the next sample is at most 1 on the other side.
constexpr float nearest_to_zero = 2e-3F;

template <class F>
void for_samples(Samples& samples, const F& f) {
    parallel_for(0, samples.n[2], [&](int k) {
        for (int j = 0; j < samples.n[1]; ++j)
            for (int i = 0; i < samples.n[0]; ++i) f(i, j, k, samples.depth[samples.linear(i, j, k)]);
    });
}

}  // namespace

real Samples::at(const Vec<3>& x) const {
    std::array<std::size_t, 3> low{}, step{};
    std::array<real, 3> part{};
    for (std::size_t a = 0; a < 3; ++a) {
        const real index = std::clamp((x[a] - first[a]) / spacing[a], 0.0, real(n[a] - 1));
        low[a] = std::min(static_cast<std::size_t>(index), static_cast<std::size_t>(std::max(0, n[a] - 2)));
        part[a] = index - real(low[a]);
        step[a] = n[a] > 1 ? 1 : 0;
    }
    const auto wide = static_cast<std::size_t>(n[0]), high = static_cast<std::size_t>(n[1]);
    const float* f = depth.data() + low[0] + wide * (low[1] + high * low[2]);
    const std::size_t dx = step[0], dy = step[1] * wide, dz = step[2] * wide * high;
    const auto along = [&](std::size_t from) { return (1 - part[0]) * real(f[from]) + part[0] * real(f[from + dx]); };
    const auto over = [&](std::size_t from) { return (1 - part[1]) * along(from) + part[1] * along(from + dy); };
    return (1 - part[2]) * over(0) + part[2] * over(dz);
}

namespace {

/// Makes the value change its sign at distance `in` from the inner sample and `out` from the outer one, if the inner one is in the liquid.
void cross_between(float& inner, float& outer, float in, float out) {
    if (inner <= 0) return;
    const float wanted = inner * out / in;
    if (wanted > 1) inner = in / out;
    outer = -std::min(wanted, 1.0F);
}

}  // namespace

void keep_inside(Samples& samples, const Vec<3>& lo, const Vec<3>& hi) {
    const std::array<std::size_t, 3> step{1, samples.linear(0, 1, 0), samples.linear(0, 0, 1)};
    for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
        for (const bool upper : {false, true}) {
            const int last = upper ? samples.n[a] - 1 : 0, before = upper ? last - 1 : 1;
            const auto below = [&](int i) {
                const real x = samples.first[a] + samples.spacing[a] * i;
                return static_cast<float>((upper ? hi[a] - x : x - lo[a]) / samples.unit);
            };
            if (below(last) >= 0) continue;  // the lattice ends before the side
            parallel_for(0, samples.n[c], [&](int k) {
                for (int j = 0; j < samples.n[b]; ++j) {
                    float* row = samples.depth.data() + static_cast<std::size_t>(k) * step[c] + static_cast<std::size_t>(j) * step[b];
                    cross_between(row[static_cast<std::size_t>(before) * step[a]], row[static_cast<std::size_t>(last) * step[a]],
                                  below(before), -below(last));
                }
            });
        }
    }
}

template <int D>
void keep_out_of(Samples& samples, const geometry::Solids<D>& solids) {
    if (solids.empty()) return;
    for_samples(samples, [&](int i, int j, int k, float& f) {
        if (f <= -1) return;
        const Vec<3> at = samples.position(i, j, k);
        Vec<D> x;
        for (int a = 0; a < D; ++a) x[a] = at[a];
        f = std::min(f, static_cast<float>(std::clamp(solids.distance(x) / samples.unit, -1.0, 1.0)));
    });
}
template void keep_out_of(Samples& samples, const geometry::Solids<2>& solids);
template void keep_out_of(Samples& samples, const geometry::Solids<3>& solids);

void avoid_zero(Samples& samples) {
    const auto& n = samples.n;
    for_samples(samples, [&](int i, int j, int k, float& f) {
        const bool end = i == 0 || j == 0 || i == n[0] - 1 || j == n[1] - 1 || (n[2] > 1 && (k == 0 || k == n[2] - 1));
        if (std::abs(f) < nearest_to_zero) f = f > 0 ? nearest_to_zero : -nearest_to_zero;
        if (end) f = std::min(f, -nearest_to_zero);
    });
}

}  // namespace weir::reconstruction
