#include "surfaces/prepare.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace weir::surfaces {

namespace {

/// In units of Samples::unit; the neighbouring sample is at most 1 on the other side.
constexpr float nearest_to_zero = 2e-3F;

/// Sets the values so that the sign changes at distance `in` from the inner sample and `out` from the outer one, if the inner one is
/// liquid.
void cross_between(float& inner, float& outer, float in, float out) {
    if (inner <= 0) return;
    const float wanted = inner * out / in;
    if (wanted > 1) inner = in / out;
    outer = -std::min(wanted, 1.0F);
}

}  // namespace

void keep_inside(Samples& samples, const Vec<3>& lo, const Vec<3>& hi) {
    const std::array<std::size_t, 3> step{1, samples.linear(0, 1, 0), samples.linear(0, 0, 1)};
    const auto slowest = static_cast<std::size_t>(samples.slowest());
    const auto held = [&](std::size_t axis) { return axis == slowest ? samples.held : PlaneRange{0, samples.n[axis]}; };
    const auto is_held = [&](std::size_t axis, int i) { return i >= held(axis).begin && i < held(axis).end; };
    for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
        for (const bool upper : {false, true}) {
            const int last = upper ? samples.n[a] - 1 : 0, before = upper ? last - 1 : 1;
            const auto below = [&](int i) {
                const real x = samples.first[a] + samples.spacing[a] * i;
                return static_cast<float>((upper ? hi[a] - x : x - lo[a]) / samples.unit);
            };
            if (below(last) >= 0) continue;  // the lattice ends before the side
            if (!is_held(a, before)) continue;
            const PlaneRange js = held(b), ks = held(c);
            parallel_for(ks.begin, ks.end, [&](int k) {
                for (int j = js.begin; j < js.end; ++j) {
                    float* row = samples.depth.data() + static_cast<std::size_t>(k) * step[c] + static_cast<std::size_t>(j) * step[b];
                    float nowhere = 0;
                    float& outer = is_held(a, last) ? row[static_cast<std::size_t>(last) * step[a]] : nowhere;
                    cross_between(row[static_cast<std::size_t>(before) * step[a]], outer, below(before), -below(last));
                }
            });
        }
    }
}

template <int D>
void keep_out_of(Samples& samples, const geometry::Solids<D>& solids) {
    if (solids.empty()) return;
    for_samples(samples, samples.held, [&](int i, int j, int k) {
        float& f = samples(i, j, k);
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
    for_samples(samples, samples.held, [&](int i, int j, int k) {
        float& f = samples(i, j, k);
        const bool end = i == 0 || j == 0 || i == n[0] - 1 || j == n[1] - 1 || (n[2] > 1 && (k == 0 || k == n[2] - 1));
        if (std::abs(f) < nearest_to_zero) f = f > 0 ? nearest_to_zero : -nearest_to_zero;
        if (end) f = std::min(f, -nearest_to_zero);
    });
}

}  // namespace weir::surfaces
