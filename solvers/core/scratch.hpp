// Vectors whose size changes from step to step. They grow by at least an eighth of their capacity: slowly growing sizes then allocate a few
// times instead of in every step (std::vector::assign allocates exactly). The memory of a solver stays within an eighth of what it needs.
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
