// Sixteen floats or eight doubles at a time, by the compilers' vector extensions: one source for SSE2, AVX2 and AVX-512.
#pragma once
#include <cstdint>
#include <cstring>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace weir::poisson {

inline constexpr int lanes = 16;

using f16 = float __attribute__((vector_size(64)));
using f8 = float __attribute__((vector_size(32)));
using d8 = double __attribute__((vector_size(64)));
using u8x16 = std::uint8_t __attribute__((vector_size(16)));
using u8x8 = std::uint8_t __attribute__((vector_size(8)));
using i32x16 = std::int32_t __attribute__((vector_size(64)));
using i32x8 = std::int32_t __attribute__((vector_size(32)));

#define WEIR_INLINE inline __attribute__((always_inline))
#define WEIR_INLINED __attribute__((always_inline))  // of a lambda

template <class V>
WEIR_INLINE V load(const void* from) {
    V v;
    std::memcpy(&v, from, sizeof v);
    return v;
}
template <class V, class T>
WEIR_INLINE void store(T* to, const V& v) {
    std::memcpy(to, &v, sizeof v);
}
WEIR_INLINE f16 load16(const float* p) { return load<f16>(p); }

// the compilers' own conversions between widths use half vectors or even single elements; AVX-512 has one instruction for each
#ifdef __AVX512F__
WEIR_INLINE d8 widen(const f8& v) { return _mm512_cvtps_pd(v); }
WEIR_INLINE f8 narrow(const d8& v) { return _mm512_cvtpd_ps(v); }
WEIR_INLINE f8 lower(const f16& v) { return _mm512_castps512_ps256(v); }
WEIR_INLINE f8 upper(const f16& v) { return _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(v), 1)); }
WEIR_INLINE f16 beside(const f8& a, const f8& b) {
    return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(a)), _mm256_castps_pd(b), 1));
}
WEIR_INLINE f16 to_float(const std::uint8_t* p) {
    return _mm512_cvtepi32_ps(_mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))));
}
WEIR_INLINE d8 to_double(const std::uint8_t* p) {
    return _mm512_cvtepi32_pd(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p))));
}
#else
WEIR_INLINE d8 widen(const f8& v) { return __builtin_convertvector(v, d8); }
WEIR_INLINE f8 narrow(const d8& v) { return __builtin_convertvector(v, f8); }
WEIR_INLINE f8 lower(const f16& v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7); }
WEIR_INLINE f8 upper(const f16& v) { return __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15); }
WEIR_INLINE f16 beside(const f8& a, const f8& b) {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
WEIR_INLINE f16 to_float(const std::uint8_t* p) { return __builtin_convertvector(__builtin_convertvector(load<u8x16>(p), i32x16), f16); }
WEIR_INLINE d8 to_double(const std::uint8_t* p) { return __builtin_convertvector(__builtin_convertvector(load<u8x8>(p), i32x8), d8); }
#endif

WEIR_INLINE d8 load8(const float* p) { return widen(load<f8>(p)); }
WEIR_INLINE d8 load8(const double* p) { return load<d8>(p); }
WEIR_INLINE void store8(double* p, const d8& v) { store(p, v); }
WEIR_INLINE d8 low(const f16& v) { return widen(lower(v)); }
WEIR_INLINE d8 high(const f16& v) { return widen(upper(v)); }
WEIR_INLINE f16 join(const d8& a, const d8& b) { return beside(narrow(a), narrow(b)); }

/// table[code[i]] for 16 codes below 16.
WEIR_INLINE f16 look_up(const float* table, const std::uint8_t* code) {
#ifdef __AVX512F__
    return _mm512_permutexvar_ps(_mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(code))), load<f16>(table));
#else
    f16 v;
    for (int i = 0; i < lanes; ++i) v[i] = table[code[i]];
    return v;
#endif
}

/// Elements of even and of odd position among 32.
WEIR_INLINE f16 evens(const f16& a, const f16& b) {
    return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
}
WEIR_INLINE f16 odds(const f16& a, const f16& b) {
    return __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
}
/// a0 b0 a1 b1 ...
WEIR_INLINE f16 zip(const f8& a, const f8& b) {
    return __builtin_shufflevector(a, b, 0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15);
}

WEIR_INLINE f16 splat(float x) { return f16{} + x; }
WEIR_INLINE double sum(const d8& v) { return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])); }

}  // namespace weir::poisson
