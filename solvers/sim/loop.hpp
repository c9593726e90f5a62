// The time loop of a run: steps, frames, checkpoints, and how a run ends early without losing anything.
#pragma once
#include "sim/simulation.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

namespace weir::sim {

/// How far to step.
struct StepRange {
    real until = infinity;  // [s]: no step passes it
    std::int64_t steps = std::numeric_limits<std::int64_t>::max();
    bool past_end = false;  // continue past the end of the scene
};

/// The time loop of every program: steps to the end of the range. `after` gets the report and the wall-clock seconds of each step; the loop
/// ends where it returns false. Returns the report of the last step.
StepReport advance(Simulation& simulation, const StepRange& range = {},
                   const std::function<bool(const StepReport&, double seconds)>& after = {});

/// Callbacks of a running simulation.
class Watcher {
public:
    virtual ~Watcher() = default;
    virtual void on_step(const Simulation&, const StepReport&, double /*seconds*/) {}
    virtual void on_frame(const Simulation&) {}  // a frame is complete: at the start (unless restarted), at each output time, at the end
};

enum class Ending { finished, interrupted };

struct LoopOptions {
    std::filesystem::path folder;  // of checkpoints
    std::string run;               // that the checkpoints belong to (sim/run_id.hpp); empty: not recorded
    /// Steps between checkpoints; 0: only when the run ends early. Checkpoints change no step. The final checkpoint has the state before
    /// the steps that are shortened for the end. A run continued from it to a later end is bitwise equal to a run with that end from the
    /// start.
    std::int64_t checkpoint_every = 0;
    bool restarted = false;  // the frame of the present state was already written
    /// Number of stop requests of the user. One: the run ends with the next frame. Two: it ends with the present step.
    std::function<int()> stop_requests = [] { return 0; };
};

/// The path of a run's checkpoint.
std::filesystem::path checkpoint_file(const std::filesystem::path& folder);
std::filesystem::path last_good_file(const std::filesystem::path& folder);

/// Runs to the end of the scene. An interrupted run saves a checkpoint. At a NumericalFailure the last good state is saved (of the last
/// frame, or at most 50 steps old). The failure is rethrown with step, time, quantity and the file in its message.
Ending run(Simulation& simulation, Watcher& watcher, const LoopOptions& options);

}  // namespace weir::sim
