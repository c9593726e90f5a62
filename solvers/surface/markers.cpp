#include "surface/markers.hpp"

#include "core/parallel.hpp"
#include "surface/marker_lanes.hpp"

namespace weir::surface {

real hashed_random(std::uint64_t seed, std::uint64_t a, std::uint64_t b) {
    std::uint64_t z = seed * 0x9E3779B97F4A7C15u + a * 0xBF58476D1CE4E5B9u + b * 0x94D049BB133111EBu;
    for (int round = 0; round < 2; ++round) {
        z += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        z ^= z >> 31;
    }
    return static_cast<real>(z >> 11) * 0x1.0p-53;
}

template <int D>
Vec<D> Markers<D>::jittered(const Frame<D>& frame, const Index<D>& I, int sub, std::uint64_t seed) {
    std::array<int, D> half{}, mirrored{};
    std::uint64_t key = 0;
    for (int d = 0; d < D; ++d) {
        const auto at = static_cast<std::size_t>(d);
        const int n = 2 * frame.cells[d];
        half[at] = 2 * I[d] + ((sub >> d) & 1);
        mirrored[at] = half[at] >= frame.cells[d];
        key = key * 0x100000001B3u + static_cast<std::uint64_t>(mirrored[at] ? n - 1 - half[at] : half[at]);
    }
    Vec<D> x;
    for (int d = 0; d < D; ++d) {
        const auto at = static_cast<std::size_t>(d);
        const real r = hashed_random(seed, key, at);
        x[d] = frame.origin[d] + 0.5 * frame.h[d] * (half[at] + (mirrored[at] ? 1 - r : r));
    }
    return x;
}

template <int D>
void Markers<D>::add(const Vec<D>& at, const Vec<D>& velocity) {
    for (int d = 0; d < D; ++d) {
        const auto a = static_cast<std::size_t>(d);
        x[a].push_back(at[d]);
        if (carries_velocity_) v[a].push_back(velocity[d]);
    }
    if (carries_gradient_)
        for (auto& array : c) array.push_back(0);
}

namespace {

/// f(first, last) on blocks of [0, count).
template <class F>
void for_each_block(int count, F&& f) {
    constexpr int block = 4096;
    parallel_for(0, (count + block - 1) / block, [&](int b) { f(b * block, std::min((b + 1) * block, count)); });
}

}  // namespace

/// As Frame::cell_of, for many; what would be rounded down to less than 0 is 0 anyway, so that rounding towards 0 does.
template <int D>
void Markers<D>::find_cells(const Frame<D>& frame, int first, int last) {
    using Cells = std::int32_t __attribute__((vector_size(sizeof(std::int32_t) * marker_lanes)));
    for (int p = first; p < last; p += marker_lanes) {
        const int count = std::min(marker_lanes, last - p);
        const LaneVec<D> at = load_positions(*this, static_cast<std::size_t>(p), count);
        Cells cell{};
        for (int d = D - 1; d >= 0; --d) {
            const Lanes s = (at[static_cast<std::size_t>(d)] - frame.origin[d]) * frame.inv_h[d];
            const Cells i = __builtin_convertvector(s, Cells), lowest{}, highest = lowest + (frame.cells[d] - 1);
            const Cells least = i < lowest ? lowest : i;
            cell = cell * frame.cells[d] + (least > highest ? highest : least);
        }
        std::memcpy(cell_.data() + p, &cell, static_cast<std::size_t>(count) * sizeof(std::int32_t));
    }
}

template <int D>
void Markers<D>::sort(const Frame<D>& frame) {
    const int n = static_cast<int>(count());
    const std::size_t cells = product(frame.cells);
    cell_.resize(static_cast<std::size_t>(n));
    from_.resize(static_cast<std::size_t>(n));
    scratch_.resize(static_cast<std::size_t>(n));
    cell_start_.assign(cells + 2, 0);
    for_each_block(n, [&](int first, int last) { find_cells(frame, first, last); });
    for (const int cell : cell_) ++cell_start_[static_cast<std::size_t>(cell) + 2];
    for (std::size_t i = 2; i <= cells; ++i) cell_start_[i] += cell_start_[i - 1];
    for (int p = 0; p < n; ++p)  // the next free place of a cell is the start of the one behind it, until that is its own
        from_[static_cast<std::size_t>(cell_start_[static_cast<std::size_t>(cell_[static_cast<std::size_t>(p)]) + 1]++)] = p;
    cell_start_.pop_back();
    find_rows(frame);
    for_each_array([&](std::vector<real>& array) {
        for_each_block(n, [&](int first, int last) {
            const int* from = from_.data();
            const real* old = array.data();
            real* sorted = scratch_.data();
            for (int p = first; p < last; p += 8) {
                __builtin_prefetch(old + std::min(p + 8192, n), 0, 2);
                for (int q = p; q < std::min(p + 8, last); ++q) sorted[q] = old[from[q]];
            }
        });
        array.swap(scratch_);
    });
}

template <int D>
void Markers<D>::find_rows(const Frame<D>& frame) {
    const auto n = static_cast<std::size_t>(frame.cells[0]);
    rows_.resize(product(frame.cells) / n);
    parallel_for(0, static_cast<int>(rows_.size()), [&](int row) {
        const auto first = cell_start_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * n);
        const auto last = first + static_cast<std::ptrdiff_t>(n);
        Extent& extent = rows_[static_cast<std::size_t>(row)] = {frame.cells[0], 0};
        if (*first == *last) return;
        extent.begin = static_cast<int>(std::upper_bound(first, last, *first) - first) - 1;
        extent.end = static_cast<int>(std::lower_bound(first, last, *last) - first);
    });
}

template <int D>
void Markers<D>::reserve(std::size_t capacity) {
    for_each_array([&](std::vector<real>& array) { array.reserve(capacity); });
    scratch_.reserve(capacity);
    cell_.reserve(capacity);
    from_.reserve(capacity);
}

template <int D>
std::size_t Markers<D>::bytes() const {
    std::size_t total = (cell_.capacity() + from_.capacity() + cell_start_.capacity()) * sizeof(int) + rows_.capacity() * sizeof(Extent) +
                        scratch_.capacity() * sizeof(real);
    for_each_array([&](const std::vector<real>& array) { total += array.capacity() * sizeof(real); });
    return total;
}

template class Markers<2>;
template class Markers<3>;

}  // namespace weir::surface
