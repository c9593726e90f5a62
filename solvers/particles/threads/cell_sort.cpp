#include "particles/threads/cell_sort.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace weir::particles {

namespace {

/// Range of the coordinates begin .. end - 1, vectorized. Zero times a value that is not finite is NaN, which the trace detects.
Range range_of(const real* x, int begin, int end) {
    constexpr int lanes = 8;
    real lo[lanes], hi[lanes], trace[lanes];
    for (int l = 0; l < lanes; ++l) lo[l] = infinity, hi[l] = -infinity, trace[l] = 0;
    const auto meet = [&](int l, real here) {
        lo[l] = here < lo[l] ? here : lo[l];
        hi[l] = here > hi[l] ? here : hi[l];
        trace[l] += 0 * here;
    };
    int i = begin;
    for (; i + lanes <= end; i += lanes)
        for (int l = 0; l < lanes; ++l) meet(l, x[i + l]);
    for (; i < end; ++i) meet(0, x[i]);
    Range r;
    for (int l = 0; l < lanes; ++l) r = {std::min(r.lo, lo[l]), std::max(r.hi, hi[l]), r.finite && trace[l] == 0};
    return r;
}

/// parts: scratch, one range per thread.
Range range_of(const real* x, int count, std::vector<Range>& parts) {
    parts.resize(static_cast<std::size_t>(threads()));
    for_chunks(count, static_cast<int>(parts.size()),
               [&](int t, int begin, int end) { parts[static_cast<std::size_t>(t)] = range_of(x, begin, end); });
    Range all;
    for (const Range& r : parts) all = {std::min(all.lo, r.lo), std::max(all.hi, r.hi), all.finite && r.finite};
    return all;
}

}  // namespace

CellGrid cover_box(const Box& box, int count, real cell_size) {
    const real most = 1e6 + 8.0 * count;  // number of cells above which they take more memory than the particles
    CellGrid grid;
    grid.origin = box.lo;
    for (real size = cell_size;; size *= 1.26) {
        real cells = 1;
        for (std::size_t a = 0; a < 3; ++a) cells *= std::floor((box.hi[a] - box.lo[a]) / size) + 1;
        if (cells > most) continue;
        grid.per_cell = 1 / size;
        for (std::size_t a = 0; a < 3; ++a) grid.cells[a] = static_cast<int>(std::floor((box.hi[a] - box.lo[a]) * grid.per_cell)) + 1;
        return grid;
    }
}

Box CellSort::box(const Coordinates& x, int count, bool& finite) {
    Box box;
    finite = true;
    for (std::size_t a = 0; a < 3; ++a) {
        if (!x[a] || count == 0) continue;
        const Range r = range_of(x[a], count, ranges_);
        finite = finite && r.finite;
        box.lo[a] = r.lo;
        box.hi[a] = r.hi;
    }
    return box;
}

Box CellSort::box(const Coordinates& x, int count) {
    bool finite = true;
    const Box box = this->box(x, count, finite);
    if (!finite) throw NumericalFailure("position", "a particle's position is not finite");
    return box;
}

int CellSort::cell(const Coordinates& x, int i) const {
    std::array<real, 3> at = grid_.origin;
    for (std::size_t a = 0; a < 3; ++a)
        if (x[a]) at[a] = x[a][i];
    return cell_at(at);
}

int CellSort::cell_at(const std::array<real, 3>& x) const {
    int c = 0;
    for (std::size_t a = 3; a-- > 0;) {
        const int k = std::min(static_cast<int>((x[a] - grid_.origin[a]) * grid_.per_cell), grid_.cells[a] - 1);
        c = c * grid_.cells[a] + k;
    }
    return c;
}

/// cell() of particles begin .. end - 1, one axis at a time: vectorizable loops.
void CellSort::find_cells(const Coordinates& x, int begin, int end, int* c) const {
    std::fill(c + begin, c + end, 0);
    for (std::size_t a = 3; a-- > 0;) {
        if (!x[a]) continue;
        const real *along = x[a], origin = grid_.origin[a], per_cell = grid_.per_cell;
        const int n = grid_.cells[a];
        for (int i = begin; i < end; ++i) c[i] = c[i] * n + std::min(static_cast<int>((along[i] - origin) * per_cell), n - 1);
    }
}

void CellSort::list_cells(const Coordinates& x, int count, std::vector<int>& to) {
    to.resize(static_cast<std::size_t>(count));
    for_chunks(count, [&](int, int begin, int end) { find_cells(x, begin, end, to.data()); });
}

/// Converts the chunks' histograms to the first index of each chunk's particles in each cell, and fills the cell starts.
void CellSort::place_starts(int cells, int chunks) {
    before_.assign(static_cast<std::size_t>(chunks) + 1, 0);
    for_chunks(cells, chunks, [&](int t, int begin, int end) {
        int sum = 0;
        for (const auto& h : histograms_)
            for (int c = begin; c < end; ++c) sum += h[static_cast<std::size_t>(c)];
        before_[static_cast<std::size_t>(t) + 1] = sum;
    });
    for (std::size_t t = 0; t < static_cast<std::size_t>(chunks); ++t) before_[t + 1] += before_[t];
    for_chunks(cells, chunks, [&](int t, int begin, int end) {
        int at = before_[static_cast<std::size_t>(t)];
        for (int c = begin; c < end; ++c) {
            start_[static_cast<std::size_t>(c)] = at;
            for (auto& h : histograms_) {
                int& mine = h[static_cast<std::size_t>(c)];
                const int size = mine;
                mine = at;
                at += size;
            }
        }
    });
    start_[static_cast<std::size_t>(cells)] = before_.back();
}

void CellSort::sort(const Coordinates& x, int count, const CellGrid& grid) {
    sort(x, count, grid, 0, grid.cells[0] * grid.cells[1] * grid.cells[2]);
}

void CellSort::sort(const Coordinates& x, int count, const CellGrid& grid, int first, int last) {
    cover(grid);
    count_ = count, first_ = first;
    const bool all = last - first == grid.cells[0] * grid.cells[1] * grid.cells[2];
    const auto cells = static_cast<std::size_t>(last - first + (all ? 0 : 1));  // the last one contains all other cells
    const auto bin = [&](int cell) { return static_cast<std::size_t>(cell >= first && cell < last ? cell - first : last - first); };
    const int chunks = threads();
    order_.resize(static_cast<std::size_t>(count));
    cell_.resize(static_cast<std::size_t>(count));
    unsorted_.resize(static_cast<std::size_t>(count));
    if (start_.capacity() <= cells) start_.reserve(cells + cells / 2 + 1);  // grows by half, so spreading liquid rarely reallocates
    start_.resize(cells + 1);
    histograms_.resize(static_cast<std::size_t>(chunks));
    for_chunks(count, chunks, [&](int t, int begin, int end) {
        auto& histogram = histograms_[static_cast<std::size_t>(t)];
        if (histogram.capacity() < cells) histogram.reserve(cells + cells / 2);
        histogram.assign(cells, 0);
        find_cells(x, begin, end, unsorted_.data());
        for (int i = begin; i < end; ++i) ++histogram[bin(unsorted_[static_cast<std::size_t>(i)])];
    });
    place_starts(static_cast<int>(cells), chunks);
    for_chunks(count, chunks, [&](int t, int begin, int end) {
        auto& next = histograms_[static_cast<std::size_t>(t)];
        for (int i = begin; i < end; ++i) {
            const int c = unsorted_[static_cast<std::size_t>(i)];
            const auto to = static_cast<std::size_t>(next[bin(c)]++);
            order_[to] = i;
            cell_[to] = c;
        }
    });
    if (!all) start_.pop_back();
}

std::size_t CellSort::bytes() const {
    std::size_t ints = order_.capacity() + cell_.capacity() + start_.capacity() + unsorted_.capacity();
    for (const auto& h : histograms_) ints += h.capacity();
    return ints * sizeof(int);
}

}  // namespace weir::particles
