// Vectors whose size changes from step to step: their room at least doubles when it is too small, so that sizes which creep up allocate
// a handful of times and not in every step (resize and assign of the standard library make exact room).
#pragma once
#include <algorithm>
#include <vector>

namespace weir {

/// v.resize(n); new elements are zero.
template <class T>
void resize_scratch(std::vector<T>& v, std::size_t n) {
    if (n > v.capacity()) v.reserve(std::max(n, 2 * v.capacity()));
    v.resize(n);
}

/// v.assign(n, value).
template <class T>
void refill_scratch(std::vector<T>& v, std::size_t n, T value) {
    resize_scratch(v, n);
    std::fill(v.begin(), v.end(), value);
}

}  // namespace weir
