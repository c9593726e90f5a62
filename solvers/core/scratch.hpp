// Vectors whose size changes from step to step: when their room is too small they get an eighth more than they had, at least, so that sizes
// which creep up allocate a handful of times and not in every step (assign of the standard library makes exact room), and what a solver
// holds stays within an eighth of what it needs.
#pragma once
#include <algorithm>
#include <vector>

namespace weir {

/// v.resize(n); new elements are zero.
template <class T>
void resize_scratch(std::vector<T>& v, std::size_t n) {
    if (n > v.capacity()) v.reserve(std::max(n, v.capacity() + v.capacity() / 8));
    v.resize(n);
}

/// v.assign(n, value).
template <class T>
void refill_scratch(std::vector<T>& v, std::size_t n, T value) {
    resize_scratch(v, n);
    std::fill(v.begin(), v.end(), value);
}

}  // namespace weir
