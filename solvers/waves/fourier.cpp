#include "waves/fourier.hpp"

#include <fftw3.h>

#include <algorithm>

namespace weir::waves {

namespace {

fftw_complex* as_fftw(Complex* at) { return reinterpret_cast<fftw_complex*>(at); }

}  // namespace

/// FFTW_ESTIMATE: measured plans would differ between runs, and so would the last bits of the result.
struct Synthesis::Plans {
    PlaneRange held;  // of the field's rows
    std::size_t row_length, row_count;
    Aligned<Complex> rows;
    fftw_plan column = nullptr, row = nullptr;
    Plans(const HalfPlane& p, const PlaneRange& of_rows, Complex* a_column)
        : held(of_rows),
          row_length(padded(p.columns())),
          row_count(static_cast<std::size_t>(held.end - held.begin)),
          rows(aligned<Complex>(row_length * row_count)) {
        if (p.nz > 1) column = fftw_plan_dft_1d(p.nz, as_fftw(a_column), as_fftw(a_column), FFTW_BACKWARD, FFTW_ESTIMATE);
        row = fftw_plan_dft_c2r_1d(p.nx, as_fftw(rows.get()), reinterpret_cast<real*>(rows.get()), FFTW_ESTIMATE);
    }
    ~Plans() {
        if (column) fftw_destroy_plan(column);
        fftw_destroy_plan(row);
    }
};

HalfPlane Synthesis::held_plane(int nx, int nz, const OwnPlanes& rows) {
    HalfPlane plane{nx, nz};
    plane.held = held_columns(plane.columns(), rows);
    return plane;
}

Synthesis::Synthesis(const HalfPlane& plane, const OwnPlanes& rows)
    : plane_(plane),
      transposition_(plane.columns(), plane.nz, rows),
      plans_(std::make_unique<Plans>(plane, transposition_.own_rows(), transposition_.column(plane.held.begin))) {}
Synthesis::~Synthesis() = default;

void Synthesis::transform_column(int m) {
    Complex* const at = transposition_.column(m);
    if (plans_->column) fftw_execute_dft(plans_->column, as_fftw(at), as_fftw(at));
}

void Synthesis::rows(real* out, std::size_t stride) {
    const auto row_at = [&](int n) { return plans_->rows.get() + static_cast<std::size_t>(n - plans_->held.begin) * plans_->row_length; };
    transposition_.to_rows(row_at, [&](int n) {
        real* values = reinterpret_cast<real*>(row_at(n));
        fftw_execute_dft_c2r(plans_->row, as_fftw(row_at(n)), values);
        std::copy_n(values, static_cast<std::size_t>(plane_.nx), out + static_cast<std::size_t>(n) * stride);
    });
}

std::size_t Synthesis::bytes() const { return transposition_.bytes() + plans_->row_length * plans_->row_count * sizeof(Complex); }

}  // namespace weir::waves
