// The time loop of a run: steps, frames, checkpoints, and how a run ends early without losing anything.
#pragma once
#include "sim/simulation.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace weir::sim {

/// What a run tells while it goes on.
class Watcher {
public:
    virtual ~Watcher() = default;
    virtual void on_step(const Simulation&, const StepReport&, double /*seconds*/) {}
    virtual void on_frame(const Simulation&) {}  // a frame stands: at the start (unless restarted), at each output time, at the end
};

enum class Ending { finished, interrupted };

struct LoopOptions {
    std::filesystem::path folder;  // of checkpoints
    std::string run;               // that they are of (sim/run_id.hpp); empty: they do not say
    /// Steps; 0: only when the run ends early. No step is changed for it. That of the end is of the state before the steps that are
    /// shortened for the end: continued to a later one, the run is bit for bit the one that had it from the start.
    std::int64_t checkpoint_every = 0;
    bool restarted = false;  // the frame of the present state has been written already
    /// How often the user has asked to stop: once, and the run ends with the next frame; twice, with the present step.
    std::function<int()> stop_requests = [] { return 0; };
};

/// Where checkpoints of a run stand.
std::filesystem::path checkpoint_file(const std::filesystem::path& folder);
std::filesystem::path last_good_file(const std::filesystem::path& folder);

/// Runs to the end of the scene. An interrupted run saves a checkpoint. At a NumericalFailure the last good state (of the last frame, or
/// of a step not more than 50 steps ago) is saved, and the failure is thrown on with step, time, quantity and the file in its message.
Ending run(Simulation& simulation, Watcher& watcher, const LoopOptions& options);

}  // namespace weir::sim
