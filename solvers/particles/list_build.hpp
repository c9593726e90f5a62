// Building the sliced ELL list for one instruction set: included by pair_passes.cpp only, after simd.hpp. The candidates of a cell are
// packed once (nine runs of three cells, cut to the bounding box of the cell's particles grown by the radius), then each particle of the
// cell tests them lane by lane and appends the hits.
#pragma once
#include "particles/passes.hpp"
#include "particles/simd.hpp"

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

inline void pack(const ListJob& job, ListChunk& chunk, int cell, const Runs& runs) {
    const Bounds box = bounds(job, cell);
    const __m128 r2 = _mm_set1_ps(job.radius2), xyz = _mm_castsi128_ps(_mm_setr_epi32(-1, -1, -1, 0));
    int n = 0;
    for (int r = 0; r < runs.count; ++r)
        for (int i = runs.begin[r]; i < runs.end[r]; ++i) {
            const __m128 p = _mm_load_ps(job.positions + 4 * i);
            const __m128 out = _mm_and_ps(_mm_max_ps(_mm_max_ps(_mm_sub_ps(box.lo, p), _mm_sub_ps(p, box.hi)), _mm_setzero_ps()), xyz);
            __m128 d2 = _mm_mul_ps(out, out);
            d2 = _mm_add_ps(d2, _mm_movehl_ps(d2, d2));
            d2 = _mm_add_ss(d2, _mm_shuffle_ps(d2, d2, 1));
            _mm_store_ss(chunk.x + n, p);
            _mm_store_ss(chunk.y + n, _mm_shuffle_ps(p, p, 1));
            _mm_store_ss(chunk.z + n, _mm_movehl_ps(p, p));
            chunk.offset[n] = static_cast<std::uint32_t>(16 * i);
            n += _mm_comilt_ss(d2, r2);
        }
    for (int pad = n; pad < n + lanes; ++pad) chunk.x[pad] = chunk.y[pad] = chunk.z[pad] = weir::particles::dummy_position;
    chunk.packed = n;
    chunk.packed_cell = cell;
}

#if WEIR_ISA == 256
/// For each mask of eight lanes: the chosen lanes first.
struct CompressTable {
    std::uint32_t lane[256][8];
    constexpr CompressTable() : lane{} {
        for (int m = 0; m < 256; ++m) {
            int n = 0;
            for (int l = 0; l < 8; ++l)
                if (m >> l & 1) lane[m][n++] = static_cast<std::uint32_t>(l);
        }
    }
};
alignas(32) constexpr CompressTable compress_table;
#endif

/// Appends the candidates at c .. c + lanes - 1 that are closer than the radius and are not the particle itself.
inline int append(std::uint32_t* out, int n, const ListChunk& chunk, int c, vf x, vf y, vf z, float radius2, std::uint32_t self) {
    typedef vf unaligned __attribute__((aligned(4)));
    const vf dx = *reinterpret_cast<const unaligned*>(chunk.x + c) - x;
    const vf dy = *reinterpret_cast<const unaligned*>(chunk.y + c) - y;
    const vf dz = *reinterpret_cast<const unaligned*>(chunk.z + c) - z;
    const vf d2 = dx * dx + dy * dy + dz * dz;
#if WEIR_ISA == 512
    const __m512i o = _mm512_loadu_si512(chunk.offset + c);
    const __mmask16 hit = _mm512_mask_cmp_ps_mask(_mm512_cmpneq_epi32_mask(o, _mm512_set1_epi32(static_cast<int>(self))), (__m512)d2,
                                                  _mm512_set1_ps(radius2), _CMP_LT_OQ);
    _mm512_storeu_si512(out + n, _mm512_maskz_compress_epi32(hit, o));
    return n + __builtin_popcount(hit);
#elif WEIR_ISA == 256
    const __m256i o = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(chunk.offset + c));
    const __m256i me = _mm256_cmpeq_epi32(o, _mm256_set1_epi32(static_cast<int>(self)));
    const __m256 close = _mm256_cmp_ps((__m256)d2, _mm256_set1_ps(radius2), _CMP_LT_OQ);
    const int hit = _mm256_movemask_ps(_mm256_andnot_ps(_mm256_castsi256_ps(me), close));
    const __m256i first = _mm256_load_si256(reinterpret_cast<const __m256i*>(compress_table.lane[hit]));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + n), _mm256_permutevar8x32_epi32(o, first));
    return n + __builtin_popcount(static_cast<unsigned>(hit));
#else
    const int hit = _mm_movemask_ps(_mm_cmplt_ps((__m128)d2, _mm_set1_ps(radius2)));
    for (int l = 0; l < 4; ++l) {
        const std::uint32_t o = chunk.offset[c + l];
        out[n] = o;
        n += (hit >> l & 1) & (o != self);
    }
    return n;
#endif
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
