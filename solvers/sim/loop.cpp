#include "sim/loop.hpp"

#include "parallel/communicator.hpp"
#include "sim/memory_estimate.hpp"
#include "sim/run_id.hpp"

#include <chrono>
#include <cstdio>
#include <string>

namespace weir::sim {

namespace {

/// A copy of the state costs about the memory traffic of a few passes; every 50 steps this is negligible.
constexpr std::int64_t good_state_every = 50;

std::string brief(real value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

Checkpoint state_of(const Simulation& simulation, const std::string& run) {
    Checkpoint state;
    simulation.save(state);
    if (!run.empty()) put_run_id(state, run);
    return state;
}

/// The last good state, kept in memory: a failed step leaves an unspecified state.
struct GoodState {
    Checkpoint state;
    std::int64_t step = 0;
    real time = 0;
    std::string run;
    void keep(const Simulation& simulation) {
        state = {};  // frees its memory before the next one allocates as much
        state = state_of(simulation, run);
        step = simulation.steps();
        time = simulation.time();
    }
};

[[noreturn]] void fail(const NumericalFailure& failure, const GoodState& good, const std::filesystem::path& folder) {
    std::string message =
        "step " + std::to_string(failure.step) + ", t = " + brief(failure.time) + " s: " + failure.quantity + ": " + failure.what();
    try {
        std::filesystem::create_directories(folder);
        good.state.write(last_good_file(folder));
        message += "\nThe last good state (step " + std::to_string(good.step) + ", t = " + brief(good.time) + " s) is saved in " +
                   last_good_file(folder).string();
    } catch (const std::exception& error) {
        message += std::string("\nThe last good state could not be saved: ") + error.what();
    }
    NumericalFailure located(failure.quantity, message);
    located.step = failure.step;
    located.time = failure.time;
    throw located;
}

/// Returns whether each rank can read the file, possibly as a whole, together with all other ranks of this machine. One rank that cannot
/// makes all return false.
bool all_can_read(const std::filesystem::path& file) {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(file, none);
    const bool can = !none && static_cast<double>(bytes) * communicator().ranks() < available_memory();
    return communicator().largest(can ? 0 : 1) == 0;
}

/// In parallel, a run that goes on is also repartitioned where the state requires it (load balancing).
void save(Simulation& simulation, const std::filesystem::path& folder, const std::string& run, bool goes_on) {
    bool repartition = false;
    {
        const Checkpoint checkpoint = state_of(simulation, run);
        checkpoint.write(checkpoint_file(folder));
        repartition = goes_on && simulation.needs_repartition(checkpoint);
    }
    if (repartition && all_can_read(checkpoint_file(folder))) simulation.repartition(Checkpoint::read(checkpoint_file(folder)));
}

/// Keeps the last good state and writes checkpoints during a run.
class Keeper {
public:
    Keeper(Simulation& simulation, const LoopOptions& options) : simulation_(simulation), options_(options) {
        good_.run = options.run;
        good_.keep(simulation);
        keep_before_end();
    }
    /// Returns whether the run is to stop before its end.
    bool after_step() {
        if (!before_end_ && (simulation_.at_frame() || simulation_.steps() % good_state_every == 0)) good_.keep(simulation_);
        const bool finished = simulation_.finished();
        const bool requested = options_.checkpoint_every > 0 && (simulation_.steps() % options_.checkpoint_every == 0 || finished);
        const int stops = options_.stop_requests();
        const bool stop = !finished && (stops > 1 || (stops == 1 && (simulation_.at_frame() || !simulation_.has_frames())));
        if (requested && finished && before_end_ && !simulation_.steady()) {  // a later end can then be requested
            put_ended(good_.state, simulation_.end_time());
            good_.state.write(checkpoint_file(options_.folder));
        } else if (requested || stop) {
            save(simulation_, options_.folder, options_.run, !stop && !finished);
        }
        if (!stop) keep_before_end();
        return stop;
    }
    const GoodState& good() const { return good_; }

private:
    void keep_before_end() {
        if (options_.checkpoint_every == 0 || before_end_ || simulation_.finished() || !simulation_.shortens_for_end()) return;
        before_end_ = true;
        good_.keep(simulation_);
    }

    Simulation& simulation_;
    const LoopOptions& options_;
    GoodState good_;
    bool before_end_ = false;  // the good state precedes the steps that are shortened for the end
};

}  // namespace

std::filesystem::path checkpoint_file(const std::filesystem::path& folder) { return folder / "checkpoint.weir"; }
std::filesystem::path last_good_file(const std::filesystem::path& folder) { return folder / "last_good.weir"; }

StepReport advance(Simulation& simulation, const StepRange& range, const std::function<bool(const StepReport&, double seconds)>& after) {
    using clock = std::chrono::steady_clock;
    StepReport report;
    for (std::int64_t i = 0; i < range.steps && (range.past_end || !simulation.finished()); ++i) {
        const auto start = clock::now();
        report = simulation.step_until(range.until);
        if (after && !after(report, std::chrono::duration<double>(clock::now() - start).count())) break;
        if (simulation.reached(range.until)) break;
    }
    return report;
}

Ending run(Simulation& simulation, Watcher& watcher, const LoopOptions& options) {
    if (!options.restarted) watcher.on_frame(simulation);
    Keeper keeper(simulation, options);
    Ending ending = Ending::finished;
    bool stepping = true;
    const auto after = [&](const StepReport& report, double seconds) {
        stepping = false;
        watcher.on_step(simulation, report, seconds);
        if (simulation.at_frame()) watcher.on_frame(simulation);
        if (keeper.after_step()) ending = Ending::interrupted;
        stepping = true;
        return ending == Ending::finished;
    };
    try {
        advance(simulation, {}, after);
    } catch (const NumericalFailure& failure) {
        if (!stepping) throw;  // of the watcher
        fail(failure, keeper.good(), options.folder);
    }
    return ending;
}

}  // namespace weir::sim
