// One level of the geometric hierarchy. Every vector is two packed arrays, red and black (even and odd sum of indices). Entry m of a row of
// parity s is cell i = 2m + s in the red array and i = 2m + 1 − s in the black one. The x-neighbours of entry m are then entries m and m ±
// 1 of the other colour's row, all other neighbours are entry m, and every loop is contiguous. Entries outside fluid are zero.
#pragma once
#include "core/simd.hpp"
#include "parallel/communicator.hpp"
#include "poisson/geometric/arena.hpp"
#include "poisson/poisson.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace weir::poisson {

using namespace simd;
inline constexpr int lanes = width<f16>;  // entries of a vector

/// A range of entries of a row, in multiples of 16, that contains all fluid of both colours.
struct Span {
    int begin, end;
};

template <class T>
using Coloured = std::array<T*, 2>;

template <int D>
struct Layout {
    Index<D> n{};
    std::array<bool, D> periodic{};
    int width = 0;   // entries of one colour in a row
    int stride = 0;  // from one row to the next: whole vectors, plus one of zeros

    Layout() = default;
    Layout(const Index<D>& n_, const std::array<bool, D>& periodic_) : n(n_), periodic(periodic_) {
        width = (n[0] + 1) / 2;
        stride = (width + lanes - 1) / lanes * lanes + lanes;
        for (int a = 0; a < D; ++a)
            if (n[a] == 1) periodic[static_cast<std::size_t>(a)] = false;
    }
    int planes() const { return n[D - 1]; }
    int rows_in_plane() const { return D == 2 ? 1 : n[1]; }
    int rows() const { return planes() * rows_in_plane(); }
    /// Row −1 is zero: the neighbour of a row at a closed or open side.
    std::size_t entries() const { return static_cast<std::size_t>(rows() + 1) * static_cast<std::size_t>(stride) + 2 * lanes; }
    /// Additional rows with the weights of sides, which black cells beside them read: one for each row along a side.
    int side_rows() const { return D == 2 ? 1 : std::max(planes(), rows_in_plane()); }
    int side_row(int q, int j, int a) const { return rows() + (a == D - 1 ? j : q); }
    std::ptrdiff_t offset(int row) const { return static_cast<std::ptrdiff_t>(row) * stride; }
    /// Row of the plane q at height j (j is 0 in 2D).
    int row(int q, int j) const { return D == 2 ? q : q * n[1] + j; }
    int parity(int q, int j) const { return (q + j) & 1; }
    /// The neighbour of that row along axis a > 0, −1 beyond a side.
    int neighbour(int q, int j, int a, int side) const {
        int& moved = a == D - 1 ? q : j;
        moved += side == 0 ? -1 : 1;
        if (moved < 0 || moved >= n[a]) {
            if (!periodic[static_cast<std::size_t>(a)]) return -1;
            moved = moved < 0 ? n[a] - 1 : 0;
        }
        return row(q, j);
    }
    /// Writes the entries beyond both ends of a row that its periodic neighbours read.
    template <class T>
    void wrap(T* at_row) const {
        if (!periodic[0]) return;
        at_row[-1] = at_row[width - 1];
        at_row[width] = at_row[0];
    }
};

/// The factor of the weights to p = 0 from cells of m finest cells to cells of 2 m: an air cell keeps its distance while fluid cells grow
/// (half a cell of each).
inline real zero_scale(real m) {
    const auto f = [](real width) { return width / (width / 2 + 0.5); };
    return 0.5 * f(2 * m) / f(m);
}

/// Weights of the lower faces of one natural row, and its cells' couplings to p = 0. Used only while building.
template <int D>
struct FaceRow {
    std::array<const float*, D> face;
    const float* zero;
    const std::uint8_t* fluid;
};

template <int D>
struct Level {
    Layout<D> at;
    std::array<bool, D> coarsened{};      // axes along which the next level has half as many cells
    std::array<float, D> plain_weight{};  // the most frequent face weight along each axis
    real zero_width = 1;                  // width of a cell in finest cells, along the coarsened axes

    Coloured<float> u{}, r{};
    // the diagonal: on the finest level one byte per cell, the number of open faces; otherwise its inverse
    bool by_count = false;
    Coloured<std::uint8_t> count{};
    alignas(64) std::array<float, lanes> inverse{};  // 1 / (weight × count), 0 for 0
    Coloured<float> dinv{};
    // further couplings to p = 0 (zero_coupling.hpp), on the finest level of a problem that has them
    bool has_zero = false;
    Coloured<float> packed_zero{};
    // faces in the order of the red cells: below and above along each axis; unused with by_count
    std::array<float*, 2 * D> weight{};
    std::vector<std::uint8_t> plain;  // rows whose fluid cells have uniform weights only

    std::vector<int> span_start;  // per row, plus one
    std::vector<Span> spans;
    std::vector<std::int64_t> work;  // blocks before each plane

    // Natural order, for building the next level.
    std::array<float*, D> face{};
    float* zero = nullptr;
    std::uint8_t* fluid = nullptr;

    Partition cut{};           // in parallel: the partition of planes; empty for replicated work
    std::vector<char> held{};  // planes stored on this rank; empty where it stores all

    std::size_t cells() const { return product(at.n); }
    /// The planes of a packed vector, starting one entry before its rows: a periodic row stores the left neighbour of its first entry
    /// there.
    template <class T>
    Planes planes_of(T* vector) const {
        const int rows = at.rows_in_plane();
        return {vector - 1, sizeof(T) * static_cast<std::size_t>(rows) * static_cast<std::size_t>(at.stride), at.planes(), 0,
                held.empty() ? nullptr : held.data()};
    }
    /// The planes of an array in natural order.
    template <class T>
    Planes natural_planes(T* array) const {
        return {array, sizeof(T) * cells() / static_cast<std::size_t>(at.planes()), at.planes(), 0, held.empty() ? nullptr : held.data()};
    }
    bool holds(int plane) const { return held.empty() || held[static_cast<std::size_t>(plane)] != 0; }
    /// Returns whether this rank computes a plane's matrix.
    bool owns(int plane) const {
        return held.empty() || (plane >= cut.begin(communicator().rank()) && plane < cut.end(communicator().rank(), at.planes()));
    }
    /// Opens the planes of a packed vector that this rank stores. The vector is a piece of the arena and begins `skip` entries before its
    /// first row; `size`: including the entries after its rows.
    template <class T>
    void open(Arena& arena, const T* vector, std::size_t skip, std::size_t size) const {
        const T* const first = vector - skip;
        if (held.empty()) return arena.open(first, first + size);
        const std::ptrdiff_t plane = at.offset(at.rows_in_plane());
        arena.open(first, vector + lanes);
        for (int q = 0; q < at.planes(); ++q)
            if (holds(q)) arena.open(vector + q * plane - lanes, vector + (q + 1) * plane + lanes);
        arena.open(vector + at.planes() * plane - lanes, first + size);
    }
    template <class T>
    void open_natural(Arena& arena, const T* array) const {
        const auto plane = static_cast<std::ptrdiff_t>(cells() / static_cast<std::size_t>(at.planes()));
        for (int q = 0; q < at.planes(); ++q)
            if (holds(q)) arena.open(array + q * plane, array + (q + 1) * plane);
    }
    /// In parallel: halo exchange after each stage of a sweep has written its planes.
    template <class T>
    void refresh(T* vector) const {
        if (!cut.empty()) communicator().refresh(cut, planes_of(vector), 1, at.periodic[D - 1]);
    }
    template <class T>
    void refresh(const std::array<T*, 2>& vectors) const {
        if (cut.empty()) return;
        const std::array<Planes, 2> both{planes_of(vectors[0]), planes_of(vectors[1])};
        communicator().refresh(cut, both, 1, at.periodic[D - 1]);
    }
    /// Returns whether the row has no fluid; valid once the spans are known.
    bool is_dry(int row) const { return span_start[static_cast<std::size_t>(row)] == span_start[static_cast<std::size_t>(row) + 1]; }
};

}  // namespace weir::poisson
