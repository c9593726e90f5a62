#include "tallcell/pressure.hpp"

#include "core/scratch.hpp"

#include <algorithm>
#include <limits>

namespace weir::tallcell {

using poisson::Cell;

template <int D>
TallPressure<D>::TallPressure(const Frame<D>& frame, int up, const poisson::Options& options)
    : frame_(frame), options_(options), solver_(options), largest_cut_(1 + frame.h_max() / frame.h_min() / thinnest) {
    std::array<bool, D> periodic{};
    for (int a = 0; a < D; ++a) periodic[at(a)] = frame.periodic(a);
    layout_ = Layout<D>(frame.cells, up, periodic);
    A_.n = layout_.n;
    A_.periodic = layout_.periodic;
    nothing_to_do_.converged = true;
}

template <int D>
void TallPressure<D>::set_surface(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, const Shape& shape, MacState<D>& state) {
    const std::uint8_t* layer = surface.layer().data();
    const auto stride = static_cast<std::size_t>(state.cells.stride(layout_.up));
    const auto vertical = at(layout_.up);
    const auto deep = [&](std::size_t cell) {
        if (layer[cell] != 0) return false;
        if (!state.solid.any()) return true;
        // a cell's face, except on the upper sides, has the cell's index on a larger grid
        const Index<D> I = frame_.index_of(cell);
        const auto& open = state.solid.open[vertical];
        return open(I) == 1 && open(I + e<D>(layout_.up)) == 1;
    };
    static_cast<void>(stride);
    set_surface(surface.phi, closed, state, [&](const auto& layout, const auto& cells, Knots& knots) {
        place_knots(layout, cells, shape.division, shape.depth, deep, knots);
    });
}

template <int D>
void TallPressure<D>::find_liquid(const Grid<real, D>& phi, const Grid<std::uint8_t, D>& closed, MacState<D>& state) const {
    const real thin = -thinnest * frame_.h_min();
    const std::vector<char> near = planes_near(frame_.own().slab, frame_.cells[D - 1], 1, frame_.periodic(D - 1));
    for_each_line(replicated<D>(frame_.cells), [&](const Index<D>& first, std::size_t from) {
        if (!near.empty() && near[at(first[D - 1])] == 0) return;
        for (std::size_t i = from; i < from + at(frame_.cells[0]); ++i)
            state.cells[i] = !closed.empty() && closed[i] ? Cell::solid : phi[i] < thin ? Cell::fluid : Cell::air;
    });
}

template <int D>
void TallPressure<D>::finish_surface(const Grid<real, D>& phi, const MacState<D>& state) {
    elements_end_ = 0;
    refill_scratch(row_index_, at(layout_.rows), -1);
    for (const int row : knots_.row) row_index_[at(row)] = 0;
    for (std::size_t i = 0; i < knots_.row.size(); ++i)
        if (knots_.length[i] > 1) elements_end_ = std::max(elements_end_, knots_.row[i] + knots_.length[i] + 1);
    find_runs(state);
    agree_on_rows();
    fastest_run_ = 0, fastest_run_below_ = 0;
    assemble(phi, state);
    if (A_.rows > 0) solver_.setup(A_);
    for (auto* list : {&b_, &q_, &mean_}) resize_scratch(*list, at(knots_.count()));
}

/// In parallel, combines over all columns: the shared rows, the row above all elements, and the row below which all faces are in runs.
template <int D>
void TallPressure<D>::agree_on_rows() {
    if (!frame_.own().distributed()) return;
    const std::size_t rows = row_index_.size(), count = rows + 2, ranks = static_cast<std::size_t>(communicator().ranks());
    resize_scratch(rows_of_ranks_, count * ranks);
    const auto own = rows_of_ranks_.begin() + static_cast<std::ptrdiff_t>(count * static_cast<std::size_t>(communicator().rank()));
    std::copy(row_index_.begin(), row_index_.end(), own);
    own[layout_.rows] = elements_end_, own[layout_.rows + 1] = -floor_;
    std::vector<std::size_t> begins;
    for (std::size_t r = 0; r <= ranks; ++r) begins.push_back(r * count);
    communicator().gather_parts(rows_of_ranks_.data(), sizeof(int), begins);
    for (std::size_t r = 0; r < ranks; ++r) {
        const int* of_rank = rows_of_ranks_.data() + r * count;
        for (std::size_t row = 0; row < rows; ++row) row_index_[row] = std::max(row_index_[row], of_rank[row]);
        elements_end_ = std::max(elements_end_, of_rank[rows]), floor_ = std::min(floor_, -of_rank[rows + 1]);
    }
}

template <int D>
void TallPressure<D>::find_runs(const MacState<D>& state) {
    const ColumnRange own = layout_.own(), above = layout_.above();
    const auto done = [&](int line) {
        const int c = line * layout_.n[0];
        return (c >= own.begin && c < own.end) || (c >= above.begin && c < above.end);
    };
    for (int h = 0; h < D - 1; ++h) {
        auto& starts = run_start_[at(h)];
        const auto nothing = [](std::size_t, int, const Row&, const Row&) {};
        const auto count = [&](int c) {
            int found = 0;
            visit(state, h, c, nothing, [&](const Run&) { ++found; });
            return found;
        };
        resize_scratch(runs_[at(h)], at(find_starts(layout_, done, count, starts)));
        resize_scratch(w_[at(h)], runs_[at(h)].size());
        parallel_for(0, layout_.columns(), [&](int c) {
            if (!done(c / layout_.n[0])) return;
            int i = starts[at(c)];
            visit(state, h, c, nothing, [&](const Run& run) { runs_[at(h)][at(i++)] = run; });
        });
    }
    floor_ =
        -static_cast<int>(parallel_max(own.end - own.begin, [&](int i) { return static_cast<real>(-covered_from_below(own.begin + i)); }));
}

/// The row up to which a column's faces on its lower sides, and its own, are in runs. Walls have a prescribed velocity.
template <int D>
int TallPressure<D>::covered_from_below(int column) const {
    int covered = layout_.rows;
    for (int h = 0; h < D - 1; ++h) {
        if (layout_.lower(column, h) < 0) continue;
        int row = 0;
        for (int i = run_start_[at(h)][at(column)]; i < run_start_[at(h)][at(column) + 1] && runs_[at(h)][at(i)].row == row; ++i)
            row += runs_[at(h)][at(i)].count;
        covered = std::min(covered, row);
    }
    int row = 0;  // the face on the floor belongs to the column
    for (int i = knots_.start[at(column)]; i < knots_.start[at(column) + 1] && knots_.row[at(i)] == row && knots_.length[at(i)] > 1; ++i)
        row += knots_.length[at(i)];
    return std::min(covered, row);
}

template <int D>
const poisson::Report& TallPressure<D>::project(const Grid<real, D>& phi, MacState<D>& state, real dt, bool pockets) {
    if (A_.rows == 0) return nothing_to_do_;
    weak_divergence(state, b_);
    pockets_.clear();
    if (pockets) pockets_.find(A_, knots_);
    pockets_.make_compatible(b_);
    const real scale = dt / state.rho;
    const ColumnRange own = layout_.own();
    parallel_for(own.begin, own.end, [&](int c) {  // the last pressure is the initial guess
        const Line cell = line(state.p, c);
        for (int i = knots_.start[at(c)]; i < knots_.start[at(c) + 1]; ++i) q_[at(i)] = scale * state.p[cell(knots_.row[at(i)])];
    });
    const poisson::Report& report = solver_.solve(A_, knots_, b_, q_);
    pockets_.remove_means(q_);
    for (int h = 0; h < D - 1; ++h) project_faces(phi, state, h, own);
    project_faces(phi, state, D - 2, layout_.above());
    project_vertical(phi, state);
    return report;
}

/// u −= ∇q on the faces along horizontal axis h, on the lower side of columns.
template <int D>
void TallPressure<D>::project_faces(const Grid<real, D>& phi, MacState<D>& state, int h, const ColumnRange& columns) {
    const int axis = layout_.axes[at(h)];
    const real inv_h = frame_.inv_h[axis];
    auto& u = state.u[axis];
    parallel_for(columns.begin, columns.end, [&](int c) {
        const int lower = layout_.lower(c, h);
        if (lower < 0) return;
        const Line below = line(state.cells, lower), above = line(state.cells, c);
        int next = run_start_[at(h)][at(c)];
        visit(
            state, h, c,
            [&](std::size_t face, int row, const Row& l, const Row& r) {
                if (open(state, axis, face) == 0) return;
                real steep = 1;
                if (!l.wet || !r.wet) {
                    const std::size_t here = (l.wet ? below : above)(row), there = (l.wet ? above : below)(row);
                    if (state.cells[there] != Cell::air) return;
                    steep = cut(phi, here, there);
                }
                u[face] -= inv_h * steep * (pressure_at(r) - pressure_at(l));
            },
            [&](const Run& run) {
                Pair& w = w_[at(h)][at(next++)];
                const auto gradient = [&](real y) { return inv_h * (pressure_at(run.upper, y) - pressure_at(run.lower, y)); };
                w.minus -= gradient(run.middle() - run.spread());
                w.plus -= gradient(run.middle() + run.spread());
            });
    });
}

template <int D>
void TallPressure<D>::project_vertical(const Grid<real, D>& phi, MacState<D>& state) {
    const Knots& knots = knots_;
    const int up = layout_.up;
    auto& v = state.u[up];
    const ColumnRange own = layout_.own();
    parallel_for(own.begin, own.end, [&](int c) {
        const Line cell = line(state.cells, c), face = line(v, c);
        for (int i = knots.start[at(c)]; i < knots.start[at(c) + 1]; ++i) {
            const int row = knots.row[at(i)], length = knots.length[at(i)];
            const real q = q_[at(i)], inv_h = frame_.inv_h[up];
            if (row > 0 && (i == knots.start[at(c)] || knots.length[at(i) - 1] == 0) && state.cells[cell(row - 1)] == Cell::air &&
                open(state, up, face(row)) > 0)
                v[face(row)] -= inv_h * cut(phi, cell(row), cell(row - 1)) * q;
            if (length > 1) {
                mean_[at(i)] -= inv_h * (q_[at(i) + 1] - q) / length;
            } else if (length == 1) {
                if (open(state, up, face(row + 1)) > 0) v[face(row + 1)] -= inv_h * (q_[at(i) + 1] - q);
            } else if (row + 1 < layout_.rows) {
                if (state.cells[cell(row + 1)] == Cell::air && open(state, up, face(row + 1)) > 0)
                    v[face(row + 1)] += inv_h * cut(phi, cell(row), cell(row + 1)) * q;
            } else if (state.sides.open(up, 1)) {
                v[face(row + 1)] += 2 * inv_h * q;
            }
        }
    });
}

template <int D>
real TallPressure<D>::energy(const Grid<real, D>& phi, const MacState<D>& state) const {
    const Knots& knots = knots_;
    return exact_sum(layout_.columns(), [&](int c) {
        real sum = 0;
        for (int h = 0; h < D - 1; ++h) {
            const int axis = layout_.axes[at(h)], lower = layout_.lower(c, h);
            if (lower < 0) continue;
            const Line below = line(state.cells, lower), above = line(state.cells, c);
            int next = run_start_[at(h)][at(c)];
            visit(
                state, h, c,
                [&](std::size_t face, int row, const Row& l, const Row& r) {
                    real mass = open(state, axis, face);
                    if (!l.wet || !r.wet) {
                        const std::size_t here = (l.wet ? below : above)(row), there = (l.wet ? above : below)(row);
                        mass *= state.cells[there] == Cell::air ? 1 / cut(phi, here, there) : 0;
                    }
                    sum += mass * state.u[axis][face] * state.u[axis][face];
                },
                [&](const Run& run) {
                    const Pair& w = w_[at(h)][at(next++)];
                    sum += 0.5 * run.count * (w.minus * w.minus + w.plus * w.plus);
                });
        }
        const int up = layout_.up;
        const Line cell = line(state.cells, c), face = line(state.u[up], c);
        for (int i = knots.start[at(c)]; i < knots.start[at(c) + 1]; ++i) {
            const int row = knots.row[at(i)], length = knots.length[at(i)];
            const auto square = [&](int crossed) { return state.u[up][face(crossed)] * state.u[up][face(crossed)]; };
            if (row > 0 && (i == knots.start[at(c)] || knots.length[at(i) - 1] == 0) && state.cells[cell(row - 1)] == Cell::air)
                sum += open(state, up, face(row)) / cut(phi, cell(row), cell(row - 1)) * square(row);
            if (length > 1)
                sum += length * mean_[at(i)] * mean_[at(i)];
            else if (length == 1)
                sum += open(state, up, face(row + 1)) * square(row + 1);
            else if (row + 1 < layout_.rows && state.cells[cell(row + 1)] == Cell::air)
                sum += open(state, up, face(row + 1)) / cut(phi, cell(row), cell(row + 1)) * square(row + 1);
        }
        return sum;
    });
}

template <int D>
typename TallPressure<D>::RunsUp TallPressure<D>::runs_up(int a, int column) const {
    RunsUp runs;
    if (a == layout_.up) {
        runs.knots_ = &knots_;
        runs.k_ = knots_.start[at(column)] - 1, runs.end_ = knots_.start[at(column) + 1];
        runs.advance();
        return runs;
    }
    const int h = layout_.axes[0] == a ? 0 : 1;
    runs.runs_ = &runs_[at(h)];
    runs.k_ = run_start_[at(h)][at(column)], runs.end_ = run_start_[at(h)][at(column) + 1];
    runs.faces_ = layout_.lower(column, h) >= 0;
    return runs;
}

template <int D>
void TallPressure<D>::write_heights(Grid<real, D>& to) const {
    const Knots& knots = knots_;
    const ColumnRange own = layout_.own();
    parallel_for(own.begin, own.end, [&](int c) {
        const Line cell = line(to, c);
        int row = 0;
        for (int i = knots.start[at(c)]; i < knots.start[at(c) + 1]; ++i) {
            for (; row < knots.row[at(i)]; ++row) to[cell(row)] = 0;
            const int length = std::max(1, knots.length[at(i)]);
            for (int j = 0; j < length; ++j) to[cell(row++)] = length * frame_.h[layout_.up];
        }
        for (; row < layout_.rows; ++row) to[cell(row)] = 0;
    });
}

template <int D>
std::int64_t TallPressure<D>::unknowns() const {
    const ColumnRange own = layout_.own();
    return sum_of_ranks(frame_.own(), knots_.start[at(own.end)] - knots_.start[at(own.begin)]);
}

template <int D>
std::size_t TallPressure<D>::samples() const {
    return 2 * (w_[0].size() + w_[1].size());
}

template <int D>
std::size_t TallPressure<D>::bytes() const {
    std::size_t total = knots_.bytes() + A_.bytes() + (row_index_.capacity() + rows_of_ranks_.capacity()) * sizeof(int) + solver_.bytes() +
                        pockets_.bytes() + (mean_.capacity() + b_.capacity() + q_.capacity()) * sizeof(real);
    for (std::size_t h = 0; h < 2; ++h)
        total += run_start_[h].bytes() + runs_[h].capacity() * sizeof(Run) + w_[h].capacity() * sizeof(Pair);
    return total;
}

template class TallPressure<2>;
template class TallPressure<3>;

}  // namespace weir::tallcell
