// Builds the sliced ELL list for one instruction set: included by pair_passes.cpp only. The candidates of a cell are packed once (nine runs
// of three cells, cut to the bounding box of the cell's particles grown by the radius). Then the cell's particles test them lane by lane,
// two particles at a time, and append the hits: in the order of the sorted particles, for any lane count.
#pragma once
#include "particles/threads/passes.hpp"
#include "particles/threads/simd_choose.hpp"

namespace {

using weir::particles::Built;
using weir::particles::ListChunk;
using weir::particles::ListJob;

/// Number of particles tested together: each candidate is read once for all of them.
inline constexpr int at_once = 2;

/// The contiguous runs of sorted particles around a cell: at most nine.
struct Runs {
    int begin[9], end[9], count = 0, candidates = 0;
};

inline Runs runs_around(const ListJob& job, int cell) {
    const int nx = job.cells[0], ny = job.cells[1], nz = job.cells[2];
    const int cx = cell % nx, cy = cell / nx % ny, cz = cell / (nx * ny);
    const int x0 = cx > 0 ? cx - 1 : 0, x1 = cx + 1 < nx ? cx + 1 : nx - 1;
    Runs runs;
    for (int z = cz > 0 ? cz - 1 : 0; z <= cz + 1 && z < nz; ++z)
        for (int y = cy > 0 ? cy - 1 : 0; y <= cy + 1 && y < ny; ++y) {
            const int row = (z * ny + y) * nx - job.first_cell;
            const int begin = job.start[row + x0], end = job.start[row + x1 + 1];
            if (begin == end) continue;
            runs.begin[runs.count] = begin;
            runs.end[runs.count++] = end;
            runs.candidates += end - begin;
        }
    return runs;
}

/// The box of the particles of one cell.
struct Bounds {
    float lo[3], hi[3];
};
inline Bounds bounds(const ListJob& job, int cell) {
    Bounds b;
    const int* start = job.start + (cell - job.first_cell);
    for (int a = 0; a < 3; ++a) {
        const float* x = job.axis[a];
        float lo = x[start[0]], hi = lo;
        for (int i = start[0] + 1; i < start[1]; ++i) {
            lo = x[i] < lo ? x[i] : lo;
            hi = x[i] > hi ? x[i] : hi;
        }
        b.lo[a] = lo, b.hi[a] = hi;
    }
    return b;
}
/// Distance of a coordinate outside an interval.
inline vf outside(vf x, float lo, float hi) { return x - lower(higher(x, broadcast(lo)), broadcast(hi)); }

/// Packs the candidates of the runs closer than the radius to the box of the cell's particles, `lanes` at a time.
inline void pack(const ListJob& job, ListChunk& chunk, int cell, const Runs& runs) {
    const Bounds box = bounds(job, cell);
    float *const to_x = chunk.x, *const to_y = chunk.y, *const to_z = chunk.z, *const to_offset = as_numbers(chunk.offset);
    const float radius2 = job.radius2;
    int n = 0;
    for (int r = 0; r < runs.count; ++r)
        for (int i = runs.begin[r], end = runs.end[r]; i < end; i += lanes) {
            const vf x = load_numbers(job.axis[0], i), y = load_numbers(job.axis[1], i), z = load_numbers(job.axis[2], i);
            const vf dx = outside(x, box.lo[0], box.hi[0]), dy = outside(y, box.lo[1], box.hi[1]), dz = outside(z, box.lo[2], box.hi[2]);
            const unsigned chosen = below(square_length(dx, dy, dz), radius2) & block_lanes(end - i);
            store_chosen(to_x + n, x, chosen);
            store_chosen(to_y + n, y, chosen);
            store_chosen(to_z + n, z, chosen);
            n += store_chosen(to_offset + n, block_offsets(i), chosen);
        }
    for (int pad = n; pad < n + lanes; ++pad) to_x[pad] = to_y[pad] = to_z[pad] = weir::particles::dummy_position;
    chunk.packed = n;
    chunk.packed_cell = cell;
}

/// Lists, for each of `Count` consecutive particles of the packed cell, the candidates closer than the radius except the particle itself,
/// padded with dummies.
template <int Count>
inline void find_hits(const ListJob& job, const ListChunk& chunk, int i, std::uint32_t* hits, int stride, int* found, vf dummies) {
    const float *const near_x = chunk.x, *const near_y = chunk.y, *const near_z = chunk.z, *const offset = as_numbers(chunk.offset);
    const int packed = chunk.packed;
    const float radius2 = job.radius2;
    vf x[Count], y[Count], z[Count];
    float* to[Count];
    for (int p = 0; p < Count; ++p) {
        x[p] = broadcast(job.axis[0][i + p]), y[p] = broadcast(job.axis[1][i + p]), z[p] = broadcast(job.axis[2][i + p]);
        to[p] = as_numbers(hits + p * stride);
    }
    for (int c = 0; c < packed; c += lanes) {
        const vf jx = load_numbers(near_x, c), jy = load_numbers(near_y, c), jz = load_numbers(near_z, c), j = load_numbers(offset, c);
        for (int p = 0; p < Count; ++p) {
            const vf dx = jx - x[p], dy = jy - y[p], dz = jz - z[p];
            to[p] +=
                store_chosen(to[p], j, below_of_others(square_length(dx, dy, dz), radius2, j, static_cast<std::uint32_t>(16 * (i + p))));
        }
    }
    for (int p = 0; p < Count; ++p) {
        store_all(to[p], dummies);
        found[p] = static_cast<int>(to[p] - as_numbers(hits + p * stride));
        job.neighbours[i + p] = found[p];
    }
}

/// Interleaves hits (one list per lane, each padded to a multiple of four rows) into rows of `lanes` entries, four at a time.
inline void write_rows(std::uint32_t* entries, const std::uint32_t* hits, int stride, int rows) {
    std::uint32_t lane[lanes];
    for (int l = 0; l < lanes; ++l) lane[l] = static_cast<std::uint32_t>(4 * l * stride);
    for (int k = 0; k < rows; k += 4) {
        const Four four = gather(as_numbers(hits + k), lane);
        float* to = as_numbers(entries + k * lanes);
        store_all(to, four.x);
        store_all(to + lanes, four.y);
        store_all(to + 2 * lanes, four.z);
        store_all(to + 3 * lanes, four.w);
    }
}

/// Builds slices from chunk.next on; stops before a slice for which scratch or entries are too small.
inline Built build_list(const ListJob& job, ListChunk& chunk) {
    const vf dummies = same_in_all(static_cast<std::uint32_t>(16 * job.count));
    for (; chunk.next < chunk.end; ++chunk.next) {
        const int begin = chunk.next * lanes, end = begin + lanes < job.count ? begin + lanes : job.count;
        const int stride = chunk.candidates;
        int found[lanes];
        for (int i = begin; i < end;) {
            if (i < job.own_begin || i >= job.own_end) {
                found[i - begin] = -lanes;  // without dummies yet
                job.neighbours[i++] = 0;
                continue;
            }
            const int cell = job.cell_of[i];
            if (cell != chunk.packed_cell) {
                const Runs runs = runs_around(job, cell);
                if (runs.candidates + 2 * lanes > chunk.candidates) {
                    chunk.needed = static_cast<std::size_t>(runs.candidates) + 2 * lanes;
                    return Built::needs_candidates;
                }
                pack(job, chunk, cell, runs);
            }
            const int next = job.start[cell + 1 - job.first_cell], cell_end = next < end ? next : end;
            for (; i + at_once <= cell_end; i += at_once)
                find_hits<at_once>(job, chunk, i, chunk.hits + (i - begin) * stride, stride, found + (i - begin), dummies);
            for (; i < cell_end; ++i) find_hits<1>(job, chunk, i, chunk.hits + (i - begin) * stride, stride, found + (i - begin), dummies);
        }
        int rows = 0;
        for (int l = 0; l < end - begin; ++l) rows = found[l] > rows ? found[l] : rows;
        const int padded = (rows + 3) & ~3;
        const std::size_t entries = static_cast<std::size_t>(padded) * lanes;
        if (chunk.used + entries > chunk.capacity) {
            chunk.needed = chunk.used + entries;
            return Built::needs_entries;
        }
        for (int l = 0; l < lanes; ++l)
            for (int k = l < end - begin ? found[l] + lanes : 0; k < padded; k += lanes)
                store_all(as_numbers(chunk.hits + l * stride + k), dummies);
        write_rows(chunk.entries + chunk.used, chunk.hits, stride, rows);
        job.first[chunk.next] = chunk.used;
        job.rows[chunk.next] = rows;
        chunk.used += static_cast<std::size_t>(rows) * lanes;
    }
    return Built::done;
}

}  // namespace
