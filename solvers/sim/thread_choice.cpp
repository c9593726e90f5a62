#include "sim/thread_choice.hpp"

#include "core/thread_count.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include <time.h>

namespace weir::sim {

namespace {

std::atomic<int> no_trials = 0;

double seconds(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

NoThreadTrials::NoThreadTrials() { ++no_trials; }
NoThreadTrials::~NoThreadTrials() { --no_trials; }

StepClock::StepClock() : wall_(seconds(CLOCK_MONOTONIC)), cpu_(seconds(CLOCK_THREAD_CPUTIME_ID)) {}
StepTime StepClock::elapsed() const { return {seconds(CLOCK_MONOTONIC) - wall_, seconds(CLOCK_THREAD_CPUTIME_ID) - cpu_}; }

void ThreadChoice::begin(Phase phase) {
    phase_ = phase;
    steps_ = 0;
    count_ = phase == Phase::other ? other_count() : chosen_;
}

/// From the fastest steps of both counts.
void ThreadChoice::decide(double other, double present) {
    if (other < worth * present) {
        chosen_ = other_count();
        if (chosen_ == 1) slowdown_ = present / other;
    }
    tried_ = true;
    since_ = 0;
    begin(Phase::steady);
}

void ThreadChoice::add(const StepTime& step) {
    watch(step);
    if (most_ <= 1 || thread_count_is_set()) return;
    if (no_trials > 0) {
        chosen_ = most_;
        begin(Phase::steady);
        return;
    }
    ++steps_;
    fastest_ = steps_ == 1 ? step.wall : std::min(fastest_, step.wall);
    if (phase_ != Phase::steady) return add_to_trial(step.wall);
    since_ += step.wall;
    if (tried_ && (steps_ < steps_between || cost_ > cost_allowed * since_)) return;
    recent_ = fastest_;
    cost_ = 0;
    begin(Phase::other);
}

void ThreadChoice::add_to_trial(double wall) {
    if (phase_ == Phase::present) {
        if (steps_ == steps_of_trial) decide(other_, fastest_);
        return;
    }
    cost_ += std::max(0.0, wall - recent_);
    other_ = fastest_;
    const bool to_more = count_ > 1;
    if (to_more && wall > hopeless * recent_) return decide(other_, recent_);
    if (steps_ < steps_of_trial) return;
    if (!to_more && recent_ > hopeless * most_ * other_) return decide(other_, recent_);  // the first step is cold: 2 is no proof
    begin(Phase::present);
}

void ThreadChoice::watch(const StepTime& step) {
    if (count_ == 1 || step.wall <= 2 * step.cpu) {
        waiting_ = 0, wall_ = 0, cpu_ = 0;
        return;
    }
    if (waiting_ < steps_of_waiting) ++waiting_, wall_ += step.wall, cpu_ += step.cpu;
}

std::string ThreadChoice::warning() {
    if (slowdown_ > hopeless && !warned_slow_) {
        warned_slow_ = true;
        return fmt::format(
            "a step on {} threads takes {:.1f} times as long as on one, because other processes are busy: the run continues with one "
            "thread and tries again later (--threads N fixes N)",
            most_, slowdown_);
    }
    if (waiting_ == steps_of_waiting && !warned_waiting_) {
        warned_waiting_ = true;
        return fmt::format(
            "steps on {} threads spend more time waiting than computing ({:.3g} of {:.3g} ms), because other processes are busy: --threads "
            "1 may be faster",
            count_, 1e3 * (wall_ - cpu_) / waiting_, 1e3 * wall_ / waiting_);
    }
    return {};
}

}  // namespace weir::sim
