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

}  // namespace

std::filesystem::path checkpoint_file(const std::filesystem::path& folder) { return folder / "checkpoint.weir"; }
std::filesystem::path last_good_file(const std::filesystem::path& folder) { return folder / "last_good.weir"; }

Ending run(Simulation& simulation, Watcher& watcher, const LoopOptions& options) {
    using clock = std::chrono::steady_clock;
    if (!options.restarted) watcher.on_frame(simulation);
    GoodState good;
    good.run = options.run;
    good.keep(simulation);
    bool before_end = false;  // the good state precedes the steps that are shortened for the end
    while (!simulation.finished()) {
        const auto start = clock::now();
        StepReport report;
        try {
            if (options.checkpoint_every > 0 && !before_end && simulation.shortens_for_end()) before_end = true, good.keep(simulation);
            report = simulation.step();
        } catch (const NumericalFailure& failure) {
            fail(failure, good, options.folder);
        }
        watcher.on_step(simulation, report, std::chrono::duration<double>(clock::now() - start).count());
        if (simulation.at_frame()) watcher.on_frame(simulation);
        if (!before_end && (simulation.at_frame() || simulation.steps() % good_state_every == 0)) good.keep(simulation);
        const bool finished = simulation.finished();
        const bool requested = options.checkpoint_every > 0 && (simulation.steps() % options.checkpoint_every == 0 || finished);
        const int stops = options.stop_requests();
        const bool stop = !finished && (stops > 1 || (stops == 1 && (simulation.at_frame() || !simulation.has_frames())));
        if (requested && finished && before_end && !simulation.steady()) {  // a later end can then be requested
            put_ended(good.state, simulation.end_time());
            good.state.write(checkpoint_file(options.folder));
        } else if (requested || stop) {
            save(simulation, options.folder, options.run, !stop && !finished);
        }
        if (stop) return Ending::interrupted;
    }
    return Ending::finished;
}

}  // namespace weir::sim
