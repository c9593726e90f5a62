// One file, because products and sums are contracted here (-ffp-contract=fast): with the trajectories of single points in another file than
// the runs of tall cells, they are no longer inlined there, and results change in their last bits.
#include "tallcell/transport.hpp"

#include "core/scratch.hpp"

#include <algorithm>
#include <limits>

namespace weir::tallcell {

template <int D>
Transport<D>::Transport(const Frame<D>& frame, const MacVelocity<D>& u, bool maccormack, int reach)
    : frame_(frame), maccormack_(maccormack), reach_(reach), before_(u) {
    if (maccormack) predicted_ = u;
}

template <int D>
std::size_t Transport<D>::bytes() const {
    std::size_t total = before_.bytes() + predicted_.bytes();
    for (const auto& list : changes_) total += list.capacity() * sizeof(Pair);
    return total;
}

template <int D>
void Transport<D>::operator()(const TallPressure<D>& mesh, const Grid<real, D>& phi, const geometry::Sides<D>& sides, real dt, real fastest,
                              MacVelocity<D>& u, int beside) {
    up_ = mesh.layout().up, open_above_ = sides.open(up_, 1);
    source_ = &u;
    ends_ = static_cast<int>(std::clamp(std::ceil(fastest * dt), 1.0, 1e6));
    move_runs(mesh, dt);
    // bound of a point's displacement, by a midpoint that may be faster than the start, plus two samples
    kept_from_ = std::max(0, mesh.floor_of_singles() - static_cast<int>(std::min(1e6, 1.5 * fastest * dt)) - 3);
    keep(u, beside);
    source_ = &before_;
    const real h = frame_.h_max();
    if (!maccormack_) return pass<false>(mesh, phi, sides, dt, 2 * h, u);
    pass<false>(mesh, phi, sides, dt, (reach_ + 2) * h, predicted_);
    refresh_faces(predicted_, frame_, beside);
    pass<true>(mesh, phi, sides, dt, 2 * h, u);
}

namespace {

/// A point in cells from the domain's lower corner, its interpolation interval, and whether all samples are inside the domain.
template <int D>
struct Inside {
    std::array<int, D> face, centre;
    std::array<real, D> face_part, centre_part;
    bool all = true;

    Inside(const Frame<D>& frame, const Vec<D>& s) {
        for (int d = 0; d < D; ++d) {
            const auto at = static_cast<std::size_t>(d);
            all = all && s[d] >= 1 && s[d] < frame.cells[d] - 1;
            if (!all) return;  // also where s is no number
            face[at] = static_cast<int>(s[d]);
            face_part[at] = s[d] - face[at];
            centre[at] = static_cast<int>(s[d] - 0.5);
            centre_part[at] = s[d] - 0.5 - centre[at];
        }
    }
    /// The 2^D samples around the point: f(first of a pair along x, weight along x, ...) in the order of sample().
    template <class Combine>
    real along(const Grid<real, D>& u, int a, Combine&& combine) const {
        std::array<real, D> f;
        const real* at = u.data();
        for (int d = 0; d < D; ++d) {
            const auto i = static_cast<std::size_t>(d);
            f[i] = d == a ? face_part[i] : centre_part[i];
            at += (d == a ? face[i] : centre[i]) * u.stride(d);
        }
        const std::ptrdiff_t sy = u.stride(1);
        const auto plane = [&](const real* q) { return combine(combine(q[0], q[1], f[0]), combine(q[sy], q[sy + 1], f[0]), f[1]); };
        if constexpr (D == 2) {
            return plane(at);
        } else {
            return combine(plane(at), plane(at + u.stride(2)), f[2]);
        }
    }
    real value(const Grid<real, D>& u, int a) const {
        return along(u, a, [](real lower, real upper, real f) { return lower + f * (upper - lower); });
    }
    real least(const Grid<real, D>& u, int a) const {
        return along(u, a, [](real lower, real upper, real f) { return f > 0 ? std::min(lower, upper) : lower; });
    }
    real most(const Grid<real, D>& u, int a) const {
        return along(u, a, [](real lower, real upper, real f) { return f > 0 ? std::max(lower, upper) : lower; });
    }
};

}  // namespace

/// As sample() of frame.hpp at any point; fast where all samples around the point are inside the domain.
template <int D>
real Transport<D>::at_point(const Grid<real, D>& u, int a, const Vec<D>& s) const {
    const Inside<D> inside(frame_, s);
    return inside.all ? inside.value(u, a) : sample(u, a, stencil(s));
}

template <int D>
Stencil<D> Transport<D>::stencil(const Vec<D>& s) const {
    Vec<D> x;
    for (int d = 0; d < D; ++d) x[d] = frame_.origin[d] + s[d] * frame_.h[d];
    return Stencil<D>(frame_, frame_.wrap(x));
}

/// The position after dt of a point at s [cells] with the velocity `here` [cells/s]: the midpoint rule.
template <int D>
Vec<D> Transport<D>::moved(const Vec<D>& s, const Vec<D>& here, real dt) const {
    const Vec<D> middle = s + (0.5 * dt) * here;
    const Inside<D> inside(frame_, middle);
    Vec<D> k;
    if (inside.all) {
        for (int b = 0; b < D; ++b) k[b] = inside.value((*source_)[b], b) * frame_.inv_h[b];
    } else {
        const Stencil<D> around = stencil(middle);
        for (int b = 0; b < D; ++b) k[b] = sample((*source_)[b], b, around) * frame_.inv_h[b];
    }
    return s + dt * k;
}

template <int D>
Vec<D> Transport<D>::speed(const Vec<D>& s) const {
    Vec<D> k;
    for (int b = 0; b < D; ++b) k[b] = at_point((*source_)[b], b, s) * frame_.inv_h[b];
    return k;
}

/// The value at the point from which s is reached in dt.
template <int D>
real Transport<D>::departed(int a, const Vec<D>& s, real dt) const {
    return at_point((*source_)[a], a, moved(s, speed(s), -dt));
}

/// û + (u − ũ)/2, û the prediction and ũ its backward advection; clamped to the values around the departure point (Selle et al. 2008,
/// section 4).
template <int D>
real Transport<D>::corrected(int a, const Vec<D>& s, real here, real dt) const {
    const Vec<D> k = speed(s), from = moved(s, k, -dt);
    const real back = at_point(predicted_[a], a, moved(s, k, dt));
    const Inside<D> inside(frame_, from);
    real value, low = infinity, high = -infinity;
    if (inside.all) {
        value = inside.value(before_[a], a), low = inside.least(before_[a], a), high = inside.most(before_[a], a);
    } else {
        const Stencil<D> around = stencil(from);
        for_each_sample(around, a, before_[a].extent(), [&](std::ptrdiff_t i, real weight) {
            if (weight == 0) return;
            const real u = before_[a][static_cast<std::size_t>(i)];
            low = std::min(low, u), high = std::max(high, u);
        });
        value = sample(before_[a], a, around);
    }
    return std::min(std::max(value + 0.5 * (here - back), low), high);  // no clamp: its ends must be numbers
}

/// Changes of all runs of tall cells at their Gauss points. Eight columns adjacent along x are processed together.
template <int D>
void Transport<D>::move_runs(const TallPressure<D>& mesh, real dt) {
    const Layout<D>& layout = mesh.layout();
    for (int a = 0; a < D; ++a) {
        auto& changes = changes_[static_cast<std::size_t>(a)];
        resize_scratch(changes, mesh.run_count(a));
        // this rank's columns; for runs along the last axis the line after them too
        const ColumnRange own = layout.own(), above = a == layout.axes[D - 2] ? layout.above() : ColumnRange{};
        const int own_begin = own.begin / row_lanes, own_blocks = blocks_of(own) - own_begin, above_begin = above.begin / row_lanes;
        parallel_for(0, own_blocks + blocks_of(above) - above_begin, [&](int i_block) {
            const bool is_own = i_block < own_blocks;
            const ColumnRange& range = is_own ? own : above;
            const int block = is_own ? own_begin + i_block : above_begin + i_block - own_blocks;
            const int c0 = std::max(block * row_lanes, range.begin), count = std::min((block + 1) * row_lanes, range.end) - c0;
            std::array<typename TallPressure<D>::RunsUp, row_lanes> runs;
            std::array<Index<D>, row_lanes> foot;
            for (int i = 0; i < count; ++i) {
                const auto l = static_cast<std::size_t>(i);
                runs[l] = mesh.runs_up(a, c0 + i), foot[l] = layout.foot(c0 + i);
            }
            const auto one = [&](std::size_t i) { changes[runs[i].index()] = move_run(a, foot[i], runs[i].run(), dt); };
            Index<D> taken = layout.foot(c0);
            bool together = layout.axes[0] == 0 && count == row_lanes && fits_eight(taken[0]);
            const int shift = inward(taken[0]);
            taken[0] += shift;
            while (together) {
                bool alike = true;
                const auto ahead = [&](std::size_t i) { return runs[i].ahead() && runs[i].any_faces(); };
                std::size_t last = row_lanes - 1;  // a column that is not a wall defines the run
                if (!ahead(last)) break;
                const Run run = runs[last].run();
                for (std::size_t i = 0; i < row_lanes; ++i)
                    alike =
                        alike && (!runs[i].any_faces() || (ahead(i) && runs[i].run().row == run.row && runs[i].run().count == run.count));
                if (!alike) break;
                std::array<Eight, 2> change;
                const bool moved = move_run_of_eight(a, taken, run, dt, change);
                for (std::size_t i = 0; i < row_lanes; ++i) {
                    if (!runs[i].any_faces()) continue;
                    if (moved && inner(foot[i], 0))
                        changes[runs[i].index()] = {change[0][static_cast<int>(i) - shift], change[1][static_cast<int>(i) - shift]};
                    else
                        one(i);
                    runs[i].reaches(run.row + run.count);
                }
            }
            for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
                for (; runs[i].any_faces() && runs[i].ahead(); runs[i].reaches(runs[i].run().row + runs[i].run().count)) one(i);
        });
    }
}

/// Moments over the rows of a run of their changes, by Euler's trace: deep below the surface trajectories are straight within a step. Rows
/// that a trajectory may reach from beyond the run's ends are single points: only they transport the outside into the run. The two Gauss
/// points of the whole run read only its own linear function; with them alone the mean would drift along its slope.
template <int D>
Pair Transport<D>::move_run(int a, Index<D> I, const Run& run, real dt) const {
    I[up_] = run.row;
    Vec<D> s = face_place(a, I);
    const real bottom = s[up_];
    real sum = 0, lever = 0;
    for_each_point(run, run.row == 0 ? 0 : ends_, ends_, [&](real row, real mass) {
        s[up_] = bottom + (row - run.row);
        const Vec<D> k = speed(s);
        const real change = at_point((*source_)[a], a, s - dt * k) - k[a] * frame_.h[a];
        sum += mass * change, lever += mass * (row - run.middle()) * change;
    });
    const auto pair = gauss_values(run, sum, lever);
    return {pair[0], pair[1]};
}

/// The same for eight columns adjacent along x with the same run. Returns false, without any change, where a point comes too close to a
/// side or moves too far.
template <int D>
bool Transport<D>::move_run_of_eight(int a, Index<D> I, const Run& run, real dt, std::array<Eight, 2>& change) const {
    for (int d = 1; d < D; ++d)
        if (d != up_ && !inner(I, d)) return false;
    bool near = true;
    Eight sum{}, lever{};
    for_each_point(run, run.row == 0 ? 0 : ends_, ends_, [&](real row, real mass) {
        Eight by;
        near = near && change_of_eight(a, I, row, dt, by);
        if (!near) return;
        sum += mass * by, lever += mass * (row - run.middle()) * by;
    });
    if (near) change = gauss_values(run, sum, lever);
    return near;
}

/// Changes of eight points at a row between faces, or on one.
template <int D>
bool Transport<D>::change_of_eight(int a, Index<D> I, real row, real dt, Eight& change) const {
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    I[up_] = static_cast<int>(std::lround(row));
    if (!inner(I, up_)) return false;
    Moved<D> d{};
    d[at(up_)] += row - I[up_];
    Moved<D> from = d;
    Eight here{};
    for (int b = 0; b < D; ++b) {
        const auto& u = (*source_)[b];
        const Eight k = sample_near<D>(u.data() + u.linear(I), u.stride(1), u.stride(D - 1), d, a, b);
        if (b == a) here = k;
        from[at(b)] -= dt * frame_.inv_h[b] * k;
        if (!simd::all(magnitude(from[at(b)]) <= 1)) return false;
    }
    const auto& u = (*source_)[a];
    change = sample_near<D>(u.data() + u.linear(I), u.stride(1), u.stride(D - 1), from, a, a) - here;
    return true;
}

/// Eight faces adjacent along x, all at least a cell from the ends of the other axes. Returns false, without any change, where a point
/// moves farther than a cell.
template <int D>
template <bool Correct>
bool Transport<D>::move_eight(int a, const Index<D>& I, real dt, Eight& to) const {
    const auto component = [](int b) { return static_cast<std::size_t>(b); };
    Moved<D> k, half, from;
    auto near = Eight{} == Eight{};
    for (int b = 0; b < D; ++b) {
        const auto& u = (*source_)[b];
        const real* q = u.data() + u.linear(I);
        const std::ptrdiff_t below = u.stride(a), above = u.stride(b);
        const Eight v = b == a ? simd::load<Eight>(q)
                               : 0.25 * ((simd::load<Eight>(q) + simd::load<Eight>(q - below)) +
                                         (simd::load<Eight>(q + above) + simd::load<Eight>(q + above - below)));
        k[component(b)] = frame_.inv_h[b] * dt * v;
        near &= magnitude(k[component(b)]) <= 1;
    }
    if (!simd::all(near)) return false;
    const auto trace = [&](real sign) {
        for (std::size_t b = 0; b < D; ++b) half[b] = 0.5 * sign * k[b];
        for (int b = 0; b < D; ++b) {
            const auto& u = (*source_)[b];
            from[component(b)] =
                sign * dt * frame_.inv_h[b] * sample_near<D>(u.data() + u.linear(I), u.stride(1), u.stride(D - 1), half, a, b);
            near &= magnitude(from[component(b)]) <= 1;
        }
        return simd::all(near);
    };
    if (!trace(-1)) return false;
    const auto& u = (*source_)[a];
    const std::size_t first = u.linear(I);
    const std::ptrdiff_t sy = u.stride(1), sz = u.stride(D - 1);
    if constexpr (!Correct) to = sample_near<D>(u.data() + first, sy, sz, from, a, a);
    if constexpr (Correct) {
        Eight low, high;
        bounds_near<D>(u.data() + first, sy, sz, from, low, high);
        if (!trace(1)) return false;
        const auto& predicted = predicted_[a];  // the result of departed() in the first pass
        const Eight back = sample_near<D>(predicted.data() + first, sy, sz, from, a, a);
        to = smaller(larger(simd::load<Eight>(predicted.data() + first) + 0.5 * (simd::load<Eight>(u.data() + first) - back), low), high);
    }
    return true;
}

/// A column during the upward walk: linear indices of its lowest face and cell, and the present or next run.
template <int D>
struct Transport<D>::ColumnUp {
    typename TallPressure<D>::RunsUp runs;
    Index<D> foot;
    std::size_t face, cell;
    std::ptrdiff_t below;  // offset of the cell on the other side of the face
    int begin = 0, end = 0;
    bool moves = false;

    static constexpr int never = std::numeric_limits<int>::max();
    /// Finds the run at `row` or the next one above it, and returns whether there is one.
    bool next_run(int row) {
        const bool more = runs.reaches(row) || runs.ahead();
        begin = more ? runs.run().row : never;
        end = more ? begin + runs.run().count : never;
        return more;
    }
};

/// The faces of adjacent columns along one axis, from the lowest row upwards.
template <int D>
struct Transport<D>::BlockUp {
    int axis, count, shift;  // shift: of the eight columns that are processed together
    bool beside;             // whether they can be
    Index<D> foot;           // of the first column
    std::size_t face_stride, cell_stride;
    std::array<ColumnUp, row_lanes> columns;

    std::size_t face(const ColumnUp& column, int row) const { return column.face + static_cast<std::size_t>(row) * face_stride; }
};

template <int D>
typename Transport<D>::BlockUp Transport<D>::block_up(const TallPressure<D>& mesh, const Grid<real, D>& phi, int a, int c0, int count,
                                                      const Grid<real, D>& to) const {
    const Layout<D>& layout = mesh.layout();
    const Index<D> foot = layout.foot(c0);
    BlockUp block{a,
                  count,
                  inward(foot[0]),
                  layout.axes[0] == 0 && count == row_lanes && fits_eight(foot[0]),
                  foot,
                  static_cast<std::size_t>(to.stride(up_)),
                  static_cast<std::size_t>(phi.stride(up_)),
                  {}};
    for (int i = 0; i < count; ++i) {
        ColumnUp& column = block.columns[static_cast<std::size_t>(i)];
        column.runs = mesh.runs_up(a, c0 + i);
        column.foot = layout.foot(c0 + i);
        column.face = to.linear(column.foot);
        column.cell = phi.linear(column.foot);
        column.below =
            a == up_ ? -static_cast<std::ptrdiff_t>(block.cell_stride)
                     : static_cast<std::ptrdiff_t>(phi.linear(frame_.near(column.foot, a, -1))) - static_cast<std::ptrdiff_t>(column.cell);
        if (!column.runs.any_faces()) column.end = ColumnUp::never;  // a wall: treated as one run, moved elsewhere
    }
    return block;
}

/// The prediction in the present run of a column.
template <int D>
void Transport<D>::predict_run(const BlockUp& block, const ColumnUp& column, Grid<real, D>& to) const {
    const Run run = column.runs.run();
    spread_rows(run.row, run.count, changes_[static_cast<std::size_t>(block.axis)][column.runs.index()], [&](int row, real by) {
        if (row < kept_from_) return;
        const std::size_t face = block.face(column, row);
        to[face] = before_[block.axis][face] + by;
    });
}

/// Advects the faces of a row of which some move.
template <int D>
template <bool Correct>
void Transport<D>::advect_row(const BlockUp& block, int row, real dt, Grid<real, D>& to) const {
    const int a = block.axis;
    Index<D> I = block.foot;
    I[0] += block.shift, I[up_] = row;
    bool inner = block.beside;
    for (int d = 1; d < D; ++d) inner = inner && this->inner(I, d);
    Eight value;
    const bool together = inner && move_eight<Correct>(a, I, dt, value);
    for (int i = 0; i < block.count; ++i) {
        const ColumnUp& column = block.columns[static_cast<std::size_t>(i)];
        if (!column.moves) continue;
        I = column.foot;
        I[up_] = row;
        real& u = to[block.face(column, row)];
        if (together && this->inner(I, 0))
            u = value[i - block.shift];
        else if constexpr (Correct)
            u = corrected(a, face_place(a, I), before_[a](I), dt);
        else
            u = departed(a, face_place(a, I), dt);
    }
}

/// One pass over all faces from kept_from_ upwards. Faces with φ < near beside them are advected; the others are unchanged. Rows in runs of
/// tall cells take part only in the prediction, which other faces read. Eight columns are processed together, since neighbours are
/// contiguous in memory.
template <int D>
template <bool Correct>
void Transport<D>::pass(const TallPressure<D>& mesh, const Grid<real, D>& phi, const geometry::Sides<D>& sides, real dt, real near,
                        MacVelocity<D>& to) const {
    const Layout<D>& layout = mesh.layout();
    const bool all_faces = &to == &predicted_;  // otherwise unchanged faces keep their values
    const ColumnRange own = layout.own();
    for (int a = 0; a < D; ++a) {
        const int first = std::max(a == up_ ? 1 : 0, kept_from_), last = a == up_ && sides.open(up_, 1) ? layout.rows + 1 : layout.rows;
        parallel_for(own.begin / row_lanes, blocks_of(own), [&](int i_block) {
            const int c0 = std::max(i_block * row_lanes, own.begin), count = std::min((i_block + 1) * row_lanes, own.end) - c0;
            BlockUp block = block_up(mesh, phi, a, c0, count, to[a]);
            for (int i = 0; i < count; ++i) {
                const ColumnUp& column = block.columns[static_cast<std::size_t>(i)];
                for (int row = first; all_faces && column.end == ColumnUp::never && row < layout.rows; ++row)
                    to[a][block.face(column, row)] = before_[a][block.face(column, row)];
            }
            for (int row = first; row < last;) {
                int until = last, moving = 0;
                for (int i = 0; i < count; ++i) {
                    ColumnUp& column = block.columns[static_cast<std::size_t>(i)];
                    if (row >= column.end && column.next_run(row) && all_faces) predict_run(block, column, to[a]);
                    column.moves = row < column.begin;
                    if (!column.moves) {
                        until = std::min(until, column.end);
                        continue;
                    }
                    until = row + 1;
                    const std::size_t cell = column.cell + static_cast<std::size_t>(std::min(row, layout.rows - 1)) * block.cell_stride;
                    const std::size_t below =
                        row == layout.rows ? cell : static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell) + column.below);
                    column.moves = std::min(phi[cell], phi[below]) < near;
                    moving += column.moves;
                    const std::size_t face = block.face(column, row);
                    if (!column.moves && all_faces) to[a][face] = before_[a][face];
                }
                if (moving > 0) advect_row<Correct>(block, row, dt, to[a]);
                row = until;
            }
        });
    }
    if (all_faces) keep_sides(to);
    sync_periodic(to, sides);
}

/// Faces on the sides of the domain that are on no column's lower side.
template <int D>
void Transport<D>::keep_sides(MacVelocity<D>& to) const {
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            if (end == 0 ? a != up_ : a == up_ && open_above_) continue;
            Index<D> lo{};
            Extent<D> hi = to[a].extent();
            if (a != up_) lo[up_] = kept_from_;
            lo[a] = end * frame_.cells[a], hi[a] = lo[a] + 1;
            for_each_in(lo, hi, [&](const Index<D>& I) { to[a](I) = before_[a](I); });
        }
}

template class Transport<2>;
template class Transport<3>;

}  // namespace weir::tallcell
