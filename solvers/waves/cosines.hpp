// A field at the middles of cells as a series of cosines along both axes, and of sines along one (FFTW: DCT-II there, DCT-III and DST-III
// back), columns and rows each with one plan: no bit depends on threads or ranks.
//
//     out(i, k) = sum over m, n of a(m, n) cos(m pi (i + 1/2) / nx) cos(n pi (k + 1/2) / nz)
#pragma once
#include "waves/sheet.hpp"
#include "waves/transposition.hpp"

namespace weir::waves {

class Cosines {
public:
    enum class SinesAlong { none, x, z };  // in place of the cosines along this axis

    Cosines(int nx, int nz);
    ~Cosines();
    Cosines(const Cosines&) = delete;
    Cosines& operator=(const Cosines&) = delete;

    /// Which columns m of modes this rank stores, n fastest; and whether others store the rest.
    const PlaneRange& held() const { return held_; }
    bool in_parts() const { return in_parts_; }
    std::size_t size() const { return static_cast<std::size_t>(held_.end - held_.begin) * static_cast<std::size_t>(nz_); }
    std::size_t at(int m, int n) const {
        return static_cast<std::size_t>(m - held_.begin) * static_cast<std::size_t>(nz_) + static_cast<std::size_t>(n);
    }

    /// The amplitudes of a field on the sheet, whose rows are lost in it: of the stored modes.
    std::vector<real> analyse(Values& field);
    /// amplitude(m, n) of every mode but the constant one, which is 0; row k of the field goes to out + k stride, of own rows.
    template <class F>
    void operator()(SinesAlong sines, const F& amplitude, real* out, std::size_t stride) {
        const PlaneRange own = transposition_.own_columns();
        const int first = sines == SinesAlong::z ? 1 : 0;  // a column of sines begins with number 1
        parallel_for(own.begin, own.end, [&](int m) {
            real* const column = transposition_.column(m);
            const real along_x = sines != SinesAlong::x && m == 0 ? 1 : 0.5;  // FFTW doubles all but the constant
            if (first > 0) column[nz_ - 1] = 0;                               // the shortest sine is of no cosine
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
