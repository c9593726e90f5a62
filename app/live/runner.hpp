// The simulation in a thread of its own. The window posts commands and reads the newest snapshot; neither waits for the other.
#pragma once
#include "app/live/session.hpp"
#include "app/live/snapshot.hpp"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace weir::live {

/// What the window wants; the runner takes it between two steps.
struct SessionCommands {
    BrushKeyframe brush;                 // as it is now
    std::optional<BrushKeyframe> touch;  // the last that acted and that no step has seen yet: what is shorter than a step acts for one
    bool paused = false;
    int single_steps = 0;
    bool reset = false, checkpoint = false, quit = false;
    std::vector<scene::Override> changes;
    std::string field;  // empty: as before
};

class Runner {
public:
    /// real_time: never faster than the clock.
    Runner(Session& session, bool real_time, bool paused);
    /// Stops between two steps.
    ~Runner();
    void stop();

    template <class F>
    void post(F&& change) {
        {
            const std::lock_guard lock(mutex_);
            change(commands_);
        }
        wake_.notify_one();
    }
    /// Takes the newest snapshot where there is one that was not taken yet.
    bool take(std::unique_ptr<Snapshot>& into);

private:
    using clock = std::chrono::steady_clock;
    void run();
    void apply(SessionCommands commands);
    void step();
    void publish();
    void count();

    Session& session_;
    bool real_time_;
    std::mutex mutex_;
    std::condition_variable wake_;
    SessionCommands commands_;
    std::unique_ptr<Snapshot> ready_ = std::make_unique<Snapshot>(), back_ = std::make_unique<Snapshot>();
    bool fresh_ = false;

    // The thread's own.
    StepReport report_;
    std::string field_, message_;
    bool paused_ = false, failed_ = false;
    double step_ms_ = 0, transfer_ms_ = 0, factor_ = 0;
    std::vector<Pass> before_;
    std::vector<std::pair<std::string, double>> passes_;
    clock::time_point counted_from_, paced_from_ = clock::now();
    double paced_time_ = 0;
    double counted_time_ = 0, ahead_ = 0;
    int counted_steps_ = 0;
    std::thread thread_;
};

}  // namespace weir::live
