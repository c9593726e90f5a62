#include "particles/threads/sliced_list.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <string>

namespace weir::particles {

namespace {

/// Resizes without spare capacity: std::vector would double it.
template <class T>
void resize_exactly(std::vector<T>& v, std::size_t count) {
    v.reserve(count);
    v.resize(count);
}

}  // namespace

void SlicedList::prepare(Chunk& chunk, int t, const Entries& slices, int lanes) {
    const int chunks = static_cast<int>(chunks_.size());
    ListChunk& v = chunk.view;
    v.begin = v.next = slices.begin + chunk_begin(slices.count(), t, chunks);
    v.end = slices.begin + chunk_begin(slices.count(), t + 1, chunks);
    v.used = 0;
    v.packed_cell = -1;
    if (chunk.entries.empty()) {
        const auto usual = static_cast<std::size_t>(44 * lanes) * static_cast<std::size_t>(v.end - v.begin);
        chunk.entries.resize(entries_at_first ? entries_at_first : usual);
        v.capacity = chunk.entries.size();
        v.entries = chunk.entries.data();
    }
}

void SlicedList::grow(Chunk& chunk, Built why, int lanes) const {
    ListChunk& v = chunk.view;
    ++chunk.growths;
    const std::size_t room = (v.needed + v.needed / 4 + 1024) / 16 * 16;  // aligned lists of hits
    if (room * sizeof(std::uint32_t) * (why == Built::needs_candidates ? static_cast<std::size_t>(lanes) : chunks_.size()) > max_bytes)
        throw NumericalFailure("neighbours", "the neighbour list needs more than " + std::to_string(max_bytes >> 20) +
                                                 " MiB: too many particles are closer than the support");
    if (why == Built::needs_entries) {
        resize_exactly(chunk.entries, room);
        v.entries = chunk.entries.data();
        v.capacity = room;
        return;
    }
    chunk.x.resize(room), chunk.y.resize(room), chunk.z.resize(room), chunk.offset.resize(room);
    chunk.hits.resize(room * static_cast<std::size_t>(lanes) + 64);
    v.x = chunk.x.data(), v.y = chunk.y.data(), v.z = chunk.z.data();
    v.offset = chunk.offset.data(), v.hits = chunk.hits.data();
    v.candidates = static_cast<int>(room);
    v.packed_cell = -1;
}

/// Initially half more capacity, later an eighth. A lattice has pairs at exactly the radius (8 of 48 in 2D at four spacings), so lists grow
/// soon after the start.
void SlicedList::make_room_ahead(Chunk& chunk) const {
    ListChunk& v = chunk.view;
    const std::size_t wanted = v.used + (chunk.roomy ? v.used / 8 : v.used / 2);
    chunk.roomy = chunk.roomy || v.used > 0;
    if (wanted <= v.capacity) return;
    resize_exactly(chunk.entries, v.used + v.used / 2);
    v.entries = chunk.entries.data();
    v.capacity = chunk.entries.size();
}

void SlicedList::build(const PassTable& table, const std::array<const float*, 3>& axis, const CellSort& cells, float radius,
                       const Entries& own) {
    const int count = cells.count(), lanes = table.lanes, slices = (count + lanes - 1) / lanes;
    const Entries own_slices{own.begin / lanes, own.count() > 0 ? (own.end + lanes - 1) / lanes : own.begin / lanes};
    chunks_.resize(static_cast<std::size_t>(threads()));
    first_.resize(static_cast<std::size_t>(slices));
    rows_.resize(static_cast<std::size_t>(slices));
    neighbours_.resize(static_cast<std::size_t>(count));
    ListJob job;
    job.count = count;
    job.start = cells.start().data(), job.first_cell = cells.first_cell(), job.cell_of = cells.cell_of().data();
    job.own_begin = own.begin, job.own_end = own.end;
    job.radius2 = radius * radius;
    job.first = first_.data(), job.rows = rows_.data(), job.neighbours = neighbours_.data();
    for (std::size_t a = 0; a < 3; ++a) job.axis[a] = axis[a], job.cells[a] = cells.cells()[a];
    for_chunks(static_cast<int>(chunks_.size()), static_cast<int>(chunks_.size()), [&](int t, int, int) {
        Chunk& chunk = chunks_[static_cast<std::size_t>(t)];
        chunk.failure.clear();
        try {
            prepare(chunk, t, own_slices, lanes);
            for (Built built = table.build(job, chunk.view); built != Built::done; built = table.build(job, chunk.view))
                grow(chunk, built, lanes);
            make_room_ahead(chunk);
        } catch (const std::exception& e) {
            chunk.failure = e.what();  // an exception must not leave a parallel region
        }
    });
    for (const auto& chunk : chunks_)
        if (!chunk.failure.empty()) throw NumericalFailure("neighbours", chunk.failure);
}

int SlicedList::growths() const {
    int sum = 0;
    for (const Chunk& c : chunks_) sum += c.growths;
    return sum;
}

std::size_t SlicedList::bytes() const {
    std::size_t sum = first_.capacity() * sizeof(std::size_t) + (rows_.capacity() + neighbours_.capacity()) * sizeof(int);
    for (const Chunk& c : chunks_) sum += 4 * (c.entries.capacity() + c.offset.capacity() + c.hits.capacity() + 3 * c.x.capacity());
    return sum;
}

}  // namespace weir::particles
