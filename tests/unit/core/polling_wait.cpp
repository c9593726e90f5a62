// How ranks wait for one another: by polls where the processor is their own, asleep where other processes are busy.
#include "distributed/polling_wait.hpp"

#include "support/test.hpp"

namespace {

using weir::distributed::PollingWait;
using clock_type = std::chrono::steady_clock;
using std::chrono::microseconds;
using std::chrono::milliseconds;

/// The calls that a wait makes which is done after some time, each of which takes the processor away for a while.
int calls_until(PollingWait& wait, microseconds done_after, microseconds away) {
    const auto start = clock_type::now();
    int calls = 0;
    wait.until([&] {
        ++calls;
        if (away.count() > 0) std::this_thread::sleep_for(away);
        return clock_type::now() - start >= done_after;
    });
    return calls;
}

TEST("a wait polls for as long as it may, and sleeps between polls from then on") {
    // A poll takes less than 2 us even here, a nap at least 20 us. Three tries: another process may take the processor in one.
    int most = 0;
    for (int tries = 0; tries < 3; ++tries) {
        PollingWait wait(milliseconds(2));
        most = std::max(most, calls_until(wait, milliseconds(1), microseconds(0)));
    }
    EXPECT_GT(most, 500);
    PollingWait never(microseconds(0));
    EXPECT_LE(calls_until(never, milliseconds(4), microseconds(0)), 202);  // 4 ms of naps
    EXPECT_EQ(never.busy_seconds(), 0);
}

TEST("a poll that loses the processor is the last for a second: waits sleep at once, and the time is reported") {
    PollingWait wait(milliseconds(2));
    EXPECT_EQ(calls_until(wait, microseconds(0), milliseconds(1)), 1);  // done at once: no wait
    EXPECT_EQ(wait.busy_seconds(), 0);
    calls_until(wait, milliseconds(3), milliseconds(1));
    EXPECT_LE(calls_until(wait, milliseconds(4), microseconds(0)), 202);  // naps of 20 us or more
    EXPECT_GT(wait.busy_seconds(), 0.004);
    EXPECT_LT(wait.busy_seconds(), 1);
    PollingWait short_polls(microseconds(100));
    calls_until(short_polls, milliseconds(3), milliseconds(1));
    EXPECT_EQ(short_polls.busy_seconds(), 0);  // it sleeps soon enough
    std::this_thread::sleep_for(milliseconds(1000));
    EXPECT_EQ(wait.busy_seconds(), 1);
    int most = 0;  // it polls again
    for (int tries = 0; tries < 3; ++tries) most = std::max(most, calls_until(wait, milliseconds(1), microseconds(0)));
    EXPECT_GT(most, 500);
}

}  // namespace
