// Row kernels: smoothing, residual, products. The shape of a row selects once which of three loop variants is used.
#pragma once
#include "poisson/geometric/level.hpp"

namespace weir::poisson {

/// Σ w u over the neighbours of the entries of a row, with uniform face weights.
template <int D>
struct PlainSum {
    std::array<float, D> w;
    std::array<const float*, 2 * D> u;
    WEIR_INLINE f16 operator()(int m) const {
        f16 total = splat(w[0]) * (load16(u[0] + m) + load16(u[1] + m));
        for (std::size_t a = 1; a < D; ++a) total += splat(w[a]) * (load16(u[2 * a] + m) + load16(u[2 * a + 1] + m));
        return total;
    }
};

/// The same with stored weights.
template <int D>
struct WeightedSum {
    std::array<const float*, 2 * D> w, u;
    WEIR_INLINE f16 operator()(int m) const {
        f16 total = load16(w[0] + m) * load16(u[0] + m);
        for (std::size_t k = 1; k < 2 * D; ++k) total += load16(w[k] + m) * load16(u[k] + m);
        return total;
    }
};

/// 1/diagonal and the diagonal from counts of open faces; 0 and 0 outside fluid.
struct CountedDiagonal {
    const float* table;
    const std::uint8_t* count;
    float weight;
    WEIR_INLINE f16 inverse(int m) const { return look_up(table, count + m); }
    WEIR_INLINE f16 value(int m) const { return splat(weight) * to_float(count + m); }
};

/// From a stored 1/diagonal. Outside fluid the value is huge, and is multiplied by exact zeros only.
struct StoredDiagonal {
    const float* dinv;
    WEIR_INLINE f16 inverse(int m) const { return load16(dinv + m); }
    WEIR_INLINE f16 value(int m) const {
        const f16 d = load16(dinv + m), least = splat(1e-30f);
        return splat(1.0f) / (d > least ? d : least);
    }
};

/// Pointers to the neighbours of the entries of one colour in one row: the other colour's rows, shifted so that entry m is at its
/// neighbours.
template <int D, class T>
WEIR_INLINE std::array<T*, 2 * D> neighbours_of(const Layout<D>& at, int q, int j, int colour, T* other) {
    std::array<T*, 2 * D> u;
    const int s = at.parity(q, j);
    u[0] = other + at.offset(at.row(q, j)) + (colour == 0 ? s - 1 : -s);
    u[1] = u[0] + 1;
    for (int a = 1; a < D; ++a)
        for (int side = 0; side < 2; ++side) u[static_cast<std::size_t>(2 * a + side)] = other + at.offset(at.neighbour(q, j, a, side));
    return u;
}

/// Weights of the same faces. A red cell stores its own; a black one reads those of its red neighbours for the opposite faces.
template <int D>
std::array<const float*, 2 * D> weights_of(const Level<D>& level, int q, int j, int colour) {
    std::array<const float*, 2 * D> w;
    const Layout<D>& at = level.at;
    const std::ptrdiff_t own = at.offset(at.row(q, j));
    const int s = at.parity(q, j);
    for (int a = 0; a < D; ++a)
        for (int side = 0; side < 2; ++side) {
            const auto k = static_cast<std::size_t>(2 * a + side);
            if (colour == 0)
                w[k] = level.weight[k] + own;
            else if (a == 0)
                w[k] = level.weight[k ^ 1] + own + (side - s);
            else {
                const int other = at.neighbour(q, j, a, side);
                w[k] = level.weight[k ^ 1] + at.offset(other >= 0 ? other : at.side_row(q, j, a));
            }
        }
    return w;
}

/// f(sum over neighbours, diagonal) in the variant for the row.
template <int D, class F>
WEIR_INLINE void with_row(const Level<D>& level, int q, int j, int colour, F&& f) {
    const auto c = static_cast<std::size_t>(colour);
    const Layout<D>& at = level.at;
    const int row = at.row(q, j);
    const std::ptrdiff_t own = at.offset(row);
    const auto other = neighbours_of<D, const float>(at, q, j, colour, level.u[1 - c]);
    if (level.by_count)
        return f(PlainSum<D>{level.plain_weight, other},
                 CountedDiagonal{level.inverse.data(), level.count[c] + own, level.plain_weight[0]});
    if (level.plain[static_cast<std::size_t>(row)]) return f(PlainSum<D>{level.plain_weight, other}, StoredDiagonal{level.dinv[c] + own});
    f(WeightedSum<D>{weights_of(level, q, j, colour), other}, StoredDiagonal{level.dinv[c] + own});
}

template <int D>
struct RowSpans {
    const Span *first, *last;
    RowSpans(const Level<D>& level, int row)
        : first(level.spans.data() + level.span_start[static_cast<std::size_t>(row)]),
          last(level.spans.data() + level.span_start[static_cast<std::size_t>(row) + 1]) {}
    const Span* begin() const { return first; }
    const Span* end() const { return last; }
};

/// One Gauss-Seidel half sweep over a plane: u = (r + Σ w u) / diagonal for the cells of a colour.
template <int D>
void relax_plane(Level<D>& level, int q, int colour) {
    const auto c = static_cast<std::size_t>(colour);
    for (int j = 0; j < level.at.rows_in_plane(); ++j) {
        const int row = level.at.row(q, j);
        float* u = level.u[c] + level.at.offset(row);
        const float* r = level.r[c] + level.at.offset(row);
        with_row(level, q, j, colour, [&](const auto neighbours, const auto diagonal) WEIR_INLINED {
            for (const Span& span : RowSpans<D>(level, row))
                for (int m = span.begin; m < span.end; m += lanes) store(u + m, (load16(r + m) + neighbours(m)) * diagonal.inverse(m));
        });
        level.at.wrap(u);
    }
}

/// The first half sweep, from u = 0: u = r / diagonal on red cells.
template <int D>
void start_plane(Level<D>& level, int q) {
    for (int j = 0; j < level.at.rows_in_plane(); ++j) {
        const int row = level.at.row(q, j);
        float* u = level.u[0] + level.at.offset(row);
        const float* r = level.r[0] + level.at.offset(row);
        with_row(level, q, j, 0, [&](const auto&, const auto diagonal) WEIR_INLINED {
            for (const Span& span : RowSpans<D>(level, row))
                for (int m = span.begin; m < span.end; m += lanes) store(u + m, load16(r + m) * diagonal.inverse(m));
        });
        level.at.wrap(u);
    }
}

}  // namespace weir::poisson
