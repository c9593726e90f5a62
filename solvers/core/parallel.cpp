#include "core/parallel.hpp"

#include <algorithm>

namespace weir {

namespace {
int chosen_threads = 0;  // 0: not chosen yet
}

int threads() {
    if (chosen_threads == 0) chosen_threads = std::max(1, omp_get_max_threads());
    return chosen_threads;
}

void set_threads(int count) { chosen_threads = std::max(1, count); }

namespace detail {
std::vector<real>& reduction_scratch(std::size_t count) {
    thread_local std::vector<real> scratch;
    if (scratch.size() < count) scratch.resize(count);
    return scratch;
}
}  // namespace detail

}  // namespace weir
