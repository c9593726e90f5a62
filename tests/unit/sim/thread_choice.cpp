// Threads by measured time: steps of pretended length, on a machine that is quiet, busy, or becomes so.
#include "sim/thread_choice.hpp"

#include "core/parallel.hpp"
#include "support/test.hpp"

#include <vector>

namespace thread_choice_tests {

namespace {

using weir::sim::StepTime;
using weir::sim::ThreadChoice;

/// The time of `steps` steps [s] that take `one` seconds on one thread and `all` on all of them.
double run(ThreadChoice& choice, int steps, double one, double all) {
    double time = 0;
    for (int i = 0; i < steps; ++i) {
        const double wall = choice.count() == 1 ? one : all;
        choice.add({.wall = wall, .cpu = wall});
        time += wall;
    }
    return time;
}

TEST("on a quiet machine all threads are used, and trials cost little") {
    ThreadChoice choice(2);
    // One cold step, two on one thread, two on both; then at most 2% of the time, and one more trial that has begun.
    const double all = 0.01, one = 0.018, time = run(choice, 1000, one, all);
    EXPECT_EQ(choice.count(), 2);
    EXPECT_LE(time, 1000 * all * (1 + ThreadChoice::cost_allowed) + 4 * (one - all));
}

TEST("where threads cost time, one is used: in a run of 240 steps at most twice the time of one thread") {
    ThreadChoice choice(2);
    // A step of 72 x 36 cells beside a load of 16: 5.2 ms on one thread, 211 ms on two. The cold step and none other is taken on two.
    const double one = 5.2e-3, all = 211e-3, time = run(choice, 240, one, all);
    EXPECT_EQ(choice.count(), 1);
    EXPECT_LE(time, 2 * 240 * one);
    EXPECT_NE(choice.warning().find("one thread"), std::string::npos);
    EXPECT_EQ(choice.warning(), "");
}

TEST("a machine that becomes busy, and quiet again, is noticed") {
    ThreadChoice choice(4);
    run(choice, 50, 0.03, 0.01);
    EXPECT_EQ(choice.count(), 4);
    run(choice, 300, 0.03, 0.2);
    EXPECT_EQ(choice.count(), 1);
    run(choice, 3000, 0.03, 0.01);
    EXPECT_EQ(choice.count(), 4);
}

TEST("a number of threads that was set is kept, and a step that waits longer than it works is told once") {
    weir::set_threads(2);
    ThreadChoice choice(2);
    for (int i = 0; i < 50; ++i) choice.add({.wall = 0.2, .cpu = 0.01});
    EXPECT_EQ(choice.count(), 2);
    EXPECT_NE(choice.warning().find("--threads 1"), std::string::npos);
    EXPECT_EQ(choice.warning(), "");
    weir::set_threads(0);
}

TEST("who measures the time of steps is not disturbed by trials") {
    const weir::sim::NoThreadTrials none;
    ThreadChoice choice(2);
    for (int i = 0; i < 300; ++i) {
        EXPECT_EQ(choice.count(), 2);
        choice.add({.wall = 0.2, .cpu = 0.2});
    }
}

}  // namespace

}  // namespace thread_choice_tests
