// SIMD lanes of floats for one instruction set, selected by the macro WEIR_ISA (512: AVX-512, 256: AVX2 and FMA, 128: SSE2). It is apart from
// core/simd.hpp because this text is compiled three times with the flags of three processors: everything here is internal to the including
// file and uses no inline function of std or of another header. One compiled for a newer processor could otherwise be linked into the path
// of an older one. Its width is that of the registers, while core/simd.hpp has the same width for all.
#pragma once
#include <immintrin.h>
#include <cstdint>

/// Without it compilers generate calls and pass registers through memory.
#define WEIR_ALWAYS [[gnu::always_inline]] inline

namespace {

#if WEIR_ISA == 512
inline constexpr int lanes = 16;
#elif WEIR_ISA == 256
inline constexpr int lanes = 8;
#else
inline constexpr int lanes = 4;
#endif

typedef float vf __attribute__((vector_size(4 * lanes), may_alias));
typedef int whole __attribute__((vector_size(4 * lanes), may_alias));

/// The same number of doubles.
typedef double vd __attribute__((vector_size(8 * lanes), may_alias));

/// The four components of `lanes` particles.
struct Four {
    vf x, y, z, w;
};

inline const float* at(const float* base, std::uint32_t byte_offset) {
    return reinterpret_cast<const float*>(reinterpret_cast<const char*>(base) + byte_offset);
}

#if WEIR_ISA == 512

inline vf broadcast(float a) { return (vf)_mm512_set1_ps(a); }
inline vf max0(vf a) { return (vf)_mm512_max_ps((__m512)a, _mm512_setzero_ps()); }
inline vf lower(vf a, vf b) { return (vf)_mm512_min_ps((__m512)a, (__m512)b); }
inline vf higher(vf a, vf b) { return (vf)_mm512_max_ps((__m512)a, (__m512)b); }
/// a b + c and c - a b, rounded once.
inline vf fma(vf a, vf b, vf c) { return (vf)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c); }
inline vf fnma(vf a, vf b, vf c) { return (vf)_mm512_fnmadd_ps((__m512)a, (__m512)b, (__m512)c); }
/// Combines four quarters, one per particle, into one register, by halves: faster than a masked broadcast for each.
WEIR_ALWAYS __m256 half(const float* base, std::uint32_t first, std::uint32_t second) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(at(base, first))), _mm_load_ps(at(base, second)), 1);
}
WEIR_ALWAYS __m512 quarters(const float* base, const std::uint32_t* o) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(half(base, o[0], o[4])), half(base, o[8], o[12]), 1);
}
/// Gathers by 128-bit loads and a 4 x 4 transpose in each quarter: a hardware gather doubles the time of every pass.
WEIR_ALWAYS Four gather(const float* base, const std::uint32_t* o) {
    const __m512 a = quarters(base, o), b = quarters(base, o + 1), c = quarters(base, o + 2), d = quarters(base, o + 3);
    const __m512 ab_lo = _mm512_unpacklo_ps(a, b), ab_hi = _mm512_unpackhi_ps(a, b);
    const __m512 cd_lo = _mm512_unpacklo_ps(c, d), cd_hi = _mm512_unpackhi_ps(c, d);
    return {(vf)_mm512_shuffle_ps(ab_lo, cd_lo, 0x44), (vf)_mm512_shuffle_ps(ab_lo, cd_lo, 0xee), (vf)_mm512_shuffle_ps(ab_hi, cd_hi, 0x44),
            (vf)_mm512_shuffle_ps(ab_hi, cd_hi, 0xee)};
}

#elif WEIR_ISA == 256

inline vf broadcast(float a) { return (vf)_mm256_set1_ps(a); }
inline vf max0(vf a) { return (vf)_mm256_max_ps((__m256)a, _mm256_setzero_ps()); }
inline vf lower(vf a, vf b) { return (vf)_mm256_min_ps((__m256)a, (__m256)b); }
inline vf higher(vf a, vf b) { return (vf)_mm256_max_ps((__m256)a, (__m256)b); }
inline vf fma(vf a, vf b, vf c) { return (vf)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c); }
inline vf fnma(vf a, vf b, vf c) { return (vf)_mm256_fnmadd_ps((__m256)a, (__m256)b, (__m256)c); }
WEIR_ALWAYS __m256 halves(const float* base, const std::uint32_t* o) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(at(base, o[0]))), _mm_load_ps(at(base, o[4])), 1);
}
WEIR_ALWAYS Four gather(const float* base, const std::uint32_t* o) {
    const __m256 a = halves(base, o), b = halves(base, o + 1), c = halves(base, o + 2), d = halves(base, o + 3);
    const __m256 ab_lo = _mm256_unpacklo_ps(a, b), ab_hi = _mm256_unpackhi_ps(a, b);
    const __m256 cd_lo = _mm256_unpacklo_ps(c, d), cd_hi = _mm256_unpackhi_ps(c, d);
    return {(vf)_mm256_shuffle_ps(ab_lo, cd_lo, 0x44), (vf)_mm256_shuffle_ps(ab_lo, cd_lo, 0xee), (vf)_mm256_shuffle_ps(ab_hi, cd_hi, 0x44),
            (vf)_mm256_shuffle_ps(ab_hi, cd_hi, 0xee)};
}

#else

inline vf broadcast(float a) { return (vf)_mm_set1_ps(a); }
inline vf max0(vf a) { return (vf)_mm_max_ps((__m128)a, _mm_setzero_ps()); }
inline vf lower(vf a, vf b) { return (vf)_mm_min_ps((__m128)a, (__m128)b); }
inline vf higher(vf a, vf b) { return (vf)_mm_max_ps((__m128)a, (__m128)b); }
/// SSE2 has no FMA: its results differ in the last bits from the other sets.
inline vf fma(vf a, vf b, vf c) { return a * b + c; }
inline vf fnma(vf a, vf b, vf c) { return c - a * b; }
WEIR_ALWAYS Four gather(const float* base, const std::uint32_t* o) {
    __m128 a = _mm_load_ps(at(base, o[0])), b = _mm_load_ps(at(base, o[1])), c = _mm_load_ps(at(base, o[2])),
           d = _mm_load_ps(at(base, o[3]));
    _MM_TRANSPOSE4_PS(a, b, c, d);
    return {(vf)a, (vf)b, (vf)c, (vf)d};
}

#endif

inline vf lanes_of(vf a) { return a; }
inline vf lanes_of(float a) { return broadcast(a); }
inline vf square_length(vf x, vf y, vf z) { return fma(z, z, fma(y, y, x * x)); }
/// 0 in the lanes whose gate is not positive.
inline vf where_positive(vf gate, vf value) { return (vf)((whole)value & (gate > broadcast(0))); }

/// Particles first, first + 1, ... of an array of four floats each.
inline Four load(const float* base, int first) {
    std::uint32_t o[lanes];
    for (int l = 0; l < lanes; ++l) o[l] = static_cast<std::uint32_t>(16 * (first + l));
    return gather(base, o);
}

/// Writes the first `count` lanes.
inline void store(float* base, int first, int count, const Four& f) {
    typedef float four __attribute__((vector_size(16), may_alias));
    alignas(64) float lane[4][lanes];
    *reinterpret_cast<vf*>(lane[0]) = f.x;
    *reinterpret_cast<vf*>(lane[1]) = f.y;
    *reinterpret_cast<vf*>(lane[2]) = f.z;
    *reinterpret_cast<vf*>(lane[3]) = f.w;
    for (int l = 0; l < lanes; l += 4) {
        __m128 a = _mm_load_ps(lane[0] + l), b = _mm_load_ps(lane[1] + l), c = _mm_load_ps(lane[2] + l), d = _mm_load_ps(lane[3] + l);
        _MM_TRANSPOSE4_PS(a, b, c, d);
        const __m128 out[4] = {a, b, c, d};
        for (int k = 0; k < 4 && l + k < count; ++k) *reinterpret_cast<four*>(base + 4 * (first + l + k)) = (four)out[k];
    }
}

/// Returns whether any lane is below a bound.
inline bool any_below(vf a, float bound) {
#if WEIR_ISA == 512
    return _mm512_cmp_ps_mask((__m512)a, _mm512_set1_ps(bound), _CMP_LT_OQ) != 0;
#elif WEIR_ISA == 256
    return _mm256_movemask_ps(_mm256_cmp_ps((__m256)a, _mm256_set1_ps(bound), _CMP_LT_OQ)) != 0;
#else
    return _mm_movemask_ps(_mm_cmplt_ps((__m128)a, _mm_set1_ps(bound))) != 0;
#endif
}

}  // namespace
