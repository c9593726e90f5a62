// Parallel transposition between columns of coefficients (along z) and rows of a field (along x), which are transformed one after the other
// (FFTW). Where ranks share the field's rows, each also has a share of the columns, and the ranks transpose between the two transforms.
#pragma once
#include "core/parallel.hpp"
#include "core/types.hpp"
#include "parallel/communicator.hpp"

#include <algorithm>
#include <complex>
#include <memory>
#include <vector>

namespace weir::waves {

using Complex = std::complex<real>;

struct FreeAligned {
    void operator()(void* at) const;
};
template <class T>
using Aligned = std::unique_ptr<T[], FreeAligned>;
/// Memory aligned for FFTW; zero.
template <class T>
Aligned<T> aligned(std::size_t count);
/// A column or row of n entries is padded to whole cache lines, so that all have the alignment used for planning.
inline std::size_t padded(int n) { return (static_cast<std::size_t>(n) + 3) / 4 * 4; }

/// The partition of columns.
inline Partition partition_of_columns(int columns, int ranks) { return equal_partition(columns, ranks); }
/// This rank's share of the columns, where it has one of the rows; stored whole.
OwnPlanes own_columns_of(int columns, const OwnPlanes& rows);
/// The columns that this rank stores: its own where rows have distributed storage.
PlaneRange held_columns(int columns, const OwnPlanes& rows);

/// T: real or Complex.
template <class T>
class Transposition {
public:
    Transposition(int columns, int rows, const OwnPlanes& own);

    /// The entries of a stored column.
    T* column(int m) const { return columns_.get() + static_cast<std::size_t>(m - held_.begin) * length_; }
    /// The columns that this rank transforms.
    PlaneRange own_columns() const { return {by_column_.lower(0), by_column_.upper(column_count_)}; }
    PlaneRange own_rows() const { return {by_row_.lower(0), by_row_.upper(row_count_)}; }
    const OwnPlanes& columns() const { return by_column_; }

    /// Backward: own rows of all columns, from own columns of all rows. row_at(n) receives the entries of row n; then transform(n) is
    /// called.
    template <class At, class F>
    void to_rows(const At& row_at, const F& transform) {
        if (transposes()) transpose();
        const PlaneRange own = own_rows();
        constexpr int block = 8;  // rows gathered from the columns at a time
        parallel_for(0, (own.end - own.begin + block - 1) / block, [&](int b) {
            const int first = own.begin + b * block, last = std::min(own.end, first + block);
            for (int m = 0; m < column_count_; ++m) {
                const T* from = own_rows_of(m);
                for (int n = first; n < last; ++n) row_at(n)[m] = from[n - own.begin];
            }
            for (int n = first; n < last; ++n) transform(n);
        });
    }
    /// Forward: row_at(n) returns the entries of an own row.
    template <class At>
    void to_columns(const At& row_at) {
        if (transposes()) make_room();
        const PlaneRange own = own_rows();
        parallel_for(0, column_count_, [&](int m) {
            T* to = own_rows_of(m);
            for (int n = own.begin; n < own.end; ++n) to[n - own.begin] = row_at(n)[m];
        });
        if (transposes()) transpose_back();
    }
    std::size_t bytes() const;

private:
    /// The message of one other rank: its rows of own columns, and own rows of its columns.
    struct Block {
        int peer;
        PlaneRange rows;
        T *of_columns, *of_rows;  // positions in turned_ and in others_
        std::size_t columns_bytes, rows_bytes;
    };
    bool transposes() const { return by_row_.distributed(); }
    PlaneRange columns_of(int rank) const { return {by_column_.partition().begin(rank), by_column_.partition().end(rank, column_count_)}; }
    PlaneRange rows_of(int rank) const { return {by_row_.partition().begin(rank), by_row_.partition().end(rank, row_count_)}; }
    void make_room();
    std::vector<Block> blocks();
    template <class F>
    void each_part(const Block& block, const F& f);
    void transpose();
    void transpose_back();
    T* own_rows_of(int m);

    int column_count_, row_count_;
    OwnPlanes by_row_, by_column_;
    PlaneRange held_;
    std::size_t length_;              // of a column
    std::vector<T> turned_, others_;  // a block for each other rank: of own columns, and of own rows
    Aligned<T> columns_;
};

}  // namespace weir::waves
