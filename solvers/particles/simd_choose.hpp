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
/// `lanes` particles in a row. Lane l holds particle block_lane(l): the order in which a 4 x 4 transpose leaves them.
inline constexpr int block_lane(int l) { return 4 * (l % 4) + l / 4; }
inline Four load_block(const float* p) {
    const __m512 a = _mm512_loadu_ps(p), b = _mm512_loadu_ps(p + 16), c = _mm512_loadu_ps(p + 32), d = _mm512_loadu_ps(p + 48);
    const __m512 ab_lo = _mm512_unpacklo_ps(a, b), ab_hi = _mm512_unpackhi_ps(a, b);
    const __m512 cd_lo = _mm512_unpacklo_ps(c, d), cd_hi = _mm512_unpackhi_ps(c, d);
    return {(vf)_mm512_shuffle_ps(ab_lo, cd_lo, 0x44), (vf)_mm512_shuffle_ps(ab_lo, cd_lo, 0xee), (vf)_mm512_shuffle_ps(ab_hi, cd_hi, 0x44),
            (vf)_mm512_shuffle_ps(ab_hi, cd_hi, 0xee)};
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
inline constexpr int block_lane(int l) { return 2 * (l % 4) + l / 4; }
inline Four load_block(const float* p) {
    const __m256 a = _mm256_loadu_ps(p), b = _mm256_loadu_ps(p + 8), c = _mm256_loadu_ps(p + 16), d = _mm256_loadu_ps(p + 24);
    const __m256 ab_lo = _mm256_unpacklo_ps(a, b), ab_hi = _mm256_unpackhi_ps(a, b);
    const __m256 cd_lo = _mm256_unpacklo_ps(c, d), cd_hi = _mm256_unpackhi_ps(c, d);
    return {(vf)_mm256_shuffle_ps(ab_lo, cd_lo, 0x44), (vf)_mm256_shuffle_ps(ab_lo, cd_lo, 0xee), (vf)_mm256_shuffle_ps(ab_hi, cd_hi, 0x44),
            (vf)_mm256_shuffle_ps(ab_hi, cd_hi, 0xee)};
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
inline constexpr int block_lane(int l) { return l; }
inline Four load_block(const float* p) {
    __m128 a = _mm_loadu_ps(p), b = _mm_loadu_ps(p + 4), c = _mm_loadu_ps(p + 8), d = _mm_loadu_ps(p + 12);
    _MM_TRANSPOSE4_PS(a, b, c, d);
    return {(vf)a, (vf)b, (vf)c, (vf)d};
}

#endif

/// Lane numbers of a block, and for each count of particles left in a run the lanes that hold them.
struct Block {
    int byte_offset[lanes];
    unsigned first[lanes + 1];
    constexpr Block() : byte_offset{}, first{} {
        for (int l = 0; l < lanes; ++l) byte_offset[l] = 16 * block_lane(l);
        for (int left = 0; left <= lanes; ++left)
            for (int l = 0; l < lanes; ++l)
                if (block_lane(l) < left) first[left] |= 1u << l;
    }
};
alignas(64) constexpr Block block;

inline unsigned block_lanes(int left) { return block.first[left < lanes ? left : lanes]; }
/// Byte offsets of the float4 of a block that begins at particle i, as the bits of lanes.
inline vf block_offsets(int i) {
    typedef int vi __attribute__((vector_size(4 * lanes), may_alias));
    return (vf)(*reinterpret_cast<const vi*>(block.byte_offset) + 16 * i);
}

}  // namespace
