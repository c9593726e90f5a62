#include "waves/cosines.hpp"

#include <fftw3.h>

#include <algorithm>

namespace weir::waves {

/// FFTW_ESTIMATE: measured plans would differ between runs. Rows are transformed in place of use, which is not aligned.
struct Cosines::Plans {
    struct Axis {
        fftw_plan forth = nullptr, cosines = nullptr, sines = nullptr;
        Axis(int n, real* line, unsigned flags) {
            const auto plan = [&](fftw_r2r_kind kind) { return fftw_plan_r2r_1d(n, line, line, kind, FFTW_ESTIMATE | flags); };
            forth = plan(FFTW_REDFT10), cosines = plan(FFTW_REDFT01), sines = plan(FFTW_RODFT01);
        }
        ~Axis() {
            for (const fftw_plan p : {forth, cosines, sines}) fftw_destroy_plan(p);
        }
        Axis(const Axis&) = delete;
        Axis& operator=(const Axis&) = delete;
    };
    Aligned<real> line;  // for planning
    Axis row, column;
    Plans(int nx, int nz)
        : line(aligned<real>(static_cast<std::size_t>(std::max(nx, nz)))), row(nx, line.get(), FFTW_UNALIGNED), column(nz, line.get(), 0) {
        line.reset();
    }
};

Cosines::Cosines(int nx, int nz, const OwnPlanes& rows)
    : nx_(nx),
      nz_(nz),
      in_parts_(rows.distributed_storage()),
      held_(held_columns(nx, rows)),
      transposition_(nx, nz, rows),
      plans_(std::make_unique<Plans>(nx, nz)) {}
Cosines::~Cosines() = default;

/// FFTW's DCT-II is twice the sum over points; a mode's amplitude is twice its mean, except for the constant.
std::vector<real> Cosines::analyse(Values& field) {
    const auto row_at = [&](int k) { return field.data() + static_cast<std::ptrdiff_t>(k) * nx_; };
    const PlaneRange rows = transposition_.own_rows(), columns = transposition_.own_columns();
    parallel_for(rows.begin, rows.end, [&](int k) { fftw_execute_r2r(plans_->row.forth, row_at(k), row_at(k)); });
    transposition_.to_columns(row_at);
    std::vector<real> amplitudes(size());
    const real scale = 1.0 / nx_ / nz_;
    parallel_for(columns.begin, columns.end, [&](int m) {
        real* const column = transposition_.column(m);
        if (nz_ > 1) fftw_execute_r2r(plans_->column.forth, column, column);
        for (int n = 0; n < nz_; ++n) amplitudes[at(m, n)] = (m == 0 ? 0.5 : 1) * (nz_ > 1 ? (n == 0 ? 0.5 : 1) : 1) * scale * column[n];
    });
    if (const OwnPlanes& own = transposition_.columns(); own.distributed() && !in_parts_)
        communicator().gather(own.partition(), {amplitudes.data(), sizeof(real) * static_cast<std::size_t>(nz_), nx_});
    return amplitudes;
}

void Cosines::transform_column(SinesAlong sines, int m) {
    if (nz_ == 1) return;
    real* const column = transposition_.column(m);
    fftw_execute_r2r(sines == SinesAlong::z ? plans_->column.sines : plans_->column.cosines, column, column);
}

void Cosines::rows(SinesAlong sines, real* out, std::size_t stride) {
    const auto row_at = [&](int k) { return out + static_cast<std::size_t>(k) * stride; };
    const bool along_x = sines == SinesAlong::x;
    transposition_.to_rows(row_at, [&](int k) {
        real* const row = row_at(k);
        if (along_x) std::copy(row + 1, row + nx_, row), row[nx_ - 1] = 0;  // a row of sines begins with number 1
        fftw_execute_r2r(along_x ? plans_->row.sines : plans_->row.cosines, row, row);
    });
}

}  // namespace weir::waves
