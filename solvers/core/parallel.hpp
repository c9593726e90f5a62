// Threads: one static division of a range, and reductions whose result does not depend on the number of threads: sums are exact.
#pragma once
#include "core/exact_sum.hpp"
#include "core/types.hpp"

#include <cmath>
#include <span>
#include <vector>

#include <omp.h>

namespace weir {

/// Number of threads of every parallel loop of the library; at least 1. Default: OpenMP's own, or fewer where a simulation has too little
/// work for them (ProblemSizeScope). A number that was set is used as it is. Threads that wait for the next loop spin as long as OpenMP's
/// runtime lets them. A program that embeds the library sets GOMP_SPINCOUNT (or OMP_WAIT_POLICY) in its environment before it starts, since
/// libgomp reads them before main.
int threads();
int set_threads(int count);  // 0: the default again; returns the previous setting

/// Scope in which loops of the calling thread belong to a problem of this many cells. Below cells_per_thread cells per thread,
/// synchronization takes longer than the shared work saves. No effect where a number of threads was set.
class ProblemSizeScope {
public:
    static constexpr long cells_per_thread = 2048;
    explicit ProblemSizeScope(long cells);
    ~ProblemSizeScope();
    ProblemSizeScope(const ProblemSizeScope&) = delete;
    ProblemSizeScope& operator=(const ProblemSizeScope&) = delete;

private:
    int before_;
};

/// f(i) for i in [begin, end), in contiguous blocks, one per thread. f must write only data of entry i.
template <class F>
void parallel_for(int begin, int end, F&& f) {
#pragma omp parallel for schedule(static) num_threads(threads()) if (threads() > 1 && end - begin > 1)
    for (int i = begin; i < end; ++i) f(i);
}

namespace detail {
/// Scratch of the calling thread for the terms of reductions: grows, never shrinks, so that later steps allocate nothing.
std::vector<real>& reduction_scratch(std::size_t count);

/// NaN if any is NaN.
inline real largest_of(const std::vector<real>& part, int count) {
    real largest = -infinity;
    for (int i = 0; i < count; ++i) {
        const real value = part[static_cast<std::size_t>(i)];
        if (value > largest || std::isnan(value)) largest = value;
        if (std::isnan(largest)) break;
    }
    return largest;
}
}  // namespace detail

/// f(0) + f(1) + ... + f(count - 1), exact and rounded once. The terms are best sums of many entries each, in a fixed order.
template <class F>
real exact_sum(int count, F&& f) {
    auto& part = detail::reduction_scratch(static_cast<std::size_t>(count));
    parallel_for(0, count, [&](int i) { part[static_cast<std::size_t>(i)] = f(i); });
    ExactSum sum;
    sum.add(std::span<const real>(part).first(static_cast<std::size_t>(count)));
    return sum.value();
}

/// The largest of f(0) .. f(count - 1); NaN if any is NaN.
template <class F>
real parallel_max(int count, F&& f) {
    auto& part = detail::reduction_scratch(static_cast<std::size_t>(count));
    parallel_for(0, count, [&](int i) { part[static_cast<std::size_t>(i)] = f(i); });
    return detail::largest_of(part, count);
}

}  // namespace weir
