// A field at cell centres as a series of cosines along both axes, or of sines along one (FFTW: DCT-II forward, DCT-III and DST-III
// backward). Columns and rows each use one plan: results are bitwise independent of threads and ranks.
//
//     out(i, k) = sum over m, n of a(m, n) cos(m pi (i + 1/2) / nx) cos(n pi (k + 1/2) / nz)
#pragma once
#include "waves/sheet.hpp"
#include "waves/transposition.hpp"

namespace weir::waves {

class Cosines {
public:
    enum class SinesAlong { none, x, z };  // instead of the cosines along this axis

    /// `rows`: this rank's, of the field.
    Cosines(int nx, int nz, const OwnPlanes& rows);
    ~Cosines();
    Cosines(const Cosines&) = delete;
    Cosines& operator=(const Cosines&) = delete;

    /// The columns m of modes that this rank stores, n fastest; and whether other ranks store the rest.
    const PlaneRange& held() const { return held_; }
    /// The columns of modes that this rank computes.
    const OwnPlanes& columns() const { return transposition_.columns(); }
    bool in_parts() const { return in_parts_; }
    std::size_t size() const { return static_cast<std::size_t>(held_.end - held_.begin) * static_cast<std::size_t>(nz_); }
    std::size_t at(int m, int n) const {
        return static_cast<std::size_t>(m - held_.begin) * static_cast<std::size_t>(nz_) + static_cast<std::size_t>(n);
    }

    /// The amplitudes of a field on the sheet, which is overwritten: of the stored modes. Collective.
    std::vector<real> analyse(Values& field);
    /// amplitude(m, n) of every mode except the constant one, which is 0; row k of the field is written to out + k stride, for own rows.
    template <class F>
    void operator()(SinesAlong sines, const F& amplitude, real* out, std::size_t stride) {
        const PlaneRange own = transposition_.own_columns();
        const int first = sines == SinesAlong::z ? 1 : 0;  // a column of sines begins with number 1
        parallel_for(own.begin, own.end, [&](int m) {
            real* const column = transposition_.column(m);
            const real along_x = sines != SinesAlong::x && m == 0 ? 1 : 0.5;  // FFTW doubles all except the constant
            if (first > 0) column[nz_ - 1] = 0;                               // the shortest sine has no matching cosine
            for (int n = first; n < nz_; ++n)
                column[n - first] = m + n == 0 ? 0 : along_x * (nz_ == 1 || n == 0 ? 1 : 0.5) * amplitude(m, n);
            transform_column(sines, m);
        });
        rows(sines, out, stride);
    }
    std::size_t bytes() const { return transposition_.bytes(); }

private:
    struct Plans;
    void transform_column(SinesAlong sines, int m);
    void rows(SinesAlong sines, real* out, std::size_t stride);

    int nx_, nz_;
    bool in_parts_;
    PlaneRange held_;
    Transposition<real> transposition_;
    std::unique_ptr<Plans> plans_;
};

}  // namespace weir::waves
