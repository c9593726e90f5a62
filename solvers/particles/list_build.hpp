// Building the sliced ELL list for one instruction set: included by pair_passes.cpp only. The candidates of a cell are
// packed once (nine runs of three cells, cut to the bounding box of the cell's particles grown by the radius), then each particle of the
// cell tests them lane by lane and appends the hits.
#pragma once
#include "particles/passes.hpp"
#include "particles/simd_choose.hpp"

namespace {

using weir::particles::Built;
using weir::particles::ListChunk;
using weir::particles::ListJob;

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
            const int row = (z * ny + y) * nx;
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
    __m128 lo, hi;
};
inline Bounds bounds(const ListJob& job, int cell) {
    const int begin = job.start[cell], end = job.start[cell + 1];
    Bounds b{_mm_load_ps(job.positions + 4 * begin), _mm_load_ps(job.positions + 4 * begin)};
    for (int i = begin + 1; i < end; ++i) {
        const __m128 p = _mm_load_ps(job.positions + 4 * i);
        b.lo = _mm_min_ps(b.lo, p);
        b.hi = _mm_max_ps(b.hi, p);
    }
    return b;
}

/// The candidates of the runs that are closer than the radius to the box of the cell's particles, `lanes` at a time.
inline void pack(const ListJob& job, ListChunk& chunk, int cell, const Runs& runs) {
    const Bounds box = bounds(job, cell);
    typedef float four __attribute__((vector_size(16)));
    const four lo = (four)box.lo, hi = (four)box.hi;
    int n = 0;
    for (int r = 0; r < runs.count; ++r)
        for (int i = runs.begin[r]; i < runs.end[r]; i += lanes) {
            const Four p = load_block(job.positions + 4 * i);
            const vf x = max0(higher(lo[0] - p.x, p.x - hi[0])), y = max0(higher(lo[1] - p.y, p.y - hi[1]));
            const vf z = max0(higher(lo[2] - p.z, p.z - hi[2]));
            const unsigned chosen = below(square_length(x, y, z), job.radius2) & block_lanes(runs.end[r] - i);
            store_chosen(chunk.x + n, p.x, chosen);
            store_chosen(chunk.y + n, p.y, chosen);
            store_chosen(chunk.z + n, p.z, chosen);
            n += store_chosen(reinterpret_cast<float*>(chunk.offset + n), block_offsets(i), chosen);
        }
    for (int pad = n; pad < n + lanes; ++pad) chunk.x[pad] = chunk.y[pad] = chunk.z[pad] = weir::particles::dummy_position;
    chunk.packed = n;
    chunk.packed_cell = cell;
}

/// Appends the candidates at c .. c + lanes - 1 that are closer than the radius and are not the particle itself.
inline int append(std::uint32_t* out, int n, const ListChunk& chunk, int c, vf x, vf y, vf z, float radius2, std::uint32_t self) {
    const vf dx = load_numbers(chunk.x, c) - x, dy = load_numbers(chunk.y, c) - y, dz = load_numbers(chunk.z, c) - z;
    const vf offsets = load_numbers(reinterpret_cast<const float*>(chunk.offset), c);
    const unsigned hit = below(square_length(dx, dy, dz), radius2) & ~same_bits(offsets, self);
    return n + store_chosen(reinterpret_cast<float*>(out + n), offsets, hit);
}

/// hits (one list a lane, each padded to `rows`) into rows of `lanes` entries: 4 x 4 blocks at a time.
inline void write_rows(std::uint32_t* entries, const std::uint32_t* hits, int stride, int rows) {
    for (int k = 0; k < rows; k += 4)
        for (int l = 0; l < lanes; l += 4) {
            __m128 a = _mm_loadu_ps(reinterpret_cast<const float*>(hits + l * stride + k));
            __m128 b = _mm_loadu_ps(reinterpret_cast<const float*>(hits + (l + 1) * stride + k));
            __m128 c = _mm_loadu_ps(reinterpret_cast<const float*>(hits + (l + 2) * stride + k));
            __m128 d = _mm_loadu_ps(reinterpret_cast<const float*>(hits + (l + 3) * stride + k));
            _MM_TRANSPOSE4_PS(a, b, c, d);
            float* to = reinterpret_cast<float*>(entries + k * lanes + l);
            _mm_storeu_ps(to, a);
            if (k + 1 < rows) _mm_storeu_ps(to + lanes, b);
            if (k + 2 < rows) _mm_storeu_ps(to + 2 * lanes, c);
            if (k + 3 < rows) _mm_storeu_ps(to + 3 * lanes, d);
        }
}

/// Builds slices from chunk.next on; stops, having changed nothing of the slice, where scratch or entries are too small.
inline Built build_list(const ListJob& job, ListChunk& chunk) {
    const std::uint32_t dummy = static_cast<std::uint32_t>(16 * job.count);
    for (; chunk.next < chunk.end; ++chunk.next) {
        const int begin = chunk.next * lanes, end = begin + lanes < job.count ? begin + lanes : job.count;
        int found[lanes], rows = 0;
        const int stride = chunk.candidates;
        for (int l = 0; l < lanes; ++l) found[l] = 0;
        for (int i = begin; i < end; ++i) {
            const int cell = job.cell_of[i];
            if (cell != chunk.packed_cell) {
                const Runs runs = runs_around(job, cell);
                if (runs.candidates + 2 * lanes > chunk.candidates) {
                    chunk.needed = static_cast<std::size_t>(runs.candidates) + 2 * lanes;
                    return Built::needs_candidates;
                }
                pack(job, chunk, cell, runs);
            }
            const float* p = job.positions + 4 * i;
            const vf x = broadcast(p[0]), y = broadcast(p[1]), z = broadcast(p[2]);
            int n = 0;
            for (int c = 0; c < chunk.packed; c += lanes)
                n = append(chunk.hits + (i - begin) * stride, n, chunk, c, x, y, z, job.radius2, static_cast<std::uint32_t>(16 * i));
            found[i - begin] = n;
            job.neighbours[i] = n;
            rows = n > rows ? n : rows;
        }
        const std::size_t entries = static_cast<std::size_t>(rows) * lanes;
        if (chunk.used + entries > chunk.capacity) {
            chunk.needed = chunk.used + entries;
            return Built::needs_entries;
        }
        for (int l = 0; l < lanes; ++l)
            for (int k = found[l]; k < ((rows + 3) & ~3); ++k) chunk.hits[l * stride + k] = dummy;
        write_rows(chunk.entries + chunk.used, chunk.hits, stride, rows);
        job.first[chunk.next] = chunk.used;
        job.rows[chunk.next] = rows;
        chunk.used += entries;
    }
    return Built::done;
}

}  // namespace
