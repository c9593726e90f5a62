// Assembly of TallPressure's matrix: shared rows of the columns, unknowns, and couplings. The surface enters by ghost fluid (Gibou et al.
// 2002), 1/θ towards air; solids by open fractions (Batty et al. 2007).
#include "tallcell/pressure.hpp"

#include "core/parallel.hpp"
#include "core/scratch.hpp"

namespace weir::tallcell {

using poisson::Cell;

/// A column of a line, and its neighbour across one side.
struct FaceOfColumns {
    std::size_t own, other;                // their indices in a shared row
    std::size_t own_cell, other_cell;      // on the lattice, in row 0
    std::size_t face;                      // between them, in row 0
    std::size_t cell_stride, face_stride;  // from row to row
    int axis;
    bool lower;  // the neighbour is on the lower side
    real weight;
};

/// The side of a line of columns (add_horizontal) towards the previous line.
constexpr int towards_lower_line = 2;

template <int D>
void TallPressure<D>::assemble(const Grid<real, D>& phi, const MacState<D>& state) {
    find_shared_rows();
    A_.cut = frame_.own().distributed() ? frame_.own().partition() : Partition{};
    A_.resize();
    for_each_column_near(A_, 1, [&](int c) { place_column(c); });
    for_each_column_near(A_, 0, [&](int c) { add_vertical(phi, state, c); });
    for_each_line_near(A_, 0, [&](int z) {
        for (int f = 0; f < faces(); ++f) add_horizontal(phi, state, z, f);
    });
    if (const int beyond = A_.beyond(); beyond >= 0) add_horizontal(phi, state, beyond, towards_lower_line);
    A_.finish();
}

template <int D>
void TallPressure<D>::find_shared_rows() {
    A_.row.clear();
    A_.row.reserve(at(layout_.rows));
    for (int row = 0; row < layout_.rows; ++row) {
        if (row_index_[at(row)] < 0) continue;
        row_index_[at(row)] = static_cast<int>(A_.row.size());
        A_.row.push_back(row);
    }
}

template <int D>
void TallPressure<D>::place_column(int column) {
    const std::size_t foot = A_.at(column % A_.n[0], column / A_.n[0], 0), stride = at(static_cast<int>(A_.row_stride()));
    for (int i = knots_.start[at(column)]; i < knots_.start[at(column) + 1]; ++i) {
        const int row = knots_.row[at(i)], length = knots_.length[at(i)];
        int k = row_index_[at(row)];
        A_.state[foot + at(k) * stride] = length > 0 ? ColumnMatrix::wet | ColumnMatrix::goes_on : ColumnMatrix::wet;
        for (++k; length > 0 && A_.row[at(k)] < row + length; ++k)
            A_.state[foot + at(k) * stride] = ColumnMatrix::wet | ColumnMatrix::inside | ColumnMatrix::goes_on;
    }
}

/// Vertical faces of a column: (q₁ − q₀)²/(H − 1) in an element, 1/θ towards air, zero towards a wall or a solid.
template <int D>
void TallPressure<D>::add_vertical(const Grid<real, D>& phi, const MacState<D>& state, int column) {
    const std::size_t foot = A_.at(column % A_.n[0], column / A_.n[0], 0), stride = at(static_cast<int>(A_.row_stride()));
    const int first = knots_.start[at(column)];
    const real weight = 1 / (frame_.h[layout_.up] * frame_.h[layout_.up]);
    const Line cell = line(state.cells, column), face = line(state.u[layout_.up], column);
    for (int i = first; i < knots_.start[at(column) + 1]; ++i) {
        const int row = knots_.row[at(i)], length = knots_.length[at(i)];
        int k = row_index_[at(row)];
        const std::size_t own = foot + at(k) * stride;
        const auto towards = [&](int other, int crossed) {
            if (state.cells[cell(other)] != Cell::air) return;
            A_.lid[own] += weight * open(state, layout_.up, face(crossed)) * cut(phi, cell(row), cell(other));
        };
        if (row > 0 && (i == first || knots_.length[at(i) - 1] == 0)) towards(row - 1, row);
        if (length > 0) {
            const real w = weight * (length == 1 ? open(state, layout_.up, face(row + 1)) : 1.0);
            for (; A_.row[at(k)] < row + length; ++k) A_.vertical[foot + at(k) * stride] = w / (A_.row[at(k) + 1] - A_.row[at(k)]);
        } else if (row + 1 < layout_.rows) {
            towards(row + 1, row + 1);
        } else if (state.sides.open(layout_.up, 1)) {
            A_.lid[own] += 2 * weight;  // p = 0 on the side itself, half a cell away
        }
    }
}

/// Horizontal faces on side f of the columns of a line: the open fraction between two liquid cells, 1/θ towards air.
template <int D>
void TallPressure<D>::add_horizontal(const Grid<real, D>& phi, const MacState<D>& state, int z, int f) {
    const int h = f / 2, n = A_.n[0];
    FaceOfColumns face;
    face.axis = layout_.axes[at(h)];
    face.lower = f % 2 == 0;
    face.weight = 1 / (frame_.h[face.axis] * frame_.h[face.axis]);
    face.cell_stride = static_cast<std::size_t>(state.cells.stride(layout_.up));
    face.face_stride = static_cast<std::size_t>(state.u[face.axis].stride(layout_.up));
    LineStore<real>& W = A_.beside[at(h)];
    const bool solids = state.solid.any();
    for (int x = 0; x < n; ++x) {
        const int c = x + z * n, beside = face.lower ? layout_.lower(c, h) : layout_.upper(c, h);
        if (beside < 0 || beside == c) continue;
        face.own = A_.at(x, z, 0), face.other = A_.at(beside % n, beside / n, 0);
        face.own_cell = state.cells.linear(layout_.foot(c)), face.other_cell = state.cells.linear(layout_.foot(beside));
        face.face = state.u[face.axis].linear(layout_.foot(face.lower ? c : beside));
        const auto stride = static_cast<std::size_t>(A_.row_stride());
        for (int k = 0; k < A_.rows; ++k) {
            const std::size_t own = face.own + at(k) * stride, other = face.other + at(k) * stride;
            if (!(A_.state[own] & ColumnMatrix::wet)) continue;
            const auto row = at(A_.row[at(k)]);
            if (A_.state[other] & ColumnMatrix::wet) {
                if (face.lower) W[own] += solids ? face.weight * open(state, face.axis, face.face + row * face.face_stride) : face.weight;
            } else {
                const std::size_t here = face.own_cell + row * face.cell_stride, there = face.other_cell + row * face.cell_stride;
                if (state.cells[there] == Cell::air)
                    A_.sink[own] += face.weight * open(state, face.axis, face.face + row * face.face_stride) * cut(phi, here, there);
            }
            if ((A_.state[own] & ColumnMatrix::goes_on) && A_.row[at(k) + 1] > A_.row[at(k)] + 1) add_inner_rows(phi, state, face, k);
        }
    }
}

/// Rows between shared row k and the next, in which the column is liquid.
template <int D>
void TallPressure<D>::add_inner_rows(const Grid<real, D>& phi, const MacState<D>& state, const FaceOfColumns& face, int k) {
    const auto stride = static_cast<std::size_t>(A_.row_stride());
    const std::size_t own = face.own + at(k) * stride;
    const int first = A_.row[at(k)], length = A_.row[at(k) + 1] - first;
    const bool both = (A_.state[face.other + at(k) * stride] & ColumnMatrix::goes_on) != 0;
    if (both && !face.lower) return;
    auto& diagonal = both ? A_.beside[face.axis == layout_.axes[0] ? 0 : 1] : A_.sink;
    auto& next = both ? A_.beside_next[face.axis == layout_.axes[0] ? 0 : 1] : A_.sink_next;
    const auto add = [&](real share, real w) {
        diagonal[own] += w * (1 - share) * (1 - share);
        next[own] += w * share * (1 - share);
        diagonal[own + stride] += w * share * share;
    };
    if (both && !state.solid.any()) {  // Σ (j/H)² = (H − 1)(2 H − 1)/(6 H) and Σ (j/H)(1 − j/H) = (H² − 1)/(6 H), j = 1 .. H − 1
        const real H = length, squares = face.weight * (H - 1) * (2 * H - 1) / (6 * H);
        diagonal[own] += squares;
        next[own] += face.weight * (H * H - 1) / (6 * H);
        diagonal[own + stride] += squares;
        return;
    }
    for (int j = 1; j < length; ++j) {
        const auto row = at(first + j);
        const std::size_t here = face.own_cell + row * face.cell_stride, there = face.other_cell + row * face.cell_stride;
        const real w = face.weight * open(state, face.axis, face.face + row * face.face_stride);
        if (both)
            add(static_cast<real>(j) / length, w);
        else if (state.cells[there] == Cell::air)
            add(static_cast<real>(j) / length, w * cut(phi, here, there));
    }
}

#define WEIR_INSTANTIATE(D)                                                                            \
    template void TallPressure<D>::assemble(const Grid<real, D>& phi, const MacState<D>& state);       \
    template void TallPressure<D>::find_shared_rows();                                                 \
    template void TallPressure<D>::place_column(int column);                                           \
    template void TallPressure<D>::add_vertical(const Grid<real, D>&, const MacState<D>&, int);        \
    template void TallPressure<D>::add_horizontal(const Grid<real, D>&, const MacState<D>&, int, int); \
    template void TallPressure<D>::add_inner_rows(const Grid<real, D>&, const MacState<D>&, const FaceOfColumns&, int);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::tallcell
