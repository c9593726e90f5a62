// A p on the finest level, sixteen cells at a time, in double precision where needed.
#pragma once
#include "poisson/geometric/kernels.hpp"

namespace weir::poisson {

struct d16 {
    d8 lo, hi;
};
WEIR_INLINE d16 load_wide(const float* p) { return {load8(p), load8(p + 8)}; }

/// w (count p − Σ p): exact integers times doubles, so that constants are in the null space of closed components to round-off.
template <int D>
struct CountedProduct {
    const std::uint8_t* count;
    double w;
    const float* own;
    std::array<const float*, 2 * D> other;
    WEIR_INLINE d8 half(int m) const {
        d8 total = to_double(count + m) * load8(own + m);
        for (std::size_t k = 0; k < 2 * D; ++k) total -= load8(other[k] + m);
        return w * total;
    }
    WEIR_INLINE d16 operator()(int m) const { return {half(m), half(m + 8)}; }
};

/// Σ w (p_c − p_n) in single precision: differences of neighbours are nearly exact, and the weights are rounded anyway. Replacing the
/// residual removes the error.
template <int D>
struct WeightedProduct {
    const float* own;
    std::array<const float*, 2 * D> w, other;
    WEIR_INLINE d16 operator()(int m) const {
        const f16 centre = load16(own + m);
        f16 total{};
        for (std::size_t k = 0; k < 2 * D; ++k) total += load16(w[k] + m) * (centre - load16(other[k] + m));
        return {low(total), high(total)};
    }
};

/// The same with couplings to p = 0.
template <int D>
struct ZeroCoupledProduct {
    WeightedProduct<D> faces;
    const float* zero;
    WEIR_INLINE d16 operator()(int m) const {
        const d16 total = faces(m);
        const f16 more = load16(zero + m) * load16(faces.own + m);
        return {total.lo + low(more), total.hi + high(more)};
    }
};

/// f(product) in the variant for the finest level. Entries outside fluid are meaningless: they must be multiplied by zero.
template <int D, class F>
WEIR_INLINE void with_product(const Level<D>& level, const Coloured<float>& v, int q, int j, int colour, F&& f) {
    const auto c = static_cast<std::size_t>(colour);
    const std::ptrdiff_t own = level.at.offset(level.at.row(q, j));
    const auto other = neighbours_of<D, const float>(level.at, q, j, colour, v[1 - c]);
    if (level.by_count) return f(CountedProduct<D>{level.count[c] + own, level.plain_weight[0], v[c] + own, other});
    const WeightedProduct<D> faces{v[c] + own, weights_of(level, q, j, colour), other};
    if (level.has_zero) return f(ZeroCoupledProduct<D>{faces, level.packed_zero[c] + own});
    f(faces);
}

}  // namespace weir::poisson
