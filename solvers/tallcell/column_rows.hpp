// Row operations for sweeps over adjacent columns: the couplings to neighbouring columns, interpolation of rows inside elements from their
// knots (R), and its transpose (Rᵀ).
#pragma once
#include "core/parallel.hpp"
#include "tallcell/column_matrix.hpp"

#include <algorithm>

namespace weir::tallcell {

inline constexpr int lanes = 64;  // columns of one line that are solved together

template <class I>
constexpr std::size_t at(I i) {
    return static_cast<std::size_t>(i);
}

/// f(z, begin, end) for the columns of one parity of every line, in blocks; `parity(z)` returns the parity.
template <class Parity, class F>
void for_each_block(const ColumnPlaces& places, int z_begin, int z_end, Parity&& parity, F&& f) {
    const int blocks = (places.even() + lanes - 1) / lanes;
    parallel_for(0, (z_end - z_begin) * blocks, [&](int i) {
        const int z = z_begin + i / blocks, begin = i % blocks * lanes, end = std::min(begin + lanes, places.of_parity(parity(z)));
        if (begin < end) f(z, begin, end);
    });
}

/// to[i] += Σ W x of the four neighbouring columns, in one shared row; all pointers are at the first column.
template <class T, bool Tall>
inline void add_beside(const std::array<LineStore<T>, 2>& W, const std::array<LineStore<T>, 2>& W_next, const T* x, std::size_t first,
                       const Beside& to, std::ptrdiff_t row, int count, T* sum) {
    const T *w0 = W[0].data() + first, *w1 = W[1].data() + first, *n0 = W_next[0].data() + first, *n1 = W_next[1].data() + first;
    const T* v = x + first;
#pragma omp simd
    for (int i = 0; i < count; ++i)
        sum[i] += (w0[i] * v[i + to.x_lower] + w0[i + to.x_upper] * v[i + to.x_upper]) +
                  (w1[i] * v[i + to.z_lower] + w1[i + to.z_upper] * v[i + to.z_upper]);
    if constexpr (Tall) {
#pragma omp simd
        for (int i = 0; i < count; ++i)
            sum[i] += ((n0[i] * v[i + to.x_lower + row] + n0[i - row] * v[i + to.x_lower - row]) +
                       (n0[i + to.x_upper] * v[i + to.x_upper + row] + n0[i + to.x_upper - row] * v[i + to.x_upper - row])) +
                      ((n1[i] * v[i + to.z_lower + row] + n1[i - row] * v[i + to.z_lower - row]) +
                       (n1[i + to.z_upper] * v[i + to.z_upper + row] + n1[i + to.z_upper - row] * v[i + to.z_upper - row]));
    }
}

/// The same where all columns of the row have equal face weights. Beyond sides of the domain x is 0.
template <bool Tall>
inline void add_alike(const ColumnMatrix::Alike& W, const ColumnMatrix::Alike& below, const float* v, const Beside& to, std::ptrdiff_t row,
                      int count, float* sum) {
    const auto w0 = static_cast<float>(W.beside[0]), w1 = static_cast<float>(W.beside[1]);
#pragma omp simd
    for (int i = 0; i < count; ++i) sum[i] += w0 * (v[i + to.x_lower] + v[i + to.x_upper]) + w1 * (v[i + to.z_lower] + v[i + to.z_upper]);
    if constexpr (Tall) {
        const auto a0 = static_cast<float>(W.beside_next[0]), a1 = static_cast<float>(W.beside_next[1]);
        const auto b0 = static_cast<float>(below.beside_next[0]), b1 = static_cast<float>(below.beside_next[1]);
#pragma omp simd
        for (int i = 0; i < count; ++i)
            sum[i] +=
                (a0 * (v[i + to.x_lower + row] + v[i + to.x_upper + row]) + b0 * (v[i + to.x_lower - row] + v[i + to.x_upper - row])) +
                (a1 * (v[i + to.z_lower + row] + v[i + to.z_upper + row]) + b1 * (v[i + to.z_lower - row] + v[i + to.z_upper - row]));
    }
}

/// sum += Σ W x of the neighbouring columns in row k, of either kind.
inline void add_row(const ColumnMatrix& A, const std::array<LineStore<float>, 2>& W, const std::array<LineStore<float>, 2>& W_next,
                    const float* x, int k, std::size_t first, const Beside& to, int count, float* sum) {
    const std::ptrdiff_t row = A.row_stride();
    const bool tall = A.tall[at(k)] != 0;
    const ColumnMatrix::Alike &here = A.alike[at(k)], &below = A.alike[at(std::max(k - 1, 0))];
    if (here.yes && !tall) return add_alike<false>(here, below, x + first, to, row, count, sum);
    if (here.yes && k > 0 && below.yes) return add_alike<true>(here, below, x + first, to, row, count, sum);
    if (tall) return add_beside<float, true>(W, W_next, x, first, to, row, count, sum);
    add_beside<float, false>(W, W_next, x, first, to, row, count, sum);
}

/// Rᵀ downwards: adds rows inside elements to the knot below. `above` accumulates its sum.
template <class T>
inline void gather_down(const real* share, T* y, T* above, int count) {
    for (int i = 0; i < count; ++i) {
        const T s = static_cast<T>(share[i]);
        const bool knot = s == 0;
        y[i] += knot ? above[i] : 0;
        above[i] = knot ? 0 : above[i] + (1 - s) * y[i];
    }
}

/// Rᵀ upwards: adds them to the knot above and sets them to zero.
template <class T>
inline void gather_up(const real* share, T* y, T* below, int count) {
    for (int i = 0; i < count; ++i) {
        const T s = static_cast<T>(share[i]), own = y[i];
        const bool knot = s == 0;
        y[i] = knot ? own + below[i] : 0;
        below[i] = knot ? 0 : below[i] + s * own;
    }
}

template <class T>
using Lanes = std::array<T, at(lanes)>;

/// y := Rᵀ y in the columns of one parity of a line.
template <class T>
void gather(const ColumnMatrix& A, int z, int parity, int begin, int end, T* y) {
    Lanes<T> carried{};
    for (int k = A.mixed_end - 1; k >= 0; --k) {
        const std::size_t first = A.first(z, k, parity) + at(begin);
        gather_down(A.share.data() + first, y + first, carried.data(), end - begin);
    }
    carried.fill(0);
    for (int k = 0; k < A.mixed_end; ++k) {
        const std::size_t first = A.first(z, k, parity) + at(begin);
        gather_up(A.share.data() + first, y + first, carried.data(), end - begin);
    }
}

/// x := R x: interpolates rows inside elements from their knots.
template <class T>
void interpolate(const ColumnMatrix& A, int z, int parity, int begin, int end, T* x) {
    const int count = end - begin;
    Lanes<T> carried{};
    for (int k = A.mixed_end - 1; k >= 0; --k) {
        const std::size_t first = A.first(z, k, parity) + at(begin);
        const real* share = A.share.data() + first;
        T* v = x + first;
        for (int i = 0; i < count; ++i) {
            carried[at(i)] = share[i] == 0 ? v[i] : carried[at(i)];
            v[i] = carried[at(i)];
        }
    }
    for (int k = 0; k < A.mixed_end; ++k) {
        const std::size_t first = A.first(z, k, parity) + at(begin);
        const real* share = A.share.data() + first;
        T* v = x + first;
        for (int i = 0; i < count; ++i) {
            carried[at(i)] = share[i] == 0 ? v[i] : carried[at(i)];
            v[i] = carried[at(i)] + static_cast<T>(share[i]) * (v[i] - carried[at(i)]);
        }
    }
}

template <class T>
void interpolate(const ColumnMatrix& A, LineStore<T>& x) {
    if (A.mixed_end == 0) return;
    for_each_line_near(A, 0, [&](int z) {
        for (const int parity : {0, 1})
            for (int begin = 0; begin < A.of_parity(parity); begin += lanes)
                interpolate(A, z, parity, begin, std::min(begin + lanes, A.of_parity(parity)), x.data());
    });
}

}  // namespace weir::tallcell
