// run.json: the parsed scene, the machine, and a summary of the steps' reports (output/step_log.hpp has every step).
#pragma once
#include "output/step_log.hpp"
#include "parallel/communicator.hpp"
#include "scene/replicated_work.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::output {

enum class RunStatus { running, finished, interrupted, failed };

class RunLog {
public:
    /// `run`: id of the run whose files the folder contains. Nothing is written before write() or a step.
    RunLog(std::filesystem::path file, const scene::Scene& scene, const std::string& run = {});

    /// The rows of the steps, in files beside run.json.
    StepLog& steps() { return steps_; }
    /// `failure`: the message of a run that failed.
    void set_status(RunStatus status, const std::string& failure = {}) { status_ = status, failure_ = failure; }
    void set_series(std::vector<std::string> files) { series_ = std::move(files); }
    /// Warnings during the run (Simulation::warnings).
    void set_warnings(std::vector<std::string> warnings) { warnings_ = std::move(warnings); }
    void set_solver_bytes(std::size_t bytes) { solver_bytes_ = bytes; }
    /// The balance of the finished run, one JSON object.
    void set_balance(std::string balance) { balance_ = std::move(balance); }
    /// Values measured in the finished run, by name. Numbers that are not finite are omitted.
    void set_measured(std::map<std::string, double> values) { measured_ = std::move(values); }
    /// State of a rank: bytes of its solver, resident memory of the process that no file backs, bytes read of the continued checkpoint, and
    /// the time slept while waiting because other processes were busy.
    struct RankState {
        std::size_t solver = 0, resident = 0, peak = 0, checkpoint = 0;
        double busy_seconds = 0;
    };
    /// Storage per rank: whole grids; its planes and ghost planes; its particles and ghost particles.
    enum class Storage { replicated, planes, particles };
    /// The partition of a run among its ranks, and at the end each rank's traffic and memory.
    struct Ranks {
        int count = 1;
        Partition cut{};
        Storage storage = Storage::replicated;
        scene::ReplicatedWorks replicated_work{};
        std::vector<Traffic> sent{};
        std::vector<RankState> states{};
    };
    /// Only called with several ranks.
    void set_ranks(const Ranks& ranks);
    /// Replaces the file. Throws OutputError.
    void write() const;
    /// Overwrites the status in the existing file, which needs no additional space and so works on a full disk. Only the first line of
    /// the message, cut to the reserved length. Returns false on failure.
    bool overwrite_status(RunStatus status, const std::string& failure) const;

private:
    std::filesystem::path file_;
    std::string head_;  // scene and machine: constant
    StepLog steps_;
    RunStatus status_ = RunStatus::running;
    std::string failure_;
    std::vector<std::string> series_;
    std::vector<std::string> warnings_;
    std::size_t solver_bytes_ = 0;
    std::map<std::string, double> measured_;
    std::string balance_;  // one JSON object, or empty
    std::string ranks_;    // one JSON object, or empty
};

}  // namespace weir::output
