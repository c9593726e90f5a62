// From natural rows to the packed arrays of a level.
#pragma once
#include "poisson/geometric/face_rows.hpp"

namespace weir::poisson {

/// Spans, counts or weights, 1/diagonal and plain rows of the finest level.
template <int D>
void pack_finest(Level<D>& level, const Natural<D>& problem);

/// The same of a coarse level, whose natural rows are stored.
template <int D>
void pack_coarse(Level<D>& level, bool threaded);

/// Zeros where no sweep writes: outside the spans of each row.
template <int D>
void clear_gaps(const Level<D>& level, float* vector);

/// even[m] = row[2m], odd[m] = row[2m + 1] for a row of n cells; entries past the end are zero.
template <class From, class To>
void split(const From* row, int n, int width, To* even, To* odd) {
    const int pairs = n / 2;
    for (int m = 0; m < pairs; ++m) {
        even[m] = static_cast<To>(row[2 * m]);
        odd[m] = static_cast<To>(row[2 * m + 1]);
    }
    if (pairs < width) {
        even[pairs] = static_cast<To>(row[2 * pairs]);
        odd[pairs] = To{};
    }
}

/// The reverse: row[2m] = even[m], row[2m + 1] = odd[m].
template <class T>
void merge(const T* even, const T* odd, int n, T* row) {
    for (int m = 0; m < n / 2; ++m) {
        row[2 * m] = even[m];
        row[2 * m + 1] = odd[m];
    }
    if (n % 2 == 1) row[n - 1] = even[n / 2];
}

}  // namespace weir::poisson
