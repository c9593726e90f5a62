#include "heightfield/reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace weir::heightfield {

namespace {

/// One column: depth, surface, velocity along x and z.
using Column = std::array<real, 4>;

class Reference {
public:
    Reference(const StageOf& stage, Limiter limiter) : stage_(stage), s_(stage.state), limiter_(limiter) {}

    /// dU/dt of one column: depth, discharges.
    std::array<real, 3> rate(int i, int k) const {
        std::array<real, 3> sum{};
        for (int axis = 0; axis < s_.plane.dim - 1; ++axis) {
            const real d = axis == 0 ? s_.plane.dx : s_.plane.dz;
            const Column low = edge(axis, 0, i, k), high = edge(axis, 1, i, k);
            const auto before = flux(axis, edge(axis, 1, i - (axis == 0), k - (axis == 1)), low, 1);
            const auto behind = flux(axis, high, edge(axis, 0, i + (axis == 0), k + (axis == 1)), 0);
            for (std::size_t c = 0; c < 3; ++c) sum[c] -= (behind[c] - before[c]) / d;
            sum[static_cast<std::size_t>(1 + axis)] -= 0.5 * s_.g * (low[0] + high[0]) * ((high[1] - high[0]) - (low[1] - low[0])) / d;
        }
        return sum;
    }

private:
    Column inside(int i, int k) const {
        const std::size_t c = s_.plane.at(i, k);
        const real h = stage_.from.h[c], over = h > s_.dry ? 1 / h : 0;
        return {h, h + s_.bed[c], stage_.from.qx[c] * over, s_.plane.dim == 3 ? stage_.from.qz[c] * over : 0};
    }
    /// The column at (i, k), which may lie beyond one side.
    Column at(int i, int k) const {
        for (int axis = 0; axis < 2; ++axis) {
            int& n = axis == 0 ? i : k;
            const int count = axis == 0 ? s_.plane.nx : s_.plane.nz;
            if (n >= 0 && n < count) continue;
            const int end = n < 0 ? 0 : 1;
            const Side& side = s_.sides(axis, end);
            const auto velocity = static_cast<std::size_t>(2 + axis), other = static_cast<std::size_t>(3 - axis);
            if (side.kind == SideKind::periodic) {
                n = (n % count + count) % count;
                return inside(i, k);
            }
            const int mirror = std::clamp(end == 0 ? -1 - n : 2 * count - 1 - n, 0, count - 1);
            n = side.kind == SideKind::wall ? mirror : end == 0 ? 0 : count - 1;
            Column c = inside(i, k);
            if (side.kind == SideKind::wall) {
                c[velocity] = -c[velocity];
                return c;
            }
            const real out = end == 0 ? -1 : 1, bed = c[1] - c[0];
            const Beside b = beside(side, {c[0], out * c[velocity], c[other]}, bed, s_.g);
            c[0] = b.h, c[1] = b.h + bed, c[velocity] = out * b.out, c[other] = b.along;
            return c;
        }
        return inside(i, k);
    }
    real slope(real a, real b) const {
        if (limiter_ == Limiter::none || a * b <= 0) return 0;
        const real sign = a > 0 ? 1 : -1;
        if (limiter_ == Limiter::minmod) return sign * std::min(std::abs(a), std::abs(b));
        if (limiter_ == Limiter::mc) return sign * std::min(2 * std::min(std::abs(a), std::abs(b)), 0.5 * std::abs(a + b));
        return 2 * a * b / (a + b);
    }
    /// Values at the lower (0) or upper (1) face of a column along an axis.
    Column edge(int axis, int end, int i, int k) const {
        const Column a = at(i - (axis == 0), k - (axis == 1)), b = at(i, k), c = at(i + (axis == 0), k + (axis == 1));
        Column e;
        for (std::size_t v = 0; v < 4; ++v) e[v] = b[v] + (end == 0 ? -0.5 : 0.5) * slope(b[v] - a[v], c[v] - b[v]);
        return e;
    }
    /// Flux through a face, as seen by the column before it (0) or behind it (1).
    std::array<real, 3> flux(int axis, const Column& L, const Column& R, int seen_by) const {
        const real g = s_.g, bed = std::max(L[1] - L[0], R[1] - R[0]);
        const real hl = std::max(0.0, L[1] - bed), hr = std::max(0.0, R[1] - bed);
        const auto across = static_cast<std::size_t>(2 + axis), along = static_cast<std::size_t>(3 - axis);
        const real ul = L[across], ur = R[across], cl = std::sqrt(g * hl), cr = std::sqrt(g * hr);
        real sl, sr;
        if (hl > 0 && hr > 0) {
            const real u = cl + cr > 0 ? (ul * cl + ur * cr) / (cl + cr) : 0, c = std::sqrt(0.5 * g * (hl + hr));
            sl = std::min(ul - cl, u - c), sr = std::max(ur + cr, u + c);
        } else if (hl > 0) {
            sl = ul - cl, sr = ul + 2 * cl;
        } else {
            sl = ur - 2 * cr, sr = ur + cr;
        }
        sl = std::min(0.0, sl), sr = std::max(0.0, sr);
        real mass = 0, momentum = 0;
        if (sr - sl > 0) {
            mass = (sr * hl * ul - sl * hr * ur + sl * sr * (hr - hl)) / (sr - sl);
            momentum = (sr * (hl * ul * ul + 0.5 * g * hl * hl) - sl * (hr * ur * ur + 0.5 * g * hr * hr) + sl * sr * (hr * ur - hl * ul)) /
                       (sr - sl);
        }
        momentum += seen_by == 0 ? 0.5 * g * (L[0] * L[0] - hl * hl) : 0.5 * g * (R[0] * R[0] - hr * hr);
        const real carried = mass * (mass > 0 ? L[along] : R[along]);
        if (axis == 0) return {mass, momentum, carried};
        return {mass, carried, momentum};
    }

    const StageOf& stage_;
    const State& s_;
    Limiter limiter_;
};

}  // namespace

void reference_stage(const StageOf& stage, Limiter limiter) {
    const State& s = stage.state;
    const Reference reference(stage, limiter);
    for (int k = 0; k < s.plane.nz; ++k)
        for (int i = 0; i < s.plane.nx; ++i) {
            const std::size_t c = s.plane.at(i, k);
            const auto rate = reference.rate(i, k);
            const real was[3] = {stage.from.h[c], stage.from.qx[c], s.plane.dim == 3 ? stage.from.qz[c] : 0};
            real* to[3] = {&stage.to.h[c], &stage.to.qx[c], s.plane.dim == 3 ? &stage.to.qz[c] : nullptr};
            for (std::size_t v = 0; v < 3; ++v) {
                if (!to[v]) continue;
                const real moved = was[v] + stage.dt * rate[v];
                *to[v] = stage.second ? 0.5 * (*to[v] + moved) : moved;
            }
            if (*to[0] <= s.dry) *to[1] = 0;
            if (*to[0] <= s.dry && to[2]) *to[2] = 0;
            *to[0] = std::max(0.0, *to[0]);
        }
}

}  // namespace weir::heightfield
