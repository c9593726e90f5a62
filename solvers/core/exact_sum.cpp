#include "core/exact_sum.hpp"

#include <cmath>

namespace weir {

void ExactSum::carry() {
    std::int64_t over = 0;
    for (std::size_t k = 0; k + 1 < chunks_.size(); ++k) {
        const std::int64_t sum = chunks_[k] + over;
        chunks_[k] = sum & 0xffffffffLL;
        over = sum >> 32;  // towards −infinity
    }
    chunks_.back() += over;
    pending_ = 0;
}

void ExactSum::add(const ExactSum& other) {
    ExactSum carried = other;
    carried.carry();
    carry();
    for (std::size_t k = 0; k < chunks_.size(); ++k) chunks_[k] += carried.chunks_[k];
    carry();
    special_ += other.special_;
}

real ExactSum::value() const {
    if (special_ != 0 || std::isnan(special_)) return special_;
    ExactSum sum = *this;
    sum.carry();
    const bool negative = sum.chunks_.back() < 0;
    if (negative) {
        for (auto& chunk : sum.chunks_) chunk = -chunk;
        sum.carry();
    }
    std::size_t top = sum.chunks_.size() - 1;
    while (top > 0 && sum.chunks_[top] == 0) --top;
    // the highest 64 bits, and whether any bit below them is set
    __extension__ typedef unsigned __int128 Wide;
    Wide bits = 0;
    bool below = false;
    for (std::size_t k = top + 1; k-- > 0;) {
        if (k + 3 > top)  // top, top − 1, top − 2
            bits = bits << 32 | static_cast<std::uint64_t>(sum.chunks_[k]);
        else
            below = below || sum.chunks_[k] != 0;
    }
    int exponent = top < 2 ? 0 : 32 * (static_cast<int>(top) - 2);
    while (bits >> 64 != 0) {
        below = below || (bits & 1) != 0;
        bits >>= 1;
        ++exponent;
    }
    const auto highest = static_cast<std::uint64_t>(bits) | (below ? 1 : 0);
    const real rounded = std::ldexp(static_cast<real>(highest), exponent - 1074);
    return negative ? -rounded : rounded;
}

}  // namespace weir
