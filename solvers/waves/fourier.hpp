// A real field on the sheet from the coefficients of its waves (FFTW), row by row with one plan for all rows: threads share rows, and
// results are bitwise independent of their number.
//
//     out(i, k) = sum over m, n of c(m, n) exp(2 pi i (m i / nx + n k / nz)),   c(-m, -n) = conj c(m, n)
#pragma once
#include "waves/transposition.hpp"

namespace weir::waves {

/// The half plane m = 0 .. nx/2, n = 0 .. nz - 1, of which some columns are stored on this rank; n fastest.
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
    /// Waves whose sine or cosine phase the grid does not resolve.
    bool ambiguous(int m, int n) const { return 2 * m == nx || 2 * n == nz; }
};

/// In parallel only own rows are written.
class Synthesis {
public:
    /// The columns that this rank stores: all, or its own with distributed storage.
    static HalfPlane held_plane(int nx, int nz, const OwnPlanes& rows);
    Synthesis(const HalfPlane& plane, const OwnPlanes& rows);
    ~Synthesis();
    Synthesis(const Synthesis&) = delete;
    Synthesis& operator=(const Synthesis&) = delete;

    /// `column(m, at)` writes the nz coefficients of column m; row k of the field is written to out + k stride.
    template <class F>
    void operator()(const F& column, real* out, std::size_t stride) {
        const PlaneRange own = own_columns();
        parallel_for(own.begin, own.end, [&](int m) {
            column(m, transposition_.column(m));
            transform_column(m);
        });
        rows(out, stride);
    }
    /// The columns that this rank transforms.
    PlaneRange own_columns() const { return transposition_.own_columns(); }
    const OwnPlanes& columns() const { return transposition_.columns(); }
    std::size_t bytes() const;

private:
    struct Plans;
    void transform_column(int m);
    void rows(real* out, std::size_t stride);

    HalfPlane plane_;
    Transposition<Complex> transposition_;
    std::unique_ptr<Plans> plans_;
};

}  // namespace weir::waves
