// SIMD over eight nodes of a row, by the compilers' vector extensions: one source for SSE2, AVX2 and AVX-512. Operations are lane-wise, so
// results do not depend on the vector width or on how a row is divided.
#pragma once
#include "core/types.hpp"

#include <cstdint>
#include <cstring>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace weir::staggered {

inline constexpr int lanes = 8;
using Lanes = real __attribute__((vector_size(lanes * sizeof(real))));

[[gnu::always_inline]] inline Lanes load(const real* from) {
    Lanes v;
    std::memcpy(&v, from, sizeof v);
    return v;
}
/// Loads the first `count` values; the remaining lanes repeat the last one.
[[gnu::always_inline]] inline Lanes load(const real* from, int count) {
    if (count >= lanes) return load(from);
    Lanes v;
    for (int l = 0; l < lanes; ++l) v[l] = from[l < count ? l : count - 1];
    return v;
}
[[gnu::always_inline]] inline void store(real* to, const Lanes& v) { std::memcpy(to, &v, sizeof v); }
/// Stores the first `count` lanes.
[[gnu::always_inline]] inline void store(real* to, const Lanes& v, int count) {
    if (count >= lanes) return store(to, v);
    for (int l = 0; l < count; ++l) to[l] = v[l];
}

/// 0, 1, 2 ..
[[gnu::always_inline]] inline Lanes counting() { return Lanes{0, 1, 2, 3, 4, 5, 6, 7}; }
/// As std::min and std::max: the first argument where both are equal.
[[gnu::always_inline]] inline Lanes smaller(const Lanes& a, const Lanes& b) { return b < a ? b : a; }
[[gnu::always_inline]] inline Lanes larger(const Lanes& a, const Lanes& b) { return a < b ? b : a; }
[[gnu::always_inline]] inline Lanes magnitude(const Lanes& a) {
    using Bits = std::int64_t __attribute__((vector_size(lanes * sizeof(std::int64_t))));
    return reinterpret_cast<Lanes>(reinterpret_cast<Bits>(a) & std::int64_t{0x7fffffffffffffff});
}

/// The common sign of all lanes.
enum class Side { below = -1, on = 0, above = 1, both = 2 };
[[gnu::always_inline]] inline Side side_of(const Lanes& d) {
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

}  // namespace weir::staggered
