// Choosing lanes: what building the neighbour list needs beyond simd.hpp. Bit l of a mask stands for lane l.
#pragma once
#include "particles/simd.hpp"

namespace {

inline vf load_numbers(const float* from, int first) {
    typedef vf unaligned __attribute__((aligned(4)));
    return *reinterpret_cast<const unaligned*>(from + first);
}

#if WEIR_ISA == 512

inline unsigned below(vf a, float bound) { return _mm512_cmp_ps_mask((__m512)a, _mm512_set1_ps(bound), _CMP_LT_OQ); }
inline unsigned same_bits(vf a, std::uint32_t bits) {
    return _mm512_cmpeq_epi32_mask((__m512i)a, _mm512_set1_epi32(static_cast<int>(bits)));
}
/// Writes the chosen lanes one after the other (and something up to a full vector behind them); returns how many they are.
inline int store_chosen(float* to, vf a, unsigned chosen) {
    _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(chosen), (__m512)a));
    return __builtin_popcount(chosen);
}
/// `lanes` particles in a row, in their order: the neighbours of a particle are listed alike on all machines, and so their sums are.
inline vf in_order(__m512 a, __m512 b, int which) {
    const __m512i order = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
    return (vf)_mm512_permutexvar_ps(order, which ? _mm512_shuffle_ps(a, b, 0xee) : _mm512_shuffle_ps(a, b, 0x44));
}
inline Four load_block(const float* p) {
    const __m512 a = _mm512_loadu_ps(p), b = _mm512_loadu_ps(p + 16), c = _mm512_loadu_ps(p + 32), d = _mm512_loadu_ps(p + 48);
    const __m512 ab_lo = _mm512_unpacklo_ps(a, b), ab_hi = _mm512_unpackhi_ps(a, b);
    const __m512 cd_lo = _mm512_unpacklo_ps(c, d), cd_hi = _mm512_unpackhi_ps(c, d);
    return {in_order(ab_lo, cd_lo, 0), in_order(ab_lo, cd_lo, 1), in_order(ab_hi, cd_hi, 0), in_order(ab_hi, cd_hi, 1)};
}

#elif WEIR_ISA == 256

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

inline unsigned below(vf a, float bound) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps((__m256)a, _mm256_set1_ps(bound), _CMP_LT_OQ)));
}
inline unsigned same_bits(vf a, std::uint32_t bits) {
    return static_cast<unsigned>(
        _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32((__m256i)a, _mm256_set1_epi32(static_cast<int>(bits))))));
}
inline int store_chosen(float* to, vf a, unsigned chosen) {
    const __m256i first = _mm256_load_si256(reinterpret_cast<const __m256i*>(compress_table.lane[chosen]));
    _mm256_storeu_ps(to, _mm256_permutevar8x32_ps((__m256)a, first));
    return __builtin_popcount(chosen);
}
inline vf in_order(__m256 a, __m256 b, int which) {
    const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
    return (vf)_mm256_permutevar8x32_ps(which ? _mm256_shuffle_ps(a, b, 0xee) : _mm256_shuffle_ps(a, b, 0x44), order);
}
inline Four load_block(const float* p) {
    const __m256 a = _mm256_loadu_ps(p), b = _mm256_loadu_ps(p + 8), c = _mm256_loadu_ps(p + 16), d = _mm256_loadu_ps(p + 24);
    const __m256 ab_lo = _mm256_unpacklo_ps(a, b), ab_hi = _mm256_unpackhi_ps(a, b);
    const __m256 cd_lo = _mm256_unpacklo_ps(c, d), cd_hi = _mm256_unpackhi_ps(c, d);
    return {in_order(ab_lo, cd_lo, 0), in_order(ab_lo, cd_lo, 1), in_order(ab_hi, cd_hi, 0), in_order(ab_hi, cd_hi, 1)};
}

#else

inline unsigned below(vf a, float bound) { return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps((__m128)a, _mm_set1_ps(bound)))); }
inline unsigned same_bits(vf a, std::uint32_t bits) {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32((__m128i)a, _mm_set1_epi32(static_cast<int>(bits))))));
}
inline int store_chosen(float* to, vf a, unsigned chosen) {
    typedef int word __attribute__((may_alias));
    typedef int words __attribute__((vector_size(16)));
    int n = 0;
    for (int l = 0; l < lanes; ++l) {
        reinterpret_cast<word*>(to)[n] = ((words)a)[l];
        n += static_cast<int>(chosen >> l & 1);
    }
    return n;
}
inline Four load_block(const float* p) {
    __m128 a = _mm_loadu_ps(p), b = _mm_loadu_ps(p + 4), c = _mm_loadu_ps(p + 8), d = _mm_loadu_ps(p + 12);
    _MM_TRANSPOSE4_PS(a, b, c, d);
    return {(vf)a, (vf)b, (vf)c, (vf)d};
}

#endif

struct Block {
    int byte_offset[lanes];
    constexpr Block() : byte_offset{} {
        for (int l = 0; l < lanes; ++l) byte_offset[l] = 16 * l;
    }
};
alignas(64) constexpr Block block;

/// The lanes of a block that hold the particles which are left in a run.
inline unsigned block_lanes(int left) { return left < lanes ? (1u << left) - 1 : (1u << (lanes - 1) << 1) - 1; }
/// Byte offsets of the float4 of a block that begins at particle i, as the bits of lanes.
inline vf block_offsets(int i) {
    typedef int vi __attribute__((vector_size(4 * lanes), may_alias));
    return (vf)(*reinterpret_cast<const vi*>(block.byte_offset) + 16 * i);
}

}  // namespace
