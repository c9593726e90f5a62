#include "core/parallel.hpp"

#include "core/thread_count.hpp"

#include <algorithm>
#include <utility>

namespace weir {

namespace {
int chosen_threads = 0;              // 0: no number was set
thread_local int worth_of_work = 0;  // 0: unknown
}  // namespace

int threads() {
    static const int available = std::clamp(omp_get_max_threads(), 1, most_threads);
    if (chosen_threads > 0) return chosen_threads;
    return worth_of_work > 0 ? std::min(worth_of_work, available) : available;
}

int set_threads(int count) { return std::exchange(chosen_threads, std::clamp(count, 0, most_threads)); }

ProblemSizeScope::ProblemSizeScope(long cells) : before_(worth_of_work) {
    worth_of_work = static_cast<int>(std::clamp<long>(cells / cells_per_thread, 1, 1 << 20));
}
ProblemSizeScope::~ProblemSizeScope() { worth_of_work = before_; }

bool thread_count_is_set() { return chosen_threads > 0; }

ThreadCountScope::ThreadCountScope(int most) : before_(std::exchange(worth_of_work, std::max(1, most))) {}
ThreadCountScope::~ThreadCountScope() { worth_of_work = before_; }

namespace detail {
std::vector<real>& reduction_scratch(std::size_t count) {
    thread_local std::vector<real> scratch;
    if (scratch.size() < count) scratch.resize(count);
    return scratch;
}
}  // namespace detail

}  // namespace weir
