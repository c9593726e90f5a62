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
    PlaneRange held;  // of the field's rows
    std::size_t column_length, row_length, column_count, row_count;
    Buffer columns, rows;
    fftw_plan column = nullptr, row = nullptr;
    Plans(const HalfPlane& p, const PlaneRange& of_rows)
        : held(of_rows),
          column_length(padded(p.nz)),
          row_length(padded(p.columns())),
          column_count(static_cast<std::size_t>(std::max(1, p.held.end - p.held.begin))),
          row_count(static_cast<std::size_t>(held.end - held.begin)),
          columns(buffer(column_length * column_count)),
          rows(buffer(row_length * row_count)) {
        fftw_complex* one = as_fftw(columns.get());
        if (p.nz > 1) column = fftw_plan_dft_1d(p.nz, one, one, FFTW_BACKWARD, FFTW_ESTIMATE);
        row = fftw_plan_dft_c2r_1d(p.nx, as_fftw(rows.get()), reinterpret_cast<real*>(rows.get()), FFTW_ESTIMATE);
    }
    ~Plans() {
        if (column) fftw_destroy_plan(column);
        fftw_destroy_plan(row);
    }
};

HalfPlane Synthesis::held_plane(int nx, int nz) {
    HalfPlane plane{nx, nz};
    if (!over_ranks() || detail::own_share.kept == 0 || nz == 1) return plane;
    const Cut cut = cut_of_columns(plane, slabs().ranks());
    plane.held = {cut.begin(slabs().rank()), cut.end(slabs().rank(), plane.columns())};
    return plane;
}

Synthesis::Synthesis(const HalfPlane& plane)
    : plane_(plane),
      by_column_(cut_of_columns(plane, slabs().ranks())),
      plans_(std::make_unique<Plans>(plane, plane.whole() ? PlaneRange{0, plane.nz} : own_rows())) {}
Synthesis::~Synthesis() = default;

Complex* Synthesis::column_at(int m) const {
    return plans_->columns.get() + static_cast<std::size_t>(m - plane_.held.begin) * plans_->column_length;
}

/// Of column m the values of this rank's rows: its own columns are here, those of others have come in blocks, in their order.
const Complex* Synthesis::own_rows_of(int m) const {
    const PlaneRange rows = own_rows(), columns = own_columns();
    if (m >= columns.begin && m < columns.end) return column_at(m) + rows.begin;
    const int before = m < columns.begin ? m : m - (columns.end - columns.begin);
    return given_.data() + static_cast<std::size_t>(before) * static_cast<std::size_t>(rows.end - rows.begin);
}

void Synthesis::transform_column(int m) {
    if (plans_->column) fftw_execute_dft(plans_->column, as_fftw(column_at(m)), as_fftw(column_at(m)));
}

/// To each rank goes the part of its rows in this rank's columns, a column after the other.
void Synthesis::transpose() {
    const Cut& by_row = *detail::own_share.cut;
    const int rank = slabs().rank(), ranks = by_row.ranks();
    const auto rows_of = [&](int r) { return PlaneRange{by_row.begin(r), by_row.end(r, plane_.nz)}; };
    const PlaneRange columns = columns_of(rank), rows = own_rows();
    const auto count = [](const PlaneRange& a, const PlaneRange& b) {
        return static_cast<std::size_t>(a.end - a.begin) * static_cast<std::size_t>(b.end - b.begin);
    };
    sent_.resize(count(columns, {0, plane_.nz}) - count(columns, rows));
    given_.resize(count({0, plane_.columns()}, rows) - count(columns, rows));
    std::vector<Parcel> parcels;
    std::size_t out = 0, in = 0;
    for (int peer = 0; peer < ranks; ++peer) {
        if (peer == rank) continue;
        const PlaneRange theirs = rows_of(peer);
        const auto each = static_cast<std::size_t>(theirs.end - theirs.begin);
        parallel_for(columns.begin, columns.end, [&](int m) {
            std::copy_n(column_at(m) + theirs.begin, each, sent_.data() + out + each * static_cast<std::size_t>(m - columns.begin));
        });
        const std::size_t sends = count(columns, theirs), gets = count(columns_of(peer), rows);
        parcels.push_back({peer, sent_.data() + out, sends * sizeof(Complex), given_.data() + in, gets * sizeof(Complex)});
        out += sends, in += gets;
    }
    slabs().trade(parcels);
}

void Synthesis::rows(real* out, std::size_t stride) {
    const PlaneRange own = own_rows();
    const int blocks = (own.end - own.begin + block - 1) / block, columns = plane_.columns();
    const auto nx = static_cast<std::size_t>(plane_.nx);
    parallel_for(0, blocks, [&](int b) {
        const int first = own.begin + b * block, last = std::min(own.end, first + block);
        const auto row_at = [&](int n) {
            return plans_->rows.get() + static_cast<std::size_t>(n - plans_->held.begin) * plans_->row_length;
        };
        for (int m = 0; m < columns; ++m) {
            const Complex* from = own_rows_of(m);
            for (int n = first; n < last; ++n) row_at(n)[m] = from[n - own.begin];
        }
        for (int n = first; n < last; ++n) {
            real* values = reinterpret_cast<real*>(row_at(n));
            fftw_execute_dft_c2r(plans_->row, as_fftw(row_at(n)), values);
            std::copy_n(values, nx, out + static_cast<std::size_t>(n) * stride);
        }
    });
}

std::size_t Synthesis::bytes() const {
    return (plans_->column_length * plans_->column_count + plans_->row_length * plans_->row_count) * sizeof(Complex) +
           (sent_.capacity() + given_.capacity()) * sizeof(Complex);
}

}  // namespace weir::waves
