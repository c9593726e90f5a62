// Transfer between a level and the next coarser one: restriction by sums, prolongation of constants. After a black half sweep only red
// cells have a residual, and a black half sweep reads only red values: so both transfers access red cells only.
#pragma once
#include "poisson/geometric/kernels.hpp"

namespace weir::poisson {

/// A row of floats of the calling thread; grows, never shrinks.
inline float* scratch_row(int width) {
    thread_local std::vector<float> row;
    if (row.size() < static_cast<std::size_t>(width)) row.resize(static_cast<std::size_t>(width));
    return row.data();
}

/// The number of children of a coarse cell along an axis, and the first of them.
template <int D>
struct Children {
    int first, last;
    Children(const Level<D>& fine, int a, int coarse) {
        const bool halved = fine.coarsened[static_cast<std::size_t>(a)];
        first = halved ? 2 * coarse : coarse;
        last = std::min(fine.at.n[a], first + (halved ? 2 : 1));
    }
};

/// t += red residual of a fine row: r + Σ w u − d u, written d ((r + Σ w u)/d − u) so that it vanishes outside fluid.
template <int D>
void add_red_residual(const Level<D>& fine, int q, int j, float* t) {
    const int row = fine.at.row(q, j);
    const float* u = fine.u[0] + fine.at.offset(row);
    const float* r = fine.r[0] + fine.at.offset(row);
    with_row(fine, q, j, 0, [&](const auto neighbours, const auto diagonal) WEIR_INLINED {
        for (const Span& span : RowSpans<D>(fine, row))
            for (int m = span.begin; m < span.end; m += lanes) {
                const f16 next = (load16(r + m) + neighbours(m)) * diagonal.inverse(m);
                store(t + m, load16(t + m) + diagonal.value(m) * (next - load16(u + m)));
            }
    });
}

/// Right-hand side of the coarse plane Q, from its fine planes.
template <int D>
void restrict_plane(const Level<D>& fine, Level<D>& coarse, int Q) {
    const bool halve_x = fine.coarsened[0];
    for (int J = 0; J < coarse.at.rows_in_plane(); ++J) {
        const int row = coarse.at.row(Q, J), S = coarse.at.parity(Q, J);
        const std::ptrdiff_t own = coarse.at.offset(row);
        std::array<float*, 2> r = {coarse.r[0] + own, coarse.r[1] + own};
        float* t = halve_x ? scratch_row(2 * coarse.at.stride + 2 * lanes) : nullptr;
        for (const Span& span : RowSpans<D>(coarse, row)) {
            if (halve_x) std::fill(t + 2 * span.begin, t + 2 * span.end, 0.0f);
            if (!halve_x)
                for (float* x : r) std::fill(x + span.begin, x + span.end, 0.0f);
        }
        const Children<D> planes(fine, D - 1, Q), rows(fine, D == 2 ? 0 : 1, J);
        for (int q = planes.first; q < planes.last; ++q)
            for (int j = D == 2 ? 0 : rows.first; j < (D == 2 ? 1 : rows.last); ++j) {
                const int s = fine.at.parity(q, j);
                add_red_residual(fine, q, j, halve_x ? t : r[static_cast<std::size_t>(s ^ S)]);
            }
        if (!halve_x) continue;
        for (const Span& span : RowSpans<D>(coarse, row))
            for (int m = span.begin; m < span.end; m += lanes) {
                const f16 a = load16(t + 2 * m), b = load16(t + 2 * m + lanes);
                store(r[static_cast<std::size_t>(S)] + m, evens(a, b));
                store(r[static_cast<std::size_t>(1 - S)] + m, odds(a, b));
            }
    }
}

/// u += coarse u on the red fluid cells of a fine plane.
template <int D>
void prolong_plane(Level<D>& fine, const Level<D>& coarse, int q) {
    const int Q = fine.coarsened[D - 1] ? q / 2 : q;
    for (int j = 0; j < fine.at.rows_in_plane(); ++j) {
        const int J = D == 2 ? 0 : fine.coarsened[1] ? j / 2 : j;
        const int row = fine.at.row(q, j), s = fine.at.parity(q, j), S = coarse.at.parity(Q, J);
        float* u = fine.u[0] + fine.at.offset(row);
        const std::ptrdiff_t above = coarse.at.offset(coarse.at.row(Q, J));
        const float *even = coarse.u[static_cast<std::size_t>(S)] + above, *odd = coarse.u[static_cast<std::size_t>(1 - S)] + above;
        const float* same = coarse.u[static_cast<std::size_t>(s ^ S)] + above;
        const bool halve_x = fine.coarsened[0];
        with_row(fine, q, j, 0, [&](const auto&, const auto diagonal) WEIR_INLINED {
            for (const Span& span : RowSpans<D>(fine, row))
                for (int m = span.begin; m < span.end; m += lanes) {
                    const f16 e = halve_x ? zip(load<f8>(even + m / 2), load<f8>(odd + m / 2)) : load16(same + m);
                    const f16 inside = diagonal.inverse(m) != f16{} ? e : f16{};
                    store(u + m, load16(u + m) + inside);
                }
        });
        fine.at.wrap(u);
    }
}

}  // namespace weir::poisson
