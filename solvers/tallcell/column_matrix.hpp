// The pressure matrix on columns of knots, stored on shared rows: every row with a knot in any column. Between two adjacent shared rows the
// pressure is linear in every column. With a value in each shared row all columns have the same elements, and the matrix couples a row to
// the rows above and below in its own column and in the four neighbouring columns. A column has no unknown in a row inside one of its
// elements; the value there is interpolated between its knots: x = R q. So the matrix of the knots is
//   A = Rᵀ (Σ_columns T + Σ_faces W ⊗ [1 −1; −1 1]) R      T: vertical faces and faces of air; W: faces between two columns
// with T and W tridiagonal, without any index search. Coarser columns keep the shared rows, so their matrices are plain sums.
#pragma once
#include "core/parallel.hpp"
#include "parallel/communicator.hpp"
#include "parallel/plane_store.hpp"
#include "tallcell/columns.hpp"

#include <algorithm>
#include <cstddef>

namespace weir::tallcell {

/// Lines of columns [begin, end).
struct LineRange {
    int begin = 0, end = 0;
};

/// Memory layout of column entries: line by line along the first horizontal axis, row by row within a line, and within a row columns of
/// even index before those of odd index. So columns of one checkerboard colour are contiguous, and so are their neighbours along either
/// axis. Lines start and end with an unused row, and each parity of a row with an unused entry. A line of zeros precedes the first line:
/// the neighbour where there is none.
struct ColumnPlaces {
    std::array<int, 2> n{1, 1};      // columns along the horizontal axes
    std::array<bool, 2> periodic{};  // of these axes
    int rows = 0;                    // number of shared rows
    Partition cut;                   // in parallel, the partition of lines; empty for replicated work

    static constexpr int block = 8192;  // entries of a line summed together
    static constexpr int no_line = -1;  // index of the line of zeros

    bool operator==(const ColumnPlaces&) const = default;
    int blocks_of_line() const { return (static_cast<int>(line_stride()) + block - 1) / block; }
    /// The lines that this rank owns.
    LineRange own() const {
        return cut.empty() ? LineRange{0, n[1]} : LineRange{cut.begin(communicator().rank()), cut.end(communicator().rank(), n[1])};
    }
    /// The same, for reductions.
    OwnPlanes planes() const { return OwnPlanes(slab_of(cut, 1, periodic[1])); }
    /// In parallel the line after these, whose faces towards them they own too; −1 where there is none.
    int beyond() const {
        if (cut.empty()) return -1;
        const int z = own().end;
        return z < n[1] ? z : periodic[1] ? 0 : -1;
    }
    int even() const { return (n[0] + 1) / 2; }
    int of_parity(int parity) const { return parity == 0 ? even() : n[0] / 2; }
    std::ptrdiff_t width() const { return even() + 2; }
    std::ptrdiff_t row_stride() const { return 2 * width(); }
    std::ptrdiff_t line_stride() const { return (rows + 2) * row_stride(); }
    /// Offset of a line.
    std::size_t line(int z) const { return static_cast<std::size_t>((z + 1) * line_stride()); }
    std::size_t first(int z, int k, int parity) const {
        return line(z) + static_cast<std::size_t>((k + 1) * row_stride() + parity * width() + 1);
    }
    std::size_t at(int x, int z, int k) const { return first(z, k, x % 2) + static_cast<std::size_t>(x / 2); }
    /// Returns whether the first and the last column along a periodic axis are neighbours of the same colour.
    bool joint(int axis) const { return periodic[static_cast<std::size_t>(axis)] && n[static_cast<std::size_t>(axis)] % 2 == 1; }
};

/// f(i) for the entries of this rank's lines and of `beyond` ghost lines, also around a periodic axis; a line has `count` entries.
template <class F>
void for_each_near(const ColumnPlaces& places, int beyond, int count, F&& f) {
    const LineRange own = places.own();
    const int n = places.n[1], all = n * count, above = places.cut.empty() ? 0 : beyond;
    const int below = std::min(above, n - (own.end - own.begin) - above);
    parallel_for((own.begin - below) * count, (own.end + above) * count, [&](int i) {
        const bool inside = i >= 0 && i < all;
        if (inside || places.periodic[1]) f(inside ? i : (i + all) % all);
    });
}

/// f(line) for this rank's lines and `beyond` ghost lines.
template <class F>
void for_each_line_near(const ColumnPlaces& places, int beyond, F&& f) {
    for_each_near(places, beyond, 1, f);
}

/// f(column), line by line.
template <class F>
void for_each_column_near(const ColumnPlaces& places, int beyond, F&& f) {
    for_each_near(places, beyond, places.n[0], f);
}

/// An array with an entry for each column in a row: of all lines, or, with distributed storage, of this rank's and one ghost line on each
/// side.
template <class T>
using LineStore = PlaneStore<T>;

/// Allocates entries of lines; memory that fits is reused with its contents.
template <class T>
void resize_lines(const ColumnPlaces& places, LineStore<T>& values) {
    const auto line = static_cast<std::size_t>(places.line_stride());
    values.resize(slab_of(places.cut, 1, places.periodic[1]), line, line, places.n[1], 0);
}
template <class T>
void refill_lines(const ColumnPlaces& places, LineStore<T>& values) {
    resize_lines(places, values);
    values.fill(T{});
}

/// As planes, for the halo exchange.
template <class T>
Planes lines_of(const ColumnPlaces& places, LineStore<T>& values) {
    return {values.data() + places.line(0), sizeof(T) * static_cast<std::size_t>(places.line_stride()), places.n[1], 0, values.held()};
}

/// In parallel, fills one ghost line on each side.
template <class T>
void refresh_lines(const ColumnPlaces& places, LineStore<T>& values) {
    if (!places.cut.empty()) communicator().refresh(places.cut, lines_of(places, values), 1, places.periodic[1]);
}

/// Strides from the entry of a column to those of its neighbours.
struct Beside {
    std::ptrdiff_t x_lower, x_upper, z_lower, z_upper;
    Beside(const ColumnPlaces& places, int z, int parity)
        : x_lower(parity == 0 ? places.width() - 1 : -places.width()), x_upper(x_lower + 1) {
        const int last = places.n[1] - 1;
        const bool around = places.periodic[1] && last > 0;
        const int lower = z > 0 ? z - 1 : around ? last : ColumnPlaces::no_line;
        const int upper = z < last ? z + 1 : around ? 0 : ColumnPlaces::no_line;
        z_lower = (lower - z) * places.line_stride(), z_upper = (upper - z) * places.line_stride();
    }
};

struct ColumnMatrix : ColumnPlaces {
    enum State : std::uint8_t { wet = 1, inside = 2, goes_on = 4 };  // inside: an element, no knot; goes_on: up to the next shared row
    std::vector<int> row;                                            // of the lattice
    LineStore<std::uint8_t> state;                                   // of a column in a row
    LineStore<real> share;                                           // inside: the interpolation weight of the knot above
    LineStore<real> vertical;                                        // T: between a row and the next
    LineStore<real> lid;                                             // air faces above and below
    LineStore<real> sink, sink_next;                     // air faces beside: the diagonal, and the entry between a row and the next
    std::array<LineStore<real>, 2> beside, beside_next;  // W of the face on the lower side along either axis
    std::vector<std::uint8_t> mixed;                     // rows inside an element of any column
    int mixed_end = 0;                                   // all rows from this one on, and the one below it, are outside elements
    std::vector<std::uint8_t> tall;                      // rows at an end of an element longer than one cell

    /// A row in which W is equal on all faces along an axis, except on sides of the domain, where it is 0.
    struct Alike {
        std::uint8_t yes = 0;
        std::array<real, 2> beside{}, beside_next{};
        bool operator==(const Alike&) const = default;
    };
    std::vector<Alike> alike;

    /// Allocates zeros for `row`; `everybodys`: storage of all lines on all ranks.
    void resize(bool everybodys = false);
    /// Fills the entries beyond the ends of lines around a periodic axis, and finds the mixed, tall and alike rows.
    void finish();
    /// All arrays with an entry for each column in a row.
    auto lists() {
        return std::array{&share, &vertical, &lid, &sink, &sink_next, &beside[0], &beside_next[0], &beside[1], &beside_next[1]};
    }
    std::size_t bytes() const;

private:
    /// Properties of a row within this rank's lines.
    struct Look {
        Alike alike;
        std::uint8_t inside = 0;
    };
    bool any_inside(int k) const;
    Alike look_beside(int k) const;
    void join_looks();
    void find_shares(int x, int z);

    std::vector<Look> looks_;  // in parallel those of all ranks, concatenated
    ColumnPlaces cleared_;     // the layout for which the line of zeros was cleared
};

/// Copies the columns at the ends of line z beyond its other end, where the axis is periodic.
template <class T>
void wrap_line(const ColumnPlaces& places, int z, T* values) {
    const int n = places.n[0];
    if (!places.periodic[0] || n == 1) return;
    for (int k = 0; k < places.rows; ++k) {
        values[places.first(z, k, 1) - 1] = values[places.at(n - 1, z, k)];
        values[places.first(z, k, n % 2) + static_cast<std::size_t>(places.of_parity(n % 2))] = values[places.at(0, z, k)];
    }
}

}  // namespace weir::tallcell
