#include "free_surface/markers.hpp"

#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "free_surface/marker_lanes.hpp"
#include "parallel/communicator.hpp"

#include <cstring>
#include <numeric>

namespace weir::free_surface {

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

/// As Frame::cell_of, for many points; negative values are clamped to 0, so rounding towards 0 is sufficient.
template <int D>
void Markers<D>::find_cells(const Frame<D>& frame, int first, int last) {
    using Cells = simd::Pack<std::int32_t, marker_lanes>;
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
    const int planes = frame.cells[D - 1];
    plane_ = cells / static_cast<std::size_t>(planes);
    cell_start_.resize(frame.own().slab, 2, plane_, planes + 1, 0);
    cell_start_.fill(0);
    int* start = cell_start_.data();
    for_each_block(n, [&](int first, int last) { find_cells(frame, first, last); });
    for (const int cell : cell_) ++start[static_cast<std::size_t>(cell) + 2];
    int before = 0;
    for (int plane = 0; plane < planes; ++plane) {
        if (!cell_start_.holds(plane)) continue;
        const std::size_t first = 2 + static_cast<std::size_t>(plane) * plane_;
        for (std::size_t i = first; i < first + plane_; ++i) before = start[i] += before;
    }
    for (int p = 0; p < n; ++p)  // while filling, the next free index of a cell ends at the start of the following cell
        from_[static_cast<std::size_t>(start[static_cast<std::size_t>(cell_[static_cast<std::size_t>(p)]) + 1]++)] = p;
    find_plane_starts(frame);
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

/// Cells outside the stored planes have no markers.
template <int D>
void Markers<D>::find_plane_starts(const Frame<D>& frame) {
    const int planes = frame.cells[D - 1];
    plane_start_.assign(static_cast<std::size_t>(planes) + 1, 0);
    for (int plane = 0; plane < planes; ++plane) {
        const auto at = static_cast<std::size_t>(plane);
        const bool held = cell_start_.holds(plane) && (plane == 0 || cell_start_.holds(plane - 1));
        plane_start_[at + 1] = plane_start_[at] + (held ? begin((at + 1) * plane_) - begin(at * plane_) : 0);
    }
}

/// The first cell with at least this many markers before it.
template <int D>
std::size_t Markers<D>::first_cell_from(std::size_t least) const {
    const auto plane = std::lower_bound(plane_start_.begin(), plane_start_.end(), least) - plane_start_.begin();
    if (plane == 0) return 0;
    const int *start = cell_start_.data(), *end = start + static_cast<std::size_t>(plane) * plane_;
    return static_cast<std::size_t>(std::lower_bound(end - plane_, end, static_cast<int>(least)) - start);
}

template <int D>
std::size_t Markers<D>::cell_with(std::size_t p) const {
    return first_cell_from(p + 1) - 1;
}

template <int D>
void Markers<D>::find_rows(const Frame<D>& frame) {
    const auto n = static_cast<std::size_t>(frame.cells[0]);
    rows_.resize(product(frame.cells) / n);
    const std::size_t rows_in_plane = plane_ / n;
    parallel_for(0, static_cast<int>(rows_.size()), [&](int row) {
        const int *const first = cell_start_.data() + static_cast<std::size_t>(row) * n, *const last = first + n;
        Segment& extent = rows_[static_cast<std::size_t>(row)] = {frame.cells[0], 0};
        const std::size_t plane = static_cast<std::size_t>(row) / rows_in_plane;
        if (plane_start_[plane] == plane_start_[plane + 1]) return;
        if (*first == *last) return;
        extent.begin = static_cast<int>(std::upper_bound(first, last, *first) - first) - 1;
        extent.end = static_cast<int>(std::lower_bound(first, last, *last) - first);
    });
}

template <int D>
bool Markers<D>::holds(const Frame<D>& frame, int rank, int plane) {
    const Partition& cut = frame.own().partition();
    const int n = frame.cells[D - 1], lo = cut.begin(rank) - 1, hi = cut.end(rank, n) + 1;
    if (plane >= lo && plane < hi) return true;
    return frame.periodic(D - 1) && (plane - n >= lo || plane + n < hi);
}

template <int D>
void Markers<D>::keep_held(const Frame<D>& frame) {
    if (!frame.own().distributed()) return;
    retain([&](std::size_t p) { return holds(frame, frame.cell_of(position(p))[D - 1]); });
    trim();
    sort(frame);
}

/// Returns the ranks that store the markers of each plane of cells.
template <int D>
void Markers<D>::find_holders(const Frame<D>& frame) {
    const int planes = frame.cells[D - 1];
    if (!holders_.empty()) return;
    holders_.resize(static_cast<std::size_t>(planes));
    for (int plane = 0; plane < planes; ++plane)
        for (int rank = 0; rank < frame.own().partition().ranks(); ++rank)
            if (holds(frame, rank, plane)) holders_[static_cast<std::size_t>(plane)].push_back(rank);
}

/// Finds the destination ranks of this rank's own markers (going_) and those that leave this rank (gone_). Returns how many have left the
/// domain.
template <int D>
std::int64_t Markers<D>::find_going(const Frame<D>& frame, std::size_t first, std::size_t last, bool leave) {
    const int planes = frame.cells[D - 1], self = communicator().rank();
    const real origin = frame.origin[D - 1], inv_h = frame.inv_h[D - 1];
    const auto is_beyond = [&](const Vec<D>& at) {
        for (int d = 0; d < D; ++d)
            if (at[d] < frame.origin[d] || at[d] >= frame.origin[d] + frame.h[d] * frame.cells[d]) return true;
        return false;
    };
    for (auto& list : going_) list.clear();
    gone_.clear();
    std::int64_t left = 0;
    for (std::size_t p = first; p < last; ++p) {
        const int plane = std::clamp(index_from(std::floor((x[D - 1][p] - origin) * inv_h)), 0, planes - 1);
        const auto& ranks = holders_[static_cast<std::size_t>(plane)];
        if (leave && is_beyond(position(p))) {
            ++left;
            gone_.push_back(static_cast<int>(p));
        } else if (ranks.size() > 1 || ranks[0] != self) {
            bool stays = false;
            for (const int rank : ranks) {
                if (rank == self) stays = true;
                if (rank != self) going_[static_cast<std::size_t>(rank)].push_back(static_cast<int>(p));
            }
            if (!stays) gone_.push_back(static_cast<int>(p));
        }
    }
    return left;
}

/// The same for markers [first, last). Returns how many have left the domain.
template <int D>
std::int64_t Markers<D>::exchange(const Frame<D>& frame, std::size_t first, std::size_t last, bool leave) {
    const auto ranks = static_cast<std::size_t>(communicator().ranks()), self = static_cast<std::size_t>(communicator().rank());
    going_.resize(ranks), sent_.resize(ranks), received_.resize(ranks);
    find_holders(frame);
    const std::int64_t left = find_going(frame, first, last, leave);
    // number of markers sent between each pair of ranks: one row of the table per rank
    table_.resize(ranks * ranks), table_rows_.resize(ranks + 1);
    for (std::size_t r = 0; r < ranks; ++r) table_[self * ranks + r] = static_cast<int>(going_[r].size());
    std::iota(table_rows_.begin(), table_rows_.end(), std::size_t{0});
    communicator().gather_parts(table_.data(), sizeof(int) * ranks, table_rows_);
    const auto coming = [&](std::size_t r) { return static_cast<std::size_t>(table_[r * ranks + self]); };

    std::size_t arrays = 0, total = last - first - gone_.size();
    for_each_array([&](std::vector<real>&) { ++arrays; });
    messages_.clear();
    for (std::size_t r = 0; r < ranks; ++r) {
        if (r == self) continue;
        total += coming(r);
        resize_scratch(sent_[r], arrays * going_[r].size());
        resize_scratch(received_[r], arrays * coming(r));
        real* to = sent_[r].data();
        for_each_array([&](const std::vector<real>& array) {
            for (const int p : going_[r]) *to++ = array[static_cast<std::size_t>(p)];
        });
        messages_.push_back({static_cast<int>(r), sent_[r].data(), sent_[r].size() * sizeof(real), received_[r].data(),
                             received_[r].size() * sizeof(real)});
    }
    communicator().exchange(messages_);
    std::size_t number = 0;
    for_each_array([&](std::vector<real>& array) {
        resize_scratch(scratch_, total);
        real* to = scratch_.data();
        for (std::size_t r = 0; r < ranks; ++r) {
            if (r != self) {
                to = std::copy_n(received_[r].data() + number * coming(r), coming(r), to);
                continue;
            }
            std::size_t from = first;
            for (const int p : gone_) {
                to = std::copy(array.data() + from, array.data() + p, to);
                from = static_cast<std::size_t>(p) + 1;
            }
            to = std::copy(array.data() + from, array.data() + last, to);
        }
        array.swap(scratch_);
        ++number;
    });
    return left;
}

template <int D>
std::array<std::int64_t, 2> Markers<D>::migrate(const Frame<D>& frame, bool leave) {
    const auto [first, last] = own(frame);
    return {static_cast<std::int64_t>(last - first), exchange(frame, first, last, leave)};
}

template <int D>
void Markers<D>::deal(const Frame<D>& frame) {
    exchange(frame, 0, count(), false);
    sent_.clear(), received_.clear();  // few markers migrate per step
    trim();
    sort(frame);
}

template <int D>
void Markers<D>::gather(const Frame<D>& frame, Markers& all) const {
    const auto [first, last] = own(frame);
    const std::vector<std::size_t> begins = begins_of_ranks(last - first);
    std::vector<std::vector<real>*> to;
    all.for_each_array([&](std::vector<real>& array) { to.push_back(&array); });
    std::size_t number = 0;
    for_each_array([&, begin = first, count = last - first](const std::vector<real>& array) {
        std::vector<real>& whole = *to[number++];
        whole.resize(begins.back());
        std::copy_n(array.data() + begin, count, whole.data() + begins[static_cast<std::size_t>(communicator().rank())]);
        communicator().gather_parts(whole.data(), sizeof(real), begins);
    });
}

template <int D>
void Markers<D>::trim() {
    const std::size_t capacity = count() + count() / 8;
    const auto fit = [&](auto& list) {
        if (list.capacity() <= capacity) return;
        auto fitting = std::move(list);
        list = {};
        list.reserve(capacity);
        list.insert(list.end(), fitting.begin(), fitting.end());
    };
    cell_.clear(), from_.clear(), scratch_.clear();
    for (auto* list : {&cell_, &from_}) fit(*list);
    fit(scratch_);
    for_each_array([&](std::vector<real>& array) { fit(array); });
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
    std::size_t total = (cell_.capacity() + from_.capacity()) * sizeof(int) + cell_start_.bytes() + rows_.capacity() * sizeof(Segment) +
                        plane_start_.capacity() * sizeof(std::size_t) + scratch_.capacity() * sizeof(real);
    for_each_array([&](const std::vector<real>& array) { total += array.capacity() * sizeof(real); });
    for (const auto& list : going_) total += list.capacity() * sizeof(int);
    total += gone_.capacity() * sizeof(int);
    for (const auto* buffers : {&sent_, &received_})
        for (const auto& buffer : *buffers) total += buffer.capacity() * sizeof(real);
    return total;
}

template class Markers<2>;
template class Markers<3>;

}  // namespace weir::free_surface
