// A real field on the sheet from the coefficients of its waves (FFTW), row by row with the same plan for every row: threads share rows, and
// no bit depends on how many there are.
//
//     out(i, k) = sum over m, n of c(m, n) exp(2 pi i (m i / nx + n k / nz)),   c(-m, -n) = conj c(m, n)
#pragma once
#include "core/parallel.hpp"
#include "core/slabs.hpp"
#include "core/types.hpp"

#include <complex>
#include <memory>
#include <vector>

namespace weir::waves {

using Complex = std::complex<real>;

/// The half plane m = 0 .. nx/2, n = 0 .. nz - 1, of which some columns are stored here; n fastest.
struct HalfPlane {
    int nx = 1, nz = 1;
    PlaneRange held = {0, nx / 2 + 1};
    int columns() const { return nx / 2 + 1; }
    bool whole() const { return held == PlaneRange{0, columns()}; }
    std::size_t size() const { return static_cast<std::size_t>(held.end - held.begin) * static_cast<std::size_t>(nz); }
    std::size_t at(int m, int n) const {
        return static_cast<std::size_t>(m - held.begin) * static_cast<std::size_t>(nz) + static_cast<std::size_t>(n);
    }
    /// n as a wavenumber: -nz/2 .. nz/2.
    int signed_n(int n) const { return 2 * n > nz ? n - nz : n; }
    /// Waves of which a grid sees only one of two phases, sine or cosine.
    bool ambiguous(int m, int n) const { return 2 * m == nx || 2 * n == nz; }
};

/// Over ranks that share the field's rows (OwnPlanes over nz rows) each transforms its share of the columns, the ranks transpose, and each
/// transforms its rows: only these are written. A sheet of one row is everybody's.
class Synthesis {
public:
    /// Of how many of the half plane's columns each of so many ranks takes care.
    static Cut cut_of_columns(const HalfPlane& plane, int ranks) { return cut_of(plane.columns(), ranks); }
    /// What this rank stores: all of it, or, where ranks hold their own rows alone, those columns.
    static HalfPlane held_plane(int nx, int nz);
    explicit Synthesis(const HalfPlane& plane);
    ~Synthesis();
    Synthesis(const Synthesis&) = delete;
    Synthesis& operator=(const Synthesis&) = delete;

    /// `column(m, at)` writes the nz coefficients of column m; row k of the field goes to out + k stride.
    template <class F>
    void operator()(const F& column, real* out, std::size_t stride) {
        for_columns([&](int m, Complex* at) { column(m, at); });
        if (transposes()) transpose();
        rows(out, stride);
    }
    /// The columns for which this rank is asked.
    PlaneRange own_columns() const { return transposes() ? columns_of(slabs().rank()) : PlaneRange{0, plane_.columns()}; }
    std::size_t bytes() const;

private:
    struct Plans;
    bool transposes() const { return over_ranks() && plane_.nz > 1; }
    PlaneRange columns_of(int rank) const { return {by_column_.begin(rank), by_column_.end(rank, plane_.columns())}; }
    template <class F>
    void for_columns(const F& write) {
        const PlaneRange own = own_columns();
        parallel_for(own.begin, own.end, [&](int m) {
            write(m, column_at(m));
            transform_column(m);
        });
    }
    void transpose();
    Complex* column_at(int m) const;
    const Complex* own_rows_of(int m) const;
    PlaneRange own_rows() const {
        return transposes() ? PlaneRange{detail::own_share.lower(0), detail::own_share.upper(plane_.nz)} : PlaneRange{0, plane_.nz};
    }
    void transform_column(int m);
    void rows(real* out, std::size_t stride);

    HalfPlane plane_;
    Cut by_column_;                      // over ranks: whose columns
    std::vector<Complex> sent_, given_;  // of a transposition, a block for each other rank
    std::unique_ptr<Plans> plans_;
};

}  // namespace weir::waves
