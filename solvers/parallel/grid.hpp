// A dense array over a box of cells, x fastest, and the loops over it. Loops are threaded over the slowest axis. A sum is the
// exact sum of those of its planes, so results do not depend on the number of threads or ranks. Which planes are this rank's comes from
// the extent (parallel/slab.hpp).
#pragma once
#include "core/parallel.hpp"
#include "core/types.hpp"
#include "parallel/communicator.hpp"
#include "parallel/plane_store.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace weir {

/// Values of type T on a box of `extent` entries. Entry (i, j, k) is at i + n_x (j + n_y k).
template <class T, int D>
class Grid {
public:
    Grid() = default;
    /// `margin`: number of extra planes before the first and after the last plane of cells.
    explicit Grid(const Extent<D>& extent, const T& value = T{}, int margin = 0)
        : extent_(extent), data_(extent.own.slab, 0, plane_of(extent), extent[D - 1] - 2 * margin, margin, value) {}

    /// With the planes of this rank: loops and reductions over it are distributed like the grid.
    const Extent<D>& extent() const { return extent_; }
    const OwnPlanes& own() const { return extent_.own; }
    std::size_t size() const { return data_.size(); }
    bool empty() const { return data_.size() == 0; }
    /// Distance in memory between neighbours along an axis, in entries.
    std::ptrdiff_t stride(int axis) const {
        std::ptrdiff_t s = 1;
        for (int d = 0; d < axis; ++d) s *= extent_[d];
        return s;
    }
    std::size_t linear(const Index<D>& I) const {
        std::size_t at = 0;
        for (int d = D - 1; d >= 0; --d) at = at * static_cast<std::size_t>(extent_[d]) + static_cast<std::size_t>(I[d]);
        return at;
    }
    bool contains(const Index<D>& I) const {
        for (int d = 0; d < D; ++d)
            if (I[d] < 0 || I[d] >= extent_[d]) return false;
        return true;
    }
    T& operator()(const Index<D>& I) { return data_.data()[linear(I)]; }
    const T& operator()(const Index<D>& I) const { return data_.data()[linear(I)]; }
    T& operator[](std::size_t i) { return data_.data()[i]; }
    const T& operator[](std::size_t i) const { return data_.data()[i]; }
    T* data() { return data_.data(); }
    const T* data() const { return data_.data(); }
    std::span<const T> values() const { return {data_.data(), data_.size()}; }
    std::span<T> values() { return {data_.data(), data_.size()}; }
    void fill(const T& value) { data_.fill(value); }
    std::size_t bytes() const { return data_.bytes(); }
    /// The planes in this rank's memory, own and ghost: see PlaneStore.
    const PlaneStore<T>& store() const { return data_; }
    PlaneStore<T>& store() { return data_; }
    void swap(Grid& other) {
        std::swap(extent_, other.extent_);
        data_.swap(other.data_);
    }

private:
    static std::size_t plane_of(const Index<D>& extent) {
        std::size_t entries = 1;
        for (int d = 0; d + 1 < D; ++d) entries *= static_cast<std::size_t>(extent[d]);
        return entries;
    }
    Extent<D> extent_;
    PlaneStore<T> data_;
};

/// f(plane) for this rank's planes within [lo, hi), in contiguous blocks, one per thread.
template <class F>
void for_each_plane(const OwnPlanes& own, int lo, int hi, F&& f) {
    parallel_for(own.lower(lo), own.upper(hi), f);
}
/// The same for all planes of a grid.
template <int D, class F>
void for_each_plane(const Extent<D>& extent, F&& f) {
    for_each_plane(extent.own, 0, extent[D - 1], f);
}

namespace detail {
/// f of this rank's planes within [0, planes): their parts, and the range.
template <class F>
const std::vector<real>& parts_of_planes(const OwnPlanes& own, int planes, F&& f) {
    auto& part = reduction_scratch(static_cast<std::size_t>(planes));
    for_each_plane(own, 0, planes, [&](int i) { part[static_cast<std::size_t>(i)] = f(i); });
    return part;
}
}  // namespace detail

/// The exact sum of f over planes, rounded once.
template <class F>
real plane_sum(const OwnPlanes& own, int planes, F&& f) {
    const auto& part = detail::parts_of_planes(own, planes, f);
    const int first = own.lower(0), last = std::max(first, own.upper(planes));
    ExactSum sum;
    sum.add(std::span<const real>(part).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first)));
    return sum_of_ranks(own, sum).value();
}

/// The largest of f over planes; NaN if any is NaN.
template <class F>
real plane_max(const OwnPlanes& own, int planes, F&& f) {
    const auto& part = detail::parts_of_planes(own, planes, f);
    real most = -infinity;
    for (int i = own.lower(0); i < own.upper(planes) && !std::isnan(most); ++i) {
        const real value = part[static_cast<std::size_t>(i)];
        if (value > most || std::isnan(value)) most = value;
    }
    return largest_of_ranks(own, most);
}

template <class T, int D>
Planes planes_of(Grid<T, D>& q) {
    return {q.data(), sizeof(T) * static_cast<std::size_t>(q.stride(D - 1)), q.extent()[D - 1], 0, q.store().held()};
}
/// Halo exchange: fills `ghost_planes` planes on both sides of this rank's subdomain.
template <class T, int D>
void refresh(Grid<T, D>& q, bool ring, int ghost_planes = 1) {
    if (!q.own().distributed()) return;
    q.store().open(ghost_planes, ring);
    communicator().refresh(q.own().partition(), planes_of(q), ghost_planes, ring);
}
/// All-gather: every rank receives all planes.
template <class T, int D>
void gather(Grid<T, D>& q) {
    if (!q.own().distributed()) return;
    q.store().open_all();
    communicator().gather(q.own().partition(), planes_of(q));
}

/// f(I) for every I of this rank in [lo, hi), threaded over the slowest axis; x runs innermost.
template <int D, class F>
void for_each_in(const Index<D>& lo, const Extent<D>& hi, F&& f) {
    for (int d = 0; d < D; ++d)
        if (hi[d] <= lo[d]) return;
    for_each_plane(hi.own, lo[D - 1], hi[D - 1], [&](int outer) {
        Index<D> I = lo;
        I[D - 1] = outer;
        if constexpr (D == 2) {
            for (I[0] = lo[0]; I[0] < hi[0]; ++I[0]) f(I);
        } else {
            for (I[1] = lo[1]; I[1] < hi[1]; ++I[1])
                for (I[0] = lo[0]; I[0] < hi[0]; ++I[0]) f(I);
        }
    });
}

/// f(I) for every I in [lo, hi) in the planes of an array that this rank stores, ghost planes included; an array that is stored whole: in
/// all planes.
template <class T, int D, class F>
void for_each_held(const Grid<T, D>& q, const Index<D>& lo, const Index<D>& hi, F&& f) {
    if (!q.store().windowed()) return for_each_in(lo, replicated(hi), f);
    for (int plane = lo[D - 1]; plane < hi[D - 1]; ++plane)
        if (q.store().holds(plane)) for_each_in(lo, Extent<D>(hi, OwnPlanes::only(q.own().slab, plane, plane + 1)), f);
}

/// f(I) for every entry of this rank in a box of `extent` entries.
template <int D, class F>
void for_each_cell(const Extent<D>& extent, F&& f) {
    for_each_in(Index<D>::constant(0), extent, f);
}

/// Sum of f(I) over a box: the exact sum of those of its planes, bitwise equal for any number of threads and ranks.
template <int D, class F>
real sum_over(const Extent<D>& extent, F&& f) {
    return plane_sum(extent.own, extent[D - 1], [&](int outer) {
        Index<D> I{};
        I[D - 1] = outer;
        real sum = 0;
        if constexpr (D == 2) {
            for (I[0] = 0; I[0] < extent[0]; ++I[0]) sum += f(I);
        } else {
            for (I[1] = 0; I[1] < extent[1]; ++I[1])
                for (I[0] = 0; I[0] < extent[0]; ++I[0]) sum += f(I);
        }
        return sum;
    });
}

/// Largest f(I) over a box; NaN if any is NaN (so that a maximum never hides one). -infinity for an empty box.
template <int D, class F>
real max_over(const Extent<D>& extent, F&& f) {
    return plane_max(extent.own, extent[D - 1], [&](int outer) {
        Index<D> I{};
        I[D - 1] = outer;
        real m = -infinity;
        const auto see = [&](real value) { m = (value > m || std::isnan(value)) ? value : m; };
        if constexpr (D == 2) {
            for (I[0] = 0; I[0] < extent[0]; ++I[0]) see(f(I));
        } else {
            for (I[1] = 0; I[1] < extent[1]; ++I[1])
                for (I[0] = 0; I[0] < extent[0]; ++I[0]) see(f(I));
        }
        return m;
    });
}

}  // namespace weir
