// Exact sums of numbers in double precision: the result is the exact sum, rounded once. It depends neither on the order of the terms nor on
// how they are distributed over threads and ranks. A fixed-point accumulator over the whole range of exponents, in chunks of 32 bits with
// 31 bits for carries (Neal 2015, "Fast exact summation using small and large superaccumulators", section 2; Kulisch 1966).
#pragma once
#include "core/types.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

/// Plain data: sums of several ranks may be sent and added.
class ExactSum {
public:
    /// Infinities and NaN are summed apart: the result is then that of IEEE addition.
    void add(real term) {
        const auto bits = std::bit_cast<std::uint64_t>(term);
        if ((bits >> 52 & 0x7ff) == 0x7ff)
            special_ += term;
        else
            put(mantissa_of(bits), place_of(bits), bits >> 63 != 0);
    }
    /// The same for many terms; about 1.5 ns each where their magnitudes are within 2^±30 of the first one's.
    void add(std::span<const real> terms);
    void add(const ExactSum& other);  ///< The terms of another sum.
    /// The sum, rounded to nearest, ties to even. (A subnormal result may be rounded twice.)
    real value() const;

private:
    // A finite number is ± mantissa 2^(place − 1074).
    static std::uint64_t mantissa_of(std::uint64_t bits) {
        return (bits & 0xfffffffffffffULL) | ((bits >> 52 & 0x7ff) > 0 ? std::uint64_t{1} << 52 : 0);
    }
    static int place_of(std::uint64_t bits) {
        const int exponent = static_cast<int>(bits >> 52 & 0x7ff);
        return exponent > 0 ? exponent - 1 : 0;
    }
    void put(std::uint64_t mantissa, int place, bool negative) {
        const int shift = place & 31;
        const auto low = static_cast<std::int64_t>(mantissa << shift & 0xffffffffULL);
        const auto high = static_cast<std::int64_t>(mantissa >> (32 - shift));
        const auto k = static_cast<std::size_t>(place >> 5);
        chunks_[k] += negative ? -low : low, chunks_[k + 1] += negative ? -high : high;
        first_ = k < first_ ? k : first_, last_ = k + 1 > last_ ? k + 1 : last_;
        if (++pending_ == most_pending) carry();
    }
    /// |high| < 2^53 each time: 2^9 terms stay below 2^62.
    static constexpr int most_pending = 512;
    /// Every chunk in use into [0, 2^32), but for the highest one, whose sign is that of the sum.
    void carry();

    // 2^−1074 to 2^1024, and 2^41 terms more: 66 chunks of 32 bits, and one for the sign
    std::array<std::int64_t, 67> chunks_{};
    std::size_t first_ = 66, last_ = 0;  // chunks in use; first_ > last_: none
    real special_ = 0;
    std::int64_t pending_ = 0;
};

/// Exact sums of each component of T, a struct of real numbers.
template <class T>
class ExactSums {
public:
    void add(const T& terms) {  ///< One term of each component.
        const auto list = std::bit_cast<Reals>(terms);
        for (std::size_t i = 0; i < list.size(); ++i) sums_[i].add(list[i]);
    }
    /// The sum of the i-th component.
    ExactSum& of(std::size_t i) { return sums_[i]; }
    void add(const ExactSums& other) {  ///< The terms of other sums.
        for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i].add(other.sums_[i]);
    }
    T value() const {  ///< The sums, each rounded once.
        Reals list;
        for (std::size_t i = 0; i < list.size(); ++i) list[i] = sums_[i].value();
        return std::bit_cast<T>(list);
    }

private:
    using Reals = std::array<real, sizeof(T) / sizeof(real)>;
    static_assert(sizeof(T) % sizeof(real) == 0);
    std::array<ExactSum, sizeof(T) / sizeof(real)> sums_{};
};

}  // namespace weir
