// The neighbour list of the fast path (sliced ELL), with storage that grows as needed. A chunk of slices belongs to one thread, which
// builds it and later runs the passes over it. Where its capacity is too small the builder stops, the storage grows, and the builder
// continues.
#pragma once
#include "particles/ranks/shares.hpp"
#include "particles/threads/cell_sort.hpp"
#include "particles/threads/passes.hpp"

#include <string>
#include <vector>

namespace weir::particles {

class SlicedList {
public:
    /// axis: coordinates of `count` sorted particles, with space for `lanes` more. Pairs closer than `radius` [m]. Throws NumericalFailure
    /// when the list would need more than `max_bytes`.
    void build(const PassTable& table, const std::array<const float*, 3>& axis, const CellSort& cells, float radius) {
        build(table, axis, cells, radius, {0, cells.count()});
    }
    /// The same for some particles, and those that share a slice with them.
    void build(const PassTable& table, const std::array<const float*, 3>& axis, const CellSort& cells, float radius, const Entries& own);

    /// f(chunk) for every chunk, one per thread.
    template <class F>
    void each_chunk(F&& f) const {
        const int chunks = static_cast<int>(chunks_.size());
        for_chunks(chunks, chunks, [&](int t, int, int) { f(chunks_[static_cast<std::size_t>(t)].view); });
    }
    const std::size_t* first() const { return first_.data(); }
    const int* rows() const { return rows_.data(); }
    int slices() const { return static_cast<int>(rows_.size()); }
    /// Number of neighbours of each sorted particle.
    const std::vector<int>& neighbours() const { return neighbours_; }
    /// Number of reallocations over all builds.
    int growths() const;
    std::size_t bytes() const;

    std::size_t max_bytes = std::size_t{6} << 30;
    std::size_t entries_at_first = 0;  // initial capacity of a chunk in entries; 0: 44 per particle (tests start smaller)

private:
    struct Chunk {
        ListChunk view;
        std::vector<std::uint32_t> entries, offset, hits;
        std::vector<float> x, y, z;
        int growths = 0;
        bool roomy = false;  // spare capacity was added
        std::string failure;
    };
    void prepare(Chunk& chunk, int t, const Entries& slices, int lanes);
    void grow(Chunk& chunk, Built why, int lanes) const;
    void make_room_ahead(Chunk& chunk) const;

    std::vector<Chunk> chunks_;
    std::vector<std::size_t> first_;
    std::vector<int> rows_, neighbours_;
};

}  // namespace weir::particles
