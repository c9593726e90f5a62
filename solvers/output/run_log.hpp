// run.json: the parsed scene, the machine, and a summary of the steps' reports (output/step_log.hpp has every step).
#pragma once
#include "output/step_log.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::output {

class RunLog {
public:
    /// `run`: id of the run whose files the folder contains. Nothing is written before write() or a step.
    RunLog(std::filesystem::path file, const scene::Scene& scene, const std::string& run = {});

    /// The rows of the steps, in files beside run.json.
    StepLog& steps() { return steps_; }
    /// The state of the run: "running", "finished", "interrupted at step 7", "failed: ...".
    void set_status(const std::string& status) { status_ = status; }
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
    enum class Holds { whole_grids, own_planes, own_particles };
    /// The partition among the ranks of the run, the storage, the replicated work (empty: none), and at the end each rank's traffic and
    /// memory; only called with several ranks.
    void set_ranks(int count, const Cut& cut, Holds holds, const std::string& replicated_work, const std::vector<Traffic>& sent,
                   const std::vector<RankState>& states);
    /// Replaces the file. Throws OutputError.
    void write() const;
    /// Overwrites the status in the existing file, which needs no additional space and so works on a full disk. Only its first line, cut to
    /// the reserved length. Returns false on failure.
    bool overwrite_status(const std::string& status) const;

private:
    std::filesystem::path file_;
    std::string head_;  // scene and machine: constant
    StepLog steps_;
    std::string status_ = "running";
    std::vector<std::string> series_;
    std::vector<std::string> warnings_;
    std::size_t solver_bytes_ = 0;
    std::map<std::string, double> measured_;
    std::string balance_;  // one JSON object, or empty
    std::string ranks_;    // one JSON object, or empty
};

}  // namespace weir::output
