// The velocity's unknowns between columns of knots, and the loop over them. Beside one another two columns share rows of faces; where the
// pressure of both is linear over n ≥ 2 rows so is its gradient, and two samples carry it, at the Gauss points of the sum over rows:
//   y± = c ± σ,  c the middle row,  σ² = (n² − 1)/12,  mass n/2 each;      u(y) = u₋ (1 − ξ)/2 + u₊ (1 + ξ)/2,  ξ = (y − c)/σ
// Sums over rows of products of two linear functions are exact; for n = 2 the samples are the two faces themselves. Every other row has
// its own face. Inside a tall element of H rows one mean of the vertical velocity stands for H − 1 faces.
#pragma once
#include "tallcell/columns.hpp"

#include <cmath>

namespace weir::tallcell {

/// Rows [row, row + count) of the faces between two columns, over which each is one element: those above knots `lower` and `upper` of the
/// columns on the lower and the upper side.
struct Run {
    int row, count, lower, upper;
    real middle() const { return row + 0.5 * (count - 1); }
    real spread() const { return std::sqrt((static_cast<real>(count) * count - 1) / 12); }
};

/// A velocity that is linear over rows: its values at the Gauss points.
struct Pair {
    real minus = 0, plus = 0;
};

/// Of the values of a linear function over rows: at the Gauss points, from their sum and their first moment about the middle row.
template <class T>
std::array<T, 2> gauss_values(const Run& run, const T& sum, const T& lever) {
    const T mean = (1.0 / run.count) * sum;
    if (run.count == 1) return {mean, mean};
    const T slope = (1 / (run.count * run.spread())) * lever;
    return {mean - slope, mean + slope};
}

/// add(row, mass) over the points on which a sum over the rows of a run is taken of a function that is of degree 3 at most inside it, and
/// any at its ends: `below` rows at its lower end and `above` at its upper one each for itself, the Gauss points of those between.
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

/// The pair with the same sum, and the same first moment, as values(row) on rows [first, first + count).
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

/// A row of one column: whether it is liquid there, the knot at or below it, and the weight of the knot above.
struct Row {
    bool wet = false;
    int knot = 0;
    real share = 0;
};

/// The faces between columns `lower` and `upper`, upwards: single(row, Row lower, Row upper) where at least one is liquid,
/// run(Run) where both are tall. `open(row)` says whether a face is free of solids.
/// Rows from `stop` on are left out; it lies inside no run.
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
