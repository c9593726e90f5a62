// Packs of N numbers in vector registers, by the compilers' vector extensions: one source for SSE2, AVX2 and AVX-512. Operations are
// lane-wise, so results do not depend on the width of the registers or on how a row is divided.
#pragma once
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

#define WEIR_INLINED __attribute__((always_inline))  // of a lambda
#define WEIR_INLINE inline WEIR_INLINED

namespace weir::simd {

template <class T, int N>
struct PackOf {
    using type __attribute__((vector_size(N * sizeof(T)))) = T;
};
template <class T, int N>
using Pack = typename PackOf<T, N>::type;
template <class V>
using Element = std::remove_cvref_t<decltype(std::declval<V&>()[0])>;
template <class V>
inline constexpr int width = sizeof(V) / sizeof(Element<V>);

using f16 = Pack<float, 16>;
using f8 = Pack<float, 8>;
using d8 = Pack<double, 8>;

// ---- memory

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

/// Loads the first `count` ≤ 8 values; the remaining lanes repeat the last one. No other value is accessed: it may belong to another
/// thread.
WEIR_INLINE d8 load_first(const double* from, int count) {
#ifdef __AVX512F__
    using Index = Pack<std::int64_t, 8>;
    const auto own = static_cast<__mmask8>((1u << count) - 1);
    const Index lane{0, 1, 2, 3, 4, 5, 6, 7}, last = Index{} + (count - 1), from_lane = lane < last ? lane : last;
    return _mm512_maskz_permutexvar_pd(0xff, reinterpret_cast<__m512i>(from_lane), _mm512_maskz_loadu_pd(own, from));
#else
    if (count == width<d8>) return load<d8>(from);
    d8 v;
    for (int l = 0; l < width<d8>; ++l) v[l] = from[l < count ? l : count - 1];
    return v;
#endif
}
/// Stores the first `count` ≤ 8 lanes.
WEIR_INLINE void store_first(double* to, const d8& v, int count) {
#ifdef __AVX512F__
    _mm512_mask_storeu_pd(to, static_cast<__mmask8>((1u << count) - 1), v);
#else
    if (count == width<d8>) return store(to, v);
    for (int l = 0; l < count; ++l) to[l] = v[l];
#endif
}

/// The same for any count: at most eight.
WEIR_INLINE d8 load(const double* from, int count) { return count >= width<d8> ? load<d8>(from) : load_first(from, count); }
WEIR_INLINE void store(double* to, const d8& v, int count) { count >= width<d8> ? store(to, v) : store_first(to, v, count); }

// ---- arithmetic

WEIR_INLINE f16 splat(float x) { return f16{} + x; }
/// As std::min and std::max: the first argument where both are equal.
template <class V>
WEIR_INLINE V smaller(const V& a, const V& b) {
    return b < a ? b : a;
}
template <class V>
WEIR_INLINE V larger(const V& a, const V& b) {
    return a < b ? b : a;
}
WEIR_INLINE d8 magnitude(const d8& a) {
    return reinterpret_cast<d8>(reinterpret_cast<Pack<std::int64_t, 8>>(a) & std::int64_t{0x7fffffffffffffff});
}
WEIR_INLINE double sum(const d8& v) { return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])); }

// ---- tests of all lanes

/// `flags`: results of comparisons, −1 or 0 in each lane.
template <class Flags>
WEIR_INLINE bool all(const Flags& flags) {
    Element<Flags> every = -1;
    for (int i = 0; i < width<Flags>; ++i) every &= flags[i];
    return every != 0;
}
/// Returns whether |v| is at most `limit` in every lane; false for NaN.
WEIR_INLINE bool all_within(const d8& v, double limit) {
#ifdef __AVX512F__
    return _mm512_cmp_pd_mask(_mm512_abs_pd(v), _mm512_set1_pd(limit), _CMP_LE_OQ) == 0xff;
#else
    bool within = true;
    for (int l = 0; l < width<d8>; ++l) within = within && v[l] <= limit && v[l] >= -limit;
    return within;
#endif
}
/// The common sign of all lanes.
enum class Side { below = -1, on = 0, above = 1, both = 2 };
WEIR_INLINE Side side_of(const d8& d) {
    constexpr int lanes = width<d8>;
#ifdef __AVX512F__
    constexpr unsigned all = (1U << lanes) - 1U;
    const auto v = reinterpret_cast<__m512d>(d);
    const unsigned above = _mm512_cmp_pd_mask(v, _mm512_setzero_pd(), _CMP_GT_OQ);
    const unsigned below = _mm512_cmp_pd_mask(v, _mm512_setzero_pd(), _CMP_LT_OQ);
    return above == all ? Side::above : below == all ? Side::below : (above | below) == 0 ? Side::on : Side::both;
#else
    int above = 0, below = 0;
    for (int l = 0; l < lanes; ++l) above += d[l] > 0, below += d[l] < 0;
    return above == lanes ? Side::above : below == lanes ? Side::below : above + below == 0 ? Side::on : Side::both;
#endif
}

// ---- conversions: those of the compilers use half vectors or single elements; AVX-512 has one instruction for each

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
WEIR_INLINE f16 to_float(const std::uint8_t* p) {
    return __builtin_convertvector(__builtin_convertvector(load<Pack<std::uint8_t, 16>>(p), Pack<std::int32_t, 16>), f16);
}
WEIR_INLINE d8 to_double(const std::uint8_t* p) {
    return __builtin_convertvector(__builtin_convertvector(load<Pack<std::uint8_t, 8>>(p), Pack<std::int32_t, 8>), d8);
}
#endif

WEIR_INLINE f16 load16(const float* p) { return load<f16>(p); }
WEIR_INLINE d8 load8(const float* p) { return widen(load<f8>(p)); }
WEIR_INLINE d8 load8(const double* p) { return load<d8>(p); }
WEIR_INLINE void store8(double* p, const d8& v) { store(p, v); }
WEIR_INLINE d8 low(const f16& v) { return widen(lower(v)); }
WEIR_INLINE d8 high(const f16& v) { return widen(upper(v)); }
WEIR_INLINE f16 join(const d8& a, const d8& b) { return beside(narrow(a), narrow(b)); }

// ---- permutations

/// table[code[i]] for 16 codes below 16.
WEIR_INLINE f16 look_up(const float* table, const std::uint8_t* code) {
#ifdef __AVX512F__
    return _mm512_permutexvar_ps(_mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(code))), load<f16>(table));
#else
    f16 v;
    for (int i = 0; i < width<f16>; ++i) v[i] = table[code[i]];
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

}  // namespace weir::simd
