// Ranks for a unit test without MPI (parallel/forked_ranks.hpp).
#pragma once
#include "parallel/forked_ranks.hpp"
#include "support/test.hpp"

#include <functional>
#include <string>

namespace weir::test {

/// body() as each of `count` ranks, each in a process of its own with one thread; what it expects in vain fails the test.
inline void on_ranks(int count, const std::function<void()>& body, bool poisons = false) {
    constexpr int seconds = 120;  // ends a rank that waits for one that has ended
    const auto ends = fork_ranks(
        count,
        [&](ForkedRanks&) {
            body();
            return std::string(testing::Test::HasFailure() ? "failed" : "");
        },
        poisons, seconds);
    for (std::size_t r = 0; r < ends.size(); ++r) {
        EXPECT_EQ(ends[r].status, 0) << "rank " << r << " of " << count;
        EXPECT_EQ(ends[r].said, "") << "rank " << r << " of " << count;
    }
}

}  // namespace weir::test
