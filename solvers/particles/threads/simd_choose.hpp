// Selecting lanes: additions to simd.hpp for building the neighbour list. Bit l of a mask is lane l.
#pragma once
#include "particles/threads/simd.hpp"

namespace {

inline vf load_numbers(const float* from, int first) {
    typedef vf unaligned __attribute__((aligned(4)));
    return *reinterpret_cast<const unaligned*>(from + first);
}

inline void store_all(float* to, vf a) {
    typedef vf unaligned __attribute__((aligned(4)));
    *reinterpret_cast<unaligned*>(to) = a;
}
inline float* as_numbers(std::uint32_t* bits) { return reinterpret_cast<float*>(bits); }
inline const float* as_numbers(const std::uint32_t* bits) { return reinterpret_cast<const float*>(bits); }

#if WEIR_ISA == 512

inline unsigned below(vf a, float bound) { return _mm512_cmp_ps_mask((__m512)a, _mm512_set1_ps(bound), _CMP_LT_OQ); }
/// Lanes of a below the bound, except the particle itself.
inline unsigned below_of_others(vf a, float bound, vf offset, std::uint32_t self) {
    const __mmask16 others = _mm512_cmpneq_epi32_mask((__m512i)offset, _mm512_set1_epi32(static_cast<int>(self)));
    return _mm512_mask_cmp_ps_mask(others, (__m512)a, _mm512_set1_ps(bound), _CMP_LT_OQ);
}
/// Writes the selected lanes contiguously (and unspecified values up to a full vector behind them); returns their number.
inline int store_chosen(float* to, vf a, unsigned chosen) {
    _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(chosen), (__m512)a));
    return __builtin_popcount(chosen);
}

#elif WEIR_ISA == 256

/// For each mask of eight lanes: the selected lanes first.
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
inline unsigned below_of_others(vf a, float bound, vf offset, std::uint32_t self) {
    const __m256 own = _mm256_castsi256_ps(_mm256_cmpeq_epi32((__m256i)offset, _mm256_set1_epi32(static_cast<int>(self))));
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_andnot_ps(own, _mm256_cmp_ps((__m256)a, _mm256_set1_ps(bound), _CMP_LT_OQ))));
}
inline int store_chosen(float* to, vf a, unsigned chosen) {
    const __m256i first = _mm256_load_si256(reinterpret_cast<const __m256i*>(compress_table.lane[chosen]));
    _mm256_storeu_ps(to, _mm256_permutevar8x32_ps((__m256)a, first));
    return __builtin_popcount(chosen);
}

#else

inline unsigned below(vf a, float bound) { return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps((__m128)a, _mm_set1_ps(bound)))); }
inline unsigned below_of_others(vf a, float bound, vf offset, std::uint32_t self) {
    const __m128 own = _mm_castsi128_ps(_mm_cmpeq_epi32((__m128i)offset, _mm_set1_epi32(static_cast<int>(self))));
    return static_cast<unsigned>(_mm_movemask_ps(_mm_andnot_ps(own, _mm_cmplt_ps((__m128)a, _mm_set1_ps(bound)))));
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

#endif

struct Block {
    int byte_offset[lanes];
    constexpr Block() : byte_offset{} {
        for (int l = 0; l < lanes; ++l) byte_offset[l] = 16 * l;
    }
};
alignas(64) constexpr Block block;

/// The lanes of a block that contain the remaining particles of a run.
inline unsigned block_lanes(int left) { return left < lanes ? (1u << left) - 1 : (1u << (lanes - 1) << 1) - 1; }
/// The same bits in all lanes.
inline vf same_in_all(std::uint32_t bits) {
    typedef std::uint32_t words __attribute__((vector_size(4 * lanes), may_alias));
    return (vf)(words{} + bits);
}
/// Byte offsets of the float4 of a block starting at particle i, as the bits of lanes.
inline vf block_offsets(int i) {
    typedef int vi __attribute__((vector_size(4 * lanes), may_alias));
    return (vf)(*reinterpret_cast<const vi*>(block.byte_offset) + 16 * i);
}

}  // namespace
