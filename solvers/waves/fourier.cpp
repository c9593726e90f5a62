#include "waves/fourier.hpp"

#include <fftw3.h>

#include <algorithm>

namespace weir::waves {

namespace {

/// Rows are padded to whole cache lines, so that all are aligned as the one that was planned with.
std::size_t padded(int n) { return (static_cast<std::size_t>(n) + 3) / 4 * 4; }
constexpr int block = 8;  // rows that are gathered from the columns together

fftw_complex* as_fftw(Complex* at) { return reinterpret_cast<fftw_complex*>(at); }

struct Free {
    void operator()(void* at) const { fftw_free(at); }
};
using Buffer = std::unique_ptr<Complex, Free>;
Buffer buffer(std::size_t count) {
    Buffer made(reinterpret_cast<Complex*>(fftw_alloc_complex(count)));
    std::fill_n(made.get(), count, Complex{});
    return made;
}

}  // namespace

/// FFTW_ESTIMATE: measured plans would differ from run to run, and so would the last bits of the answer.
struct Synthesis::Plans {
    std::size_t column_length, row_length;
    Buffer columns, rows;
    fftw_plan column = nullptr, row = nullptr;
    explicit Plans(const HalfPlane& p)
        : column_length(padded(p.nz)),
          row_length(padded(p.columns())),
          columns(buffer(column_length * static_cast<std::size_t>(p.columns()))),
          rows(buffer(row_length * static_cast<std::size_t>(p.nz))) {
        fftw_complex* one = as_fftw(columns.get());
        if (p.nz > 1) column = fftw_plan_dft_1d(p.nz, one, one, FFTW_BACKWARD, FFTW_ESTIMATE);
        row = fftw_plan_dft_c2r_1d(p.nx, as_fftw(rows.get()), reinterpret_cast<real*>(rows.get()), FFTW_ESTIMATE);
    }
    ~Plans() {
        if (column) fftw_destroy_plan(column);
        fftw_destroy_plan(row);
    }
};

Synthesis::Synthesis(const HalfPlane& plane) : plane_(plane), plans_(std::make_unique<Plans>(plane)) {}
Synthesis::~Synthesis() = default;

Complex* Synthesis::column_at(int m) const { return plans_->columns.get() + static_cast<std::size_t>(m) * plans_->column_length; }

void Synthesis::transform_column(int m) {
    if (plans_->column) fftw_execute_dft(plans_->column, as_fftw(column_at(m)), as_fftw(column_at(m)));
}

void Synthesis::rows(real* out, std::size_t stride) {
    const int blocks = (plane_.nz + block - 1) / block, columns = plane_.columns();
    const auto nx = static_cast<std::size_t>(plane_.nx);
    parallel_for(0, blocks, [&](int b) {
        const int first = b * block, last = std::min(plane_.nz, first + block);
        const auto row_at = [&](int n) { return plans_->rows.get() + static_cast<std::size_t>(n) * plans_->row_length; };
        for (int m = 0; m < columns; ++m) {
            const Complex* from = column_at(m);
            for (int n = first; n < last; ++n) row_at(n)[m] = from[n];
        }
        for (int n = first; n < last; ++n) {
            real* values = reinterpret_cast<real*>(row_at(n));
            fftw_execute_dft_c2r(plans_->row, as_fftw(row_at(n)), values);
            std::copy_n(values, nx, out + static_cast<std::size_t>(n) * stride);
        }
    });
}

std::size_t Synthesis::bytes() const {
    return (plans_->column_length * static_cast<std::size_t>(plane_.columns()) + plans_->row_length * static_cast<std::size_t>(plane_.nz)) *
           sizeof(Complex);
}

}  // namespace weir::waves
