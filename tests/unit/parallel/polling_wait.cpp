// How ranks wait for one another: by polls where the processor is their own, asleep where other processes are busy. On clocks of the test's
// own, so that nothing depends on who else is busy.
#include "parallel/mpi/polling_wait.hpp"

#include "support/test.hpp"

namespace polling_wait_tests {

namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// Time that passes by polls, yields and naps alone.
struct TestTimes {
    using duration = std::chrono::steady_clock::duration;
    static inline duration clock{}, processor{};
    static inline int naps = 0;
    static duration now() { return clock; }
    static duration own() { return processor; }
    static void nap(microseconds time) { clock += time, ++naps; }
    static void yield() {}
    /// Another process has the processor.
    static void lose(duration time) { clock += time; }
    static void work(duration time) { clock += time, processor += time; }
};
using Wait = weir::distributed::PollingWaitBy<TestTimes>;

/// The polls that a wait makes which is done after some time; each works for a microsecond and loses the processor for a while.
int polls_until(Wait& wait, microseconds done_after, microseconds away = microseconds(0)) {
    const auto start = TestTimes::clock;
    TestTimes::naps = 0;
    int calls = 0;
    wait.until([&] {
        ++calls;
        TestTimes::work(microseconds(1)), TestTimes::lose(away);
        return TestTimes::clock - start >= done_after;
    });
    return calls - TestTimes::naps;
}

TEST("a wait polls for as long as it may, and sleeps between polls from then on") {
    Wait wait(milliseconds(2));
    EXPECT_EQ(polls_until(wait, milliseconds(1)), 1000);
    EXPECT_EQ(TestTimes::naps, 0);
    EXPECT_NEAR(polls_until(wait, milliseconds(3)), 2000, 2);  // one before the polls, one before the first nap
    EXPECT_NEAR(TestTimes::naps, 1000 / 21, 1);                // of 20 us, and a poll each
    Wait never(microseconds(0));
    EXPECT_LE(polls_until(never, milliseconds(4)), 2);
    EXPECT_EQ(never.busy_seconds(), 0);
}

TEST("after a poll that loses the processor waits sleep at once for 10 ms, and the time is reported") {
    Wait wait(milliseconds(2));
    EXPECT_EQ(polls_until(wait, microseconds(0), milliseconds(1)), 1);  // done at once: no wait
    EXPECT_EQ(wait.busy_seconds(), 0);
    polls_until(wait, milliseconds(3), milliseconds(1));
    const double before = wait.busy_seconds();
    EXPECT_LE(polls_until(wait, milliseconds(4)), 2);
    EXPECT_NEAR(wait.busy_seconds() - before, 0.004, 5e-5);
    TestTimes::lose(milliseconds(10));
    EXPECT_NEAR(wait.busy_seconds(), 0.01, 1e-9);
    EXPECT_EQ(polls_until(wait, milliseconds(1)), 1000);  // it polls again
    Wait little(milliseconds(2));
    polls_until(little, milliseconds(1), microseconds(1));  // in all 0.5 ms, as interrupts take
    EXPECT_EQ(little.busy_seconds(), 0);
    Wait short_polls(microseconds(100));
    polls_until(short_polls, milliseconds(3), milliseconds(1));
    EXPECT_EQ(short_polls.busy_seconds(), 0);  // it sleeps soon enough
}

TEST("losses that come soon after one another double the time without polls, up to a second; a rare one does not") {
    Wait wait(milliseconds(2));
    const auto next = [&](microseconds after) {  // a loss that comes so long after the last while of sleep
        const double before = wait.busy_seconds();
        TestTimes::lose(after);
        polls_until(wait, milliseconds(3), milliseconds(1));
        while (polls_until(wait, microseconds(100)) < 50) {  // until it polls again
        }
        return wait.busy_seconds() - before;
    };
    double expected = 0.01;
    for (int loss = 0; loss < 9; ++loss, expected = std::min(2 * expected, 1.0)) EXPECT_NEAR(next(microseconds(0)), expected, 1e-3);
    EXPECT_NEAR(next(milliseconds(1100)), 0.01, 1e-3);
}

}  // namespace

}  // namespace polling_wait_tests
