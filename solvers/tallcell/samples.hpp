// The velocity unknowns between columns of knots, and the loop over them. Adjacent columns share rows of faces. Where the pressure of both
// is linear over n ≥ 2 rows, so is its gradient, and two samples represent it, at the Gauss points of the sum over rows:
//   y± = c ± σ,  c the middle row,  σ² = (n² − 1)/12,  mass n/2 each;      u(y) = u₋ (1 − ξ)/2 + u₊ (1 + ξ)/2,  ξ = (y − c)/σ
// Sums over rows of products of two linear functions are exact; for n = 2 the samples are the two faces themselves. Every other row has its
// own face. Inside a tall element of H rows, the mean of the vertical velocity represents H − 1 faces.
#pragma once
#include "tallcell/columns.hpp"

#include <cmath>

namespace weir::tallcell {

/// Rows [row, row + count) of the faces between two columns, over which both columns have a single element: those above knots `lower` and
/// `upper` of the columns on the lower and the upper side.
struct Run {
    int row, count, lower, upper;
    real middle() const { return row + 0.5 * (count - 1); }
    real spread() const { return std::sqrt((static_cast<real>(count) * count - 1) / 12); }
};

/// A velocity linear over rows: its values at the Gauss points.
struct Pair {
    real minus = 0, plus = 0;
};

/// The values at the Gauss points of a linear function over rows, from its sum and its first moment about the middle row.
template <class T>
std::array<T, 2> gauss_values(const Run& run, const T& sum, const T& lever) {
    const T mean = (1.0 / run.count) * sum;
    if (run.count == 1) return {mean, mean};
    const T slope = (1 / (run.count * run.spread())) * lever;
    return {mean - slope, mean + slope};
}

/// add(row, mass) over the quadrature points of a sum over the rows of a run: exact for cubic functions in its interior and any values near
/// its ends. `below` rows at its lower end and `above` at its upper one are single points; the others have Gauss points.
template <class Add>
void for_each_point(const Run& run, int below, int above, Add&& add) {
    const int end = run.row + run.count, low = std::min(run.row + below, end), high = std::max(end - above, low);
    for (int row = run.row; row < low; ++row) add(static_cast<real>(row), 1.0);
    const Run inner{low, high - low, run.lower, run.upper};
    if (inner.count > 1) {
        for (const real y : {inner.middle() - inner.spread(), inner.middle() + inner.spread()}) add(y, 0.5 * inner.count);
    } else if (inner.count == 1) {
        add(static_cast<real>(low), 1.0);
    }
    for (int row = high; row < end; ++row) add(static_cast<real>(row), 1.0);
}

/// The pair with the same sum and first moment as values(row) on rows [first, first + count).
template <class F>
Pair moments(int first, int count, F&& values) {
    real sum = 0, lever = 0;
    const real c = 0.5 * (count - 1);
    for (int i = 0; i < count; ++i) {
        const real u = values(first + i);
        sum += u, lever += (i - c) * u;
    }
    const real mean = sum / count;
    if (count == 1) return {mean, mean};
    const real sigma = std::sqrt((static_cast<real>(count) * count - 1) / 12), slope = lever / (count * sigma);
    return {mean - slope, mean + slope};
}

/// add(row, value) of the linear function through a pair, on every row.
template <class F>
void spread_rows(int first, int count, const Pair& pair, F&& add) {
    const real mean = 0.5 * (pair.minus + pair.plus);
    if (count == 1) return add(first, mean);
    const real sigma = std::sqrt((static_cast<real>(count) * count - 1) / 12), slope = 0.5 * (pair.plus - pair.minus) / sigma;
    const real c = 0.5 * (count - 1);
    for (int i = 0; i < count; ++i) add(first + i, mean + slope * (i - c));
}

/// A row of one column: whether it is liquid, the knot at or below it, and the interpolation weight of the knot above.
struct Row {
    bool wet = false;
    int knot = 0;
    real share = 0;
};

/// The faces between columns `lower` and `upper`, upwards: single(row, Row lower, Row upper) where at least one is liquid, run(Run) where
/// both are tall. `open(row)`: whether a face is free of solids. Rows from `stop` on are excluded; it must lie inside no run.
template <class Open, class Single, class Tall>
void visit_faces(const Knots& knots, int lower, int upper, int stop, Open&& open, Single&& single, Tall&& run) {
    Cursor L(knots, lower), R(knots, upper);
    if (L.empty() && R.empty()) return;
    const int first = L.empty() ? R.first_row() : R.empty() ? L.first_row() : std::min(L.first_row(), R.first_row());
    const int last = L.empty() ? R.last_row() : R.empty() ? L.last_row() : std::max(L.last_row(), R.last_row());
    for (int row = first; row <= std::min(last, stop - 1); ++row) {
        const bool l = L.move_to(row), r = R.move_to(row);
        if (!l && !r) continue;
        if (l && r && L.length() > 1 && R.length() > 1 && open(row)) {
            const int end = std::min(L.next_row(), R.next_row());
            int top = row;
            while (top < end && open(top + 1)) ++top;
            run(Run{row, top - row + 1, L.knot(), R.knot()});
            row = top;
            continue;
        }
        single(row, l ? Row{true, L.knot(), L.share(row)} : Row{}, r ? Row{true, R.knot(), R.share(row)} : Row{});
    }
}

}  // namespace weir::tallcell
