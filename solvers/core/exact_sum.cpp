#include "core/exact_sum.hpp"

#include <algorithm>
#include <cmath>

namespace weir {

void ExactSum::carry() {
    constexpr std::int64_t mask = 0xffffffffLL, most = std::int64_t{1} << 33;
    pending_ = 0;
    if (first_ > last_) return;
    std::int64_t over = 0;
    for (std::size_t k = first_; k < last_; ++k) {
        const std::int64_t sum = chunks_[k] + over;
        chunks_[k] = sum & mask;
        over = sum >> 32;  // towards −infinity
    }
    chunks_[last_] += over;
    while (chunks_[last_] >= most || chunks_[last_] < -most) {
        over = chunks_[last_] >> 32;
        chunks_[last_] &= mask;
        chunks_[++last_] = over;
    }
}

/// Terms near the first one are added in a register of 128 bits.
void ExactSum::add(std::span<const real> terms) {
    constexpr int below = 30, window = 60;  // places of the register below the first term's, and in all
    constexpr std::size_t most = 512;       // 2^9 terms below 2^(53 + 60) stay below 2^122
    __extension__ typedef __int128 Register;
    for (std::size_t begin = 0; begin < terms.size(); begin += most) {
        Register sum = 0;
        int base = -1;
        for (const real term : terms.subspan(begin, std::min(most, terms.size() - begin))) {
            const auto bits = std::bit_cast<std::uint64_t>(term);
            if (bits << 1 == 0) continue;
            const int place = place_of(bits);
            if (base < 0) base = std::max(place - below, 0);
            if (static_cast<unsigned>(place - base) > static_cast<unsigned>(window) || (bits >> 52 & 0x7ff) == 0x7ff) {
                add(term);
                continue;
            }
            const Register shifted = static_cast<Register>(mantissa_of(bits)) << (place - base);
            sum += bits >> 63 != 0 ? -shifted : shifted;
        }
        const bool negative = sum < 0;
        if (negative) sum = -sum;
        constexpr int piece = 50;
        for (; sum != 0; sum >>= piece, base += piece)
            put(static_cast<std::uint64_t>(sum) & ((std::uint64_t{1} << piece) - 1), base, negative);
    }
}

void ExactSum::add(const ExactSum& other) {
    ExactSum carried = other;
    carried.carry();
    carry();
    for (std::size_t k = carried.first_; k <= carried.last_; ++k) chunks_[k] += carried.chunks_[k];
    first_ = std::min(first_, carried.first_), last_ = std::max(last_, carried.last_);
    carry();
    special_ += other.special_;
}

real ExactSum::value() const {
    if (special_ != 0 || std::isnan(special_)) return special_;
    ExactSum sum = *this;
    sum.carry();
    const auto highest = [&] {
        std::size_t k = sum.last_;
        while (k > sum.first_ && sum.chunks_[k] == 0) --k;
        return k;
    };
    if (sum.first_ > sum.last_) return 0;
    const bool negative = sum.chunks_[highest()] < 0;
    if (negative) {
        for (std::size_t k = sum.first_; k <= sum.last_; ++k) sum.chunks_[k] = -sum.chunks_[k];
        sum.carry();
    }
    // the highest 64 bits or more, and whether any bit below them is set
    __extension__ typedef unsigned __int128 Wide;
    const std::size_t top = highest(), lowest = top < 2 ? 0 : top - 2;
    Wide bits = 0;
    for (std::size_t k = top + 1; k-- > lowest;) bits = bits << 32 | static_cast<std::uint64_t>(sum.chunks_[k]);
    bool below = false;
    for (std::size_t k = sum.first_; k < lowest; ++k) below = below || sum.chunks_[k] != 0;
    int exponent = 32 * static_cast<int>(lowest);
    for (; bits >> 64 != 0; ++exponent) {
        below = below || (bits & 1) != 0;
        bits >>= 1;
    }
    const real rounded = std::ldexp(static_cast<real>(static_cast<std::uint64_t>(bits) | (below ? 1 : 0)), exponent - 1074);
    return negative ? -rounded : rounded;
}

}  // namespace weir
