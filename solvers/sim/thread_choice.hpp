// Chooses the number of threads for the steps of a simulation by measured time. Where other processes are busy, threads that wait for one
// another may take longer than a single thread.
#pragma once
#include <string>

namespace weir::sim {

/// Scope in which every ThreadChoice keeps its largest count: for programs that measure the time of steps.
class NoThreadTrials {
public:
    NoThreadTrials();
    ~NoThreadTrials();
    NoThreadTrials(const NoThreadTrials&) = delete;
    NoThreadTrials& operator=(const NoThreadTrials&) = delete;
};

/// The time of one step, seen from the thread that called it.
struct StepTime {
    double wall = 0;  // [s]
    double cpu = 0;   // [s], of the calling thread; it waited for the rest of `wall`
};

/// Measures from construction on.
class StepClock {
public:
    StepClock();
    /// Since construction.
    StepTime elapsed() const;

private:
    double wall_, cpu_;
};

/// Compares steps on `most` threads with steps on one thread, and keeps the faster count. A trial takes two steps on the other count, then
/// two on the present one. It ends early where one count is `hopeless`. The next trial comes when the last one cost at most 2% of the time
/// since. Results do not depend on the number of threads; only time does.
class ThreadChoice {
public:
    /// `most`: the number of threads that there is enough work for.
    explicit ThreadChoice(int most) : most_(most), chosen_(most), count_(most) {}

    /// Threads for the next step.
    int count() const { return count_; }
    /// Adds the time of a step on count() threads.
    void add(const StepTime& step);
    /// One line for the user, once per choice: threads made steps slower, or waited longer than they worked. Otherwise empty.
    std::string warning();

    /// Steps on each count in a trial.
    static constexpr int steps_of_trial = 2;
    /// Ratio of step times that ends a trial.
    static constexpr double hopeless = 2;
    /// A change requires a step time below this part of the present one.
    static constexpr double worth = 0.9;
    /// Fraction of the run time that trials may cost.
    static constexpr double cost_allowed = 0.02;
    /// Minimum number of steps between trials.
    static constexpr int steps_between = 100;
    /// Number of consecutive waiting steps that gives a warning.
    static constexpr int steps_of_waiting = 8;

private:
    enum class Phase { steady, other, present };
    int other_count() const { return chosen_ == most_ ? 1 : most_; }
    void begin(Phase phase);
    void decide(double other, double present);
    void add_to_trial(double wall);
    void watch(const StepTime& step);

    int most_, chosen_, count_;
    Phase phase_ = Phase::steady;
    bool tried_ = false;
    int steps_ = 0;                  // in this phase
    double fastest_ = 0;             // step of this phase [s]
    double recent_ = 0, other_ = 0;  // step before the trial; fastest step of the other count in it [s]
    double since_ = 0, cost_ = 0;    // time since the last trial; what that took longer than the present count would have [s]
    int waiting_ = 0;                // steps in a row that waited longer than they worked
    double wall_ = 0, cpu_ = 0;      // of those [s]
    double slowdown_ = 0;            // step on most_ threads over one on one thread, when one was chosen
    bool warned_slow_ = false, warned_waiting_ = false;
};

}  // namespace weir::sim
