// Transfer between the lattice and the unknowns of TallPressure: moments over rows, and interpolation back to every row.
// Adjacent columns of a line are processed together while they have equal runs and elements.
#include "tallcell/pressure.hpp"

#include <algorithm>

namespace weir::tallcell {

/// Walks up the runs along horizontal axis h of a block's columns. Calls together(first, run, indices) while all columns with a face, from
/// `first` on, have the same run; indices[i] is that of column i. Then calls one(column, index) for the others.
template <int D>
template <class Together, class One>
void TallPressure<D>::for_each_run(int h, const Block& block, Together&& together, One&& one) const {
    const auto& runs = runs_[at(h)];
    std::array<int, block_columns> place{}, end{};
    for (int i = 0; i < block.count; ++i)
        place[at(i)] = run_start_[at(h)][at(block.column + i)], end[at(i)] = run_start_[at(h)][at(block.column + i) + 1];
    const int first = layout_.lower(block.column, h) < 0 ? 1 : 0;
    const auto alike = [&] {
        for (int i = first; i < block.count; ++i)
            if (place[at(i)] == end[at(i)] || runs[at(place[at(i)])].row != runs[at(place[at(first)])].row ||
                runs[at(place[at(i)])].count != runs[at(place[at(first)])].count)
                return false;
        return first < block.count;
    };
    while (alike()) {
        together(first, runs[at(place[at(first)])], place);
        for (int i = first; i < block.count; ++i) ++place[at(i)];
    }
    for (int i = 0; i < block.count; ++i)
        for (; place[at(i)] < end[at(i)]; ++place[at(i)]) one(block.column + i, place[at(i)]);
}

/// The same for elements longer than one cell: together(row, length, indices), one(column, knot).
template <int D>
template <class Together, class One>
void TallPressure<D>::for_each_element(const Block& block, Together&& together, One&& one) const {
    std::array<int, block_columns> knot{}, end{};
    for (int i = 0; i < block.count; ++i)
        knot[at(i)] = knots_.start[at(block.column + i)], end[at(i)] = knots_.start[at(block.column + i) + 1];
    const auto alike = [&] {
        for (int i = 0; i < block.count; ++i)
            if (knot[at(i)] == end[at(i)] || knots_.length[at(knot[at(i)])] < 2 || knots_.row[at(knot[at(i)])] != knots_.row[at(knot[0])] ||
                knots_.length[at(knot[at(i)])] != knots_.length[at(knot[0])])
                return false;
        return true;
    };
    while (alike()) {
        together(knots_.row[at(knot[0])], knots_.length[at(knot[0])], knot);
        for (int i = 0; i < block.count; ++i) ++knot[at(i)];
    }
    for (int i = 0; i < block.count; ++i)
        for (; knot[at(i)] < end[at(i)]; ++knot[at(i)])
            if (knots_.length[at(knot[at(i)])] > 1) one(block.column + i, knot[at(i)]);
}

template <int D>
void TallPressure<D>::restrict_runs(const MacState<D>& state, int h, const Block& block) {
    const auto& u = state.u[layout_.axes[at(h)]];
    const auto together = [&](int first, const Run& run, const auto& place) {
        const Line face = line(u, block.column);
        std::array<real, at(block_columns)> sum{}, lever{};
        const real c = 0.5 * (run.count - 1), spread = run.count > 1 ? run.spread() : 1;
        for (int j = 0; j < run.count; ++j) {
            const real* values = u.data() + face(run.row + j);
#pragma omp simd
            for (int i = first; i < block.count; ++i) {
                sum[at(i)] += values[i];
                lever[at(i)] += (j - c) * values[i];
            }
        }
        for (int i = first; i < block.count; ++i) {
            const real mean = sum[at(i)] / run.count, slope = lever[at(i)] / (run.count * spread);
            w_[at(h)][at(place[at(i)])] = {mean - slope, mean + slope};
        }
    };
    for_each_run(h, block, together, [&](int column, int i) {
        const Line face = line(u, column);
        const Run& run = runs_[at(h)][at(i)];
        w_[at(h)][at(i)] = moments(run.row, run.count, [&](int row) { return u[face(row)]; });
    });
}

template <int D>
void TallPressure<D>::restrict_velocity(const MacState<D>& state) {
    using Sums = std::array<real, at(block_columns)>;
    std::fill(mean_.begin(), mean_.end(), 0.0);
    largest_of_blocks(layout_.above(), [&](const Block& block) {
        restrict_runs(state, D - 2, block);
        return 0.0;
    });
    largest_of_blocks([&](const Block& block) {
        for (int h = 0; h < D - 1; ++h) restrict_runs(state, h, block);
        const auto& v = state.u[layout_.up];
        const auto together = [&](int row, int length, const auto& knot) {
            const Line face = line(v, block.column);
            Sums sum{};
            for (int j = 1; j <= length; ++j) {
                const real* values = v.data() + face(row + j);
#pragma omp simd
                for (int i = 0; i < block.count; ++i) sum[at(i)] += values[i];
            }
            for (int i = 0; i < block.count; ++i) mean_[at(knot[at(i)])] = sum[at(i)] / length;
        };
        for_each_element(block, together, [&](int column, int i) {
            const Line face = line(v, column);
            real sum = 0;
            for (int j = 1; j <= knots_.length[at(i)]; ++j) sum += v[face(knots_.row[at(i)] + j)];
            mean_[at(i)] = sum / knots_.length[at(i)];
        });
        return 0.0;
    });
}

template <int D>
void TallPressure<D>::change_runs(const RunChanges<D>& by, int h, const ColumnRange& columns) {
    parallel_for(columns.begin, columns.end, [&](int c) {
        for (int i = run_start_[at(h)][at(c)]; i < run_start_[at(h)][at(c) + 1]; ++i) {
            const Pair& change = by[at(layout_.axes[at(h)])][at(i)];
            w_[at(h)][at(i)].minus += change.minus, w_[at(h)][at(i)].plus += change.plus;
        }
    });
}

template <int D>
void TallPressure<D>::change_runs(const RunChanges<D>& by) {
    const ColumnRange own = layout_.own();
    for (int h = 0; h < D - 1; ++h) change_runs(by, h, own);
    change_runs(by, D - 2, layout_.above());
    parallel_for(own.begin, own.end, [&](int c) {
        for (int i = knots_.start[at(c)]; i < knots_.start[at(c) + 1]; ++i) {
            const Pair& change = by[at(layout_.up)][at(i)];
            if (knots_.length[at(i)] > 1) mean_[at(i)] += 0.5 * (change.minus + change.plus);
        }
    });
}

template <int D>
void TallPressure<D>::spread(MacState<D>& state, real dt) {
    fastest_run_ = 0;
    const auto spread_along = [&](int h, const ColumnRange& columns) {
        return largest_of_blocks(columns, [&](const Block& block) { return spread_runs(state, h, block); });
    };
    for (int h = 0; h < D - 1; ++h) fastest_run_ = std::max(fastest_run_, spread_along(h, layout_.own()));
    fastest_run_ = std::max(fastest_run_, spread_along(D - 2, layout_.above()));
    const real vertical = largest_of_blocks([&](const Block& block) { return rebuild(state, block); });
    fastest_run_ = largest_of_ranks(frame_.own(), std::isnan(vertical) ? vertical : std::max(fastest_run_, vertical));
    fastest_run_below_ = floor_;
    const real scale = state.rho / dt;
    largest_of_blocks([&](const Block& block) {
        spread_pressure(state, block, scale);
        return 0.0;
    });
}

/// Returns the largest |u|/h of the runs.
template <int D>
real TallPressure<D>::spread_runs(MacState<D>& state, int h, const Block& block) const {
    auto& u = state.u[layout_.axes[at(h)]];
    std::array<real, at(block_columns)> mean{}, slope{};
    real fastest = 0;
    const auto reaches = [&](const Run& run, real m, real by) {  // a linear function has its maximum at an end
        fastest = std::max(fastest, std::abs(m) + std::abs(by) * 0.5 * (run.count - 1));
    };
    const auto together = [&](int first, const Run& run, const auto& place) {
        const Line face = line(u, block.column);
        const real spread = run.count > 1 ? run.spread() : 1, c = 0.5 * (run.count - 1);
        for (int i = first; i < block.count; ++i) {
            const Pair& w = w_[at(h)][at(place[at(i)])];
            mean[at(i)] = 0.5 * (w.minus + w.plus), slope[at(i)] = 0.5 * (w.plus - w.minus) / spread;
            reaches(run, mean[at(i)], slope[at(i)]);
        }
        for (int j = 0; j < run.count; ++j) {
            real* values = u.data() + face(run.row + j);
#pragma omp simd
            for (int i = first; i < block.count; ++i) values[i] = mean[at(i)] + slope[at(i)] * (j - c);
        }
    };
    for_each_run(h, block, together, [&](int column, int i) {
        const Line face = line(u, column);
        const Run& run = runs_[at(h)][at(i)];
        const Pair& w = w_[at(h)][at(i)];
        reaches(run, 0.5 * (w.minus + w.plus), run.count > 1 ? 0.5 * (w.plus - w.minus) / run.spread() : 0);
        spread_rows(run.row, run.count, w, [&](int row, real value) { u[face(row)] = value; });
    });
    return fastest * frame_.inv_h[layout_.axes[at(h)]];
}

/// v_{j+1} = v_j minus the flux out of cell j through its sides, from the bottom of each element to its top. By the two weak equations of
/// the element, its top cell then has the flux of its own top face, and the mean of v is the stored one. Returns the largest |v|/h.
template <int D>
real TallPressure<D>::rebuild(MacState<D>& state, const Block& block) const {
    const int up = layout_.up;
    auto& v = state.u[up];
    const Sides sides = sides_of(state, block);
    std::array<real, at(block_columns)> above{};
    real fastest = 0;
    const auto together = [&](int row, int length, const auto&) {
        const Line face = line(v, block.column);
        for (int i = 0; i < block.count; ++i) above[at(i)] = v[face(row) + at(i)];
        for (int j = row; j < row + length; ++j) {
            for (int s = 0; s < faces(); ++s) {
                const auto& side = sides.side[at(s)];
                const real *values = side.values + side.line(j), into = frame_.h[up] * side.into;
#pragma omp simd
                for (int i = 0; i < block.count; ++i) above[at(i)] += into * values[i];
            }
            real* to = v.data() + face(j + 1);
#pragma omp simd reduction(max : fastest)
            for (int i = 0; i < block.count; ++i) {
                to[i] = above[at(i)];
                fastest = std::max(fastest, std::abs(above[at(i)]));
            }
        }
        for (int i = 0; i < block.count; ++i)
            if (std::isnan(above[at(i)])) fastest = above[at(i)];
    };
    const auto one = [&](int column, int i) {
        const Line face = line(v, column);
        std::array<Line, 4> sideways{};
        std::array<real, 4> into{};
        for (int f = 0; f < faces(); ++f) {
            const int owner = f % 2 == 1 ? layout_.upper(column, f / 2) : column, axis = layout_.axes[at(f / 2)];
            if (owner < 0 || layout_.lower(owner, f / 2) < 0) continue;
            sideways[at(f)] = line(state.u[axis], owner);
            into[at(f)] = (f % 2 == 1 ? -1 : 1) * frame_.h[up] * frame_.inv_h[axis];
        }
        const int first = knots_.row[at(i)];
        real here = flux(state, up, face(first));
        for (int row = first; row < first + knots_.length[at(i)]; ++row) {
            for (int f = 0; f < faces(); ++f)
                if (into[at(f)] != 0) here += into[at(f)] * flux(state, layout_.axes[at(f / 2)], sideways[at(f)](row));
            v[face(row + 1)] = here;
            if (!(std::abs(here) <= fastest)) fastest = std::abs(here);
        }
    };
    if (sides.side_by_side)
        for_each_element(block, together, one);
    else
        for (int c = block.column; c < block.column + block.count; ++c)
            for (int i = knots_.start[at(c)]; i < knots_.start[at(c) + 1]; ++i)
                if (knots_.length[at(i)] > 1) one(c, i);
    return fastest * frame_.inv_h[up];
}

/// Pressure on the lattice: interpolated in elements, 0 outside the liquid.
template <int D>
void TallPressure<D>::spread_pressure(MacState<D>& state, const Block& block, real scale) const {
    std::array<int, block_columns> row{};  // next row of each column
    const auto fill = [&](int column, int i) {
        const Line cell = line(state.p, column);
        int& done = row[at(column - block.column)];
        for (; done < knots_.row[at(i)]; ++done) state.p[cell(done)] = 0;
        const int length = std::max(1, knots_.length[at(i)]);
        const real here = scale * q_[at(i)], change = length > 1 ? (scale * q_[at(i) + 1] - here) / length : 0;
        for (int j = 0; j < length; ++j) state.p[cell(done++)] = here + j * change;
    };
    std::array<real, at(block_columns)> here{}, change{};
    std::array<int, block_columns> next{};
    for (int i = 0; i < block.count; ++i) next[at(i)] = knots_.start[at(block.column + i)];
    const auto together = [&](int first, int length, const auto& knot) {
        for (int i = 0; i < block.count; ++i) {
            while (next[at(i)] < knot[at(i)]) fill(block.column + i, next[at(i)]++);
            for (const Line cell = line(state.p, block.column + i); row[at(i)] < first; ++row[at(i)]) state.p[cell(row[at(i)])] = 0;
            here[at(i)] = scale * q_[at(knot[at(i)])], change[at(i)] = (scale * q_[at(knot[at(i)]) + 1] - here[at(i)]) / length;
            row[at(i)] = first + length, ++next[at(i)];
        }
        const Line cell = line(state.p, block.column);
        for (int j = 0; j < length; ++j) {
            real* values = state.p.data() + cell(first + j);
#pragma omp simd
            for (int i = 0; i < block.count; ++i) values[i] = here[at(i)] + j * change[at(i)];
        }
    };
    for_each_element(block, together, [](int, int) {});
    for (int i = 0; i < block.count; ++i) {
        const int column = block.column + i;
        while (next[at(i)] < knots_.start[at(column) + 1]) fill(column, next[at(i)]++);
        for (const Line cell = line(state.p, column); row[at(i)] < layout_.rows; ++row[at(i)]) state.p[cell(row[at(i)])] = 0;
    }
}

template void TallPressure<2>::restrict_velocity(const MacState<2>& state);
template void TallPressure<3>::restrict_velocity(const MacState<3>& state);
template void TallPressure<2>::change_runs(const RunChanges<2>& by);
template void TallPressure<3>::change_runs(const RunChanges<3>& by);
template void TallPressure<2>::spread(MacState<2>& state, real dt);
template void TallPressure<3>::spread(MacState<3>& state, real dt);

}  // namespace weir::tallcell
