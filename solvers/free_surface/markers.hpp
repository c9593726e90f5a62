// Marker particles: they mark the fluid region (Harlow & Welch 1965) and, for PIC, FLIP and APIC, carry its momentum. Stored as arrays by
// component, sorted by cell after every motion: all transfers between markers and grid use this fixed order.
#pragma once
#include "core/parallel.hpp"
#include "core/types.hpp"
#include "free_surface/frame.hpp"
#include "parallel/plane_store.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace weir::free_surface {

/// Repeatable random numbers in [0, 1): a hash (SplitMix64, Steele et al. 2014) of a seed and some integers, without state.
real hashed_random(std::uint64_t seed, std::uint64_t a, std::uint64_t b);

template <int D>
class Markers {
public:
    static constexpr int per_cell = D == 2 ? 4 : 8;  // one in each half cell along every axis

    std::array<std::vector<real>, D> x;      // position [m]
    std::array<std::vector<real>, D> v;      // velocity [m/s]; empty where the transfer stores no momentum on markers
    std::array<std::vector<real>, D * D> c;  // velocity gradient c[a D + d] = ∂v_a/∂x_d [1/s]; only for APIC
    real volume = 0;                         // of one marker [m^D]

    Markers() = default;
    Markers(bool carries_velocity, bool carries_gradient) : carries_velocity_(carries_velocity), carries_gradient_(carries_gradient) {}

    std::size_t count() const { return x[0].size(); }
    bool carries_velocity() const { return carries_velocity_; }
    bool carries_gradient() const { return carries_gradient_; }
    Vec<D> position(std::size_t p) const {
        Vec<D> at;
        for (int d = 0; d < D; ++d) at[d] = x[static_cast<std::size_t>(d)][p];
        return at;
    }
    void set_position(std::size_t p, const Vec<D>& at) {
        for (int d = 0; d < D; ++d) x[static_cast<std::size_t>(d)][p] = at[d];
    }
    void add(const Vec<D>& at, const Vec<D>& velocity);
    /// The jittered position of marker `sub` of a cell. Cells mirrored about the middle of the domain get mirrored positions.
    static Vec<D> jittered(const Frame<D>& frame, const Index<D>& I, int sub, std::uint64_t seed);
    /// Keeps the markers for which keep(p) is true; the order is kept.
    template <class Keep>
    void retain(Keep&& keep);

    /// In parallel each rank stores the markers of its own planes of cells and ghost markers of one plane on each side, which contribute to
    /// the same faces.
    static bool holds(const Frame<D>& frame, int rank, int plane);
    /// The same for this rank; in one process true.
    static bool holds(const Frame<D>& frame, int plane) {
        return !frame.own().distributed() || holds(frame, frame.own().slab->rank(), plane);
    }
    /// Keeps, of all markers, those that this rank stores.
    void keep_held(const Frame<D>& frame);
    /// Migration after motion: every rank receives the markers that it stores now. Each rank sends its own in their order and receives in
    /// rank order, so that the stable sort gives the order of one process. Markers beyond the domain are removed if `leave`. Returns the
    /// number of this rank's own markers before, and of those that left.
    std::array<std::int64_t, 2> migrate(const Frame<D>& frame, bool leave);
    /// The same for an arbitrary distribution of all markers over the ranks, in rank order: parts of a file. Sorts.
    void deal(const Frame<D>& frame);
    /// Gathers the markers of all ranks in `all`, in the sorted order of one process.
    void gather(const Frame<D>& frame, Markers& all) const;
    /// The markers of this rank's own planes: [first, second). Sorted.
    std::pair<std::size_t, std::size_t> own(const Frame<D>& frame) const { return within(frame.own(), frame); }
    /// The markers of these planes.
    std::pair<std::size_t, std::size_t> within(const OwnPlanes& planes, const Frame<D>& frame) const {
        const int lo = planes.lower(0), hi = planes.upper(frame.cells[D - 1]);
        return {plane_start_[static_cast<std::size_t>(lo)], plane_start_[static_cast<std::size_t>(hi)]};
    }

    /// Stable sort by cell, x fastest. Afterwards the markers of cell I are begin(I) .. end(I), in the stored planes.
    void sort(const Frame<D>& frame);
    std::size_t begin(std::size_t cell) const { return static_cast<std::size_t>(cell_start_.data()[cell]); }
    std::size_t end(std::size_t cell) const { return static_cast<std::size_t>(cell_start_.data()[cell + 1]); }
    /// The cell that contains marker p.
    std::size_t cell_with(std::size_t p) const;
    /// f(I, begin, end) for each cell of this rank's own planes that contains markers, after sort(); threaded by equal numbers of markers.
    template <class F>
    void for_each_occupied_cell(const Frame<D>& frame, F&& f) const {
        for_each_occupied_cell(frame.own(), frame, f);
    }
    /// The same for all stored planes, those of ghost markers included.
    template <class F>
    void for_each_held_cell(const Frame<D>& frame, F&& f) const {
        for_each_occupied_cell(OwnPlanes(), frame, f);
    }
    /// The same for the cells [from, to) in memory, serially.
    template <class F>
    void for_occupied_cells(const Frame<D>& frame, std::size_t from, std::size_t to, F&& f) const;
    /// The part of a row of cells along x that contains markers; `row`: index of the row.
    const Segment& in_row(std::size_t row) const { return rows_[row]; }
    int in_cell(std::size_t cell) const { return cell_start_.data()[cell + 1] - cell_start_.data()[cell]; }

    /// f(array) for every array with one value per marker.
    template <class F>
    void for_each_array(F&& f);
    template <class F>
    void for_each_array(F&& f) const {
        const_cast<Markers*>(this)->for_each_array([&](const std::vector<real>& array) { f(array); });
    }
    void reserve(std::size_t capacity);
    /// Reduces the capacity to an eighth more than the size.
    void trim();
    std::size_t bytes() const;

private:
    template <class F>
    void for_each_occupied_cell(const OwnPlanes& planes, const Frame<D>& frame, F&& f) const;
    void find_cells(const Frame<D>& frame, int first, int last);
    void find_plane_starts(const Frame<D>& frame);
    std::size_t first_cell_from(std::size_t least) const;
    void find_rows(const Frame<D>& frame);
    void find_holders(const Frame<D>& frame);
    std::int64_t find_going(const Frame<D>& frame, std::size_t first, std::size_t last, bool leave);
    std::int64_t exchange(const Frame<D>& frame, std::size_t first, std::size_t last, bool leave);

    bool carries_velocity_ = false, carries_gradient_ = false;
    std::vector<int> cell_, from_;
    PlaneStore<int> cell_start_;            // with two extra entries at its end; in parallel, of the planes whose markers are stored
    std::vector<std::size_t> plane_start_;  // number of markers before each plane
    std::size_t plane_ = 0;                 // cells per plane
    std::vector<Segment> rows_;
    std::vector<real> scratch_;
    // in parallel: ranks that store each plane's markers, markers to send to each rank, markers to remove, message buffers, array by array
    std::vector<std::vector<int>> holders_, going_;
    std::vector<int> gone_, table_;
    std::vector<std::size_t> table_rows_;
    std::vector<std::vector<real>> sent_, received_;
    std::vector<Message> messages_;
};

template <int D>
template <class F>
void Markers<D>::for_each_array(F&& f) {
    for (auto& array : x) f(array);
    if (carries_velocity_)
        for (auto& array : v) f(array);
    if (carries_gradient_)
        for (auto& array : c) f(array);
}

template <int D>
template <class F>
void Markers<D>::for_each_occupied_cell(const OwnPlanes& planes, const Frame<D>& frame, F&& f) const {
    constexpr int blocks = 64;
    const auto [first, last] = within(planes, frame);
    const auto first_cell = [&, begin = first, count = last - first](int block) {
        return first_cell_from(begin + count * static_cast<std::size_t>(block) / blocks);
    };
    parallel_for(0, blocks, [&](int block) { for_occupied_cells(frame, first_cell(block), first_cell(block + 1), f); });
}

template <int D>
template <class F>
void Markers<D>::for_occupied_cells(const Frame<D>& frame, std::size_t from, std::size_t to, F&& f) const {
    const auto n = static_cast<std::size_t>(frame.cells[0]);
    for (std::size_t cell = from; cell < to;) {
        const std::size_t row = cell / n, first = row * n, next = std::min(first + n, to);
        const std::size_t last = std::min(next, first + static_cast<std::size_t>(rows_[row].end));
        cell = std::max(cell, first + static_cast<std::size_t>(rows_[row].begin));
        if (cell < last) {
            Index<D> I = frame.index_of(cell);
            for (; cell < last; ++cell, ++I[0])
                if (begin(cell) < end(cell)) f(I, begin(cell), end(cell));
        }
        cell = next;
    }
}

template <int D>
template <class Keep>
void Markers<D>::retain(Keep&& keep) {
    std::size_t kept = 0;
    const std::size_t n = count();
    for (std::size_t p = 0; p < n; ++p) {
        if (!keep(p)) continue;
        if (kept != p) for_each_array([&](std::vector<real>& array) { array[kept] = array[p]; });
        ++kept;
    }
    for_each_array([&](std::vector<real>& array) { array.resize(kept); });
}

}  // namespace weir::free_surface
