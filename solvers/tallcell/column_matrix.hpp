// The matrix of pressures on columns of knots, on rows that all columns share: every row that is a knot of any column. Between two shared
// rows next to one another a pressure is linear in every column, so with a value in each shared row all columns have the same elements, and
// the matrix couples a row to the next above and below in its own column and in the four beside it. A column has no unknown in a row that
// lies inside an element of its own; it takes there what is between its knots: x = R q. So the matrix of the knots is
//   A = Rᵀ (Σ_columns T + Σ_faces W ⊗ [1 −1; −1 1]) R      T: vertical faces and faces of air; W: faces between two columns
// with T and W tridiagonal, and nothing in it is searched for. Coarser columns keep the shared rows, so that theirs are plain sums.
#pragma once
#include "core/parallel.hpp"
#include "core/plane_store.hpp"
#include "core/slabs.hpp"
#include "tallcell/columns.hpp"

#include <algorithm>
#include <cstddef>

namespace weir::tallcell {

/// Lines of columns [begin, end).
struct LineRange {
    int begin = 0, end = 0;
};

/// Where the entries of columns lie in memory: line by line along the first horizontal axis, in a line row by row, and in a row the columns
/// of even number before those of odd number. So columns of one colour of a checkerboard lie beside one another, and so do their
/// neighbours along either axis. Lines begin and end with a row, and rows of either parity with an entry, that no column has.
/// Before the first line stands one of zeros: the neighbour of those that have none.
struct ColumnPlaces {
    std::array<int, 2> n{1, 1};      // columns along the horizontal axes
    std::array<bool, 2> periodic{};  // they
    int rows = 0;                    // that columns share
    Cut cut;                         // over ranks, whose lines are whose; empty where everybody does all

    static constexpr int block = 8192;  // entries of a line that are added up together
    static constexpr int no_line = -1;  // that of zeros

    bool operator==(const ColumnPlaces&) const = default;
    int blocks_of_line() const { return (static_cast<int>(line_stride()) + block - 1) / block; }
    /// The lines that are done here.
    LineRange own() const { return cut.empty() ? LineRange{0, n[1]} : LineRange{cut.begin(slabs().rank()), cut.end(slabs().rank(), n[1])}; }
    /// Over ranks the line after the last of these, whose faces towards it are theirs too; −1 where there is none.
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
    /// Where a line begins.
    std::size_t line(int z) const { return static_cast<std::size_t>((z + 1) * line_stride()); }
    std::size_t first(int z, int k, int parity) const {
        return line(z) + static_cast<std::size_t>((k + 1) * row_stride() + parity * width() + 1);
    }
    std::size_t at(int x, int z, int k) const { return first(z, k, x % 2) + static_cast<std::size_t>(x / 2); }
    /// An axis along which the first and the last column have one colour and are neighbours.
    bool joint(int axis) const { return periodic[static_cast<std::size_t>(axis)] && n[static_cast<std::size_t>(axis)] % 2 == 1; }
};

/// f(i) for the entries of the lines that are done here and of so many beyond the cuts, around a periodic axis too; a line has `count`.
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

/// f(line) for the lines that are done here and so many beyond the cuts.
template <class F>
void for_each_line_near(const ColumnPlaces& places, int beyond, F&& f) {
    for_each_near(places, beyond, 1, f);
}

/// f(column), line after line.
template <class F>
void for_each_column_near(const ColumnPlaces& places, int beyond, F&& f) {
    for_each_near(places, beyond, places.n[0], f);
}

/// What has an entry for each column in a row: of all lines, or, where a rank holds its own alone, of those and one beyond either cut.
template <class T>
using LineStore = PlaneStore<T>;

/// Room for entries of lines; what fits is kept, with what stands in it.
template <class T>
void resize_lines(const ColumnPlaces& places, LineStore<T>& values) {
    const auto line = static_cast<std::size_t>(places.line_stride());
    if (places.cut.empty()) {
        const AllPlanes all;
        return values.resize(line, line, places.n[1], 0);
    }
    const OwnPlanes own(places.cut, 1, detail::own_share.kept > 0 ? 1 : 0, places.periodic[1]);
    values.resize(line, line, places.n[1], 0);
}
template <class T>
void refill_lines(const ColumnPlaces& places, LineStore<T>& values) {
    resize_lines(places, values);
    values.fill(T{});
}

/// As planes, for whoever brings them.
template <class T>
Planes lines_of(const ColumnPlaces& places, LineStore<T>& values) {
    return {values.data() + places.line(0), sizeof(T) * static_cast<std::size_t>(places.line_stride()), places.n[1], 0, values.held()};
}

/// Over ranks, brings the line beyond either cut.
template <class T>
void refresh_lines(const ColumnPlaces& places, LineStore<T>& values) {
    if (!places.cut.empty()) slabs().refresh(places.cut, lines_of(places, values), 1, places.periodic[1]);
}

/// From the entry of a column to those of the columns beside it.
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
    enum State : std::uint8_t { wet = 1, inside = 2, goes_on = 4 };  // inside: of an element, no knot; goes_on: up to the next shared row
    std::vector<int> row;                                            // of the lattice
    LineStore<std::uint8_t> state;                                   // of a column in a row
    LineStore<real> share;                                           // inside: the weight of the knot above
    LineStore<real> vertical;                                        // T: between a row and the next
    LineStore<real> lid;                                             // faces of air above and below
    LineStore<real> sink, sink_next;                     // faces of air beside: the diagonal, and the entry between a row and the next
    std::array<LineStore<real>, 2> beside, beside_next;  // W of the face on the lower side along either axis
    std::vector<std::uint8_t> mixed;                     // rows inside an element of any column
    int mixed_end = 0;                                   // none at or above this row, nor in the one below
    std::vector<std::uint8_t> tall;                      // rows at an end of an element longer than one

    /// A row in which W is the same for all faces along an axis, but for sides of the domain, where it is nothing.
    struct Alike {
        std::uint8_t yes = 0;
        std::array<real, 2> beside{}, beside_next{};
        bool operator==(const Alike&) const = default;
    };
    std::vector<Alike> alike;

    /// Room for `row`, filled with nothing; `everybodys`: all ranks are to have all of it.
    void resize(bool everybodys = false);
    /// What lies beyond the ends of lines around a periodic axis; and which rows are mixed, tall and alike.
    void finish();
    /// All that has an entry for each column in a row.
    auto lists() {
        return std::array{&share, &vertical, &lid, &sink, &sink_next, &beside[0], &beside_next[0], &beside[1], &beside_next[1]};
    }
    std::size_t bytes() const;
    /// Over ranks, of what each says of a row.
    static constexpr std::size_t bytes_of_look();

private:
    /// What a row is, as far as the lines that are done here go.
    struct Look {
        Alike alike;
        std::uint8_t inside = 0;
    };
    bool any_inside(int k) const;
    Alike look_beside(int k) const;
    void join_looks();
    void find_shares(int x, int z);

    std::vector<Look> looks_;  // over ranks those of all, one after another
    ColumnPlaces cleared_;     // where the line of zeros is that
};

constexpr std::size_t ColumnMatrix::bytes_of_look() { return sizeof(Look); }

/// Copies the columns at the ends of line z to beyond its other end, where the axis is periodic.
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
