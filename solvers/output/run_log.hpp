// run.json: the scene as understood, the machine, and a summary of what the steps reported (output/step_log.hpp has every step).
#pragma once
#include "core/slabs.hpp"
#include "output/step_log.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::output {

class RunLog {
public:
    /// `run` identifies the run whose files the folder holds. Nothing is written before write() or a step.
    RunLog(std::filesystem::path file, const scene::Scene& scene, const std::string& run = {});

    /// The rows of the steps, in files beside this one.
    StepLog& steps() { return steps_; }
    /// The state of the run: "running", "finished", "interrupted at step 7", "failed: ...".
    void set_status(const std::string& status) { status_ = status; }
    void set_series(std::vector<std::string> files) { series_ = std::move(files); }
    /// What was said of the run while it ran (Simulation::warnings).
    void set_warnings(std::vector<std::string> warnings) { warnings_ = std::move(warnings); }
    void set_solver_bytes(std::size_t bytes) { solver_bytes_ = bytes; }
    /// The balance of the run that has ended, one JSON object.
    void set_balance(std::string balance) { balance_ = std::move(balance); }
    /// What was measured of the finished run, by name. Numbers that are not finite are left out.
    void set_measured(std::map<std::string, double> values) { measured_ = std::move(values); }
    /// Of a rank: what its solver holds, what of the process stands in memory that no file backs, what it has read of the checkpoint that
    /// it continues [bytes], and how long it slept while it waited because other processes were busy.
    struct RankState {
        std::size_t solver = 0, resident = 0, peak = 0, checkpoint = 0;
        double busy_seconds = 0;
    };
    enum class Holds { whole_grids, own_planes, own_particles };
    /// Where planes are cut among the ranks of the run, what each of them holds, what of a step each does alone (nothing said: all is
    /// shared), and at the end what each has sent and holds; it is told of several ranks only.
    void set_ranks(int count, const Cut& cut, Holds holds, const std::string& by_all, const std::vector<Traffic>& sent,
                   const std::vector<RankState>& states);
    /// Replaces the file. Throws OutputError.
    void write() const;
    /// Sets the status in the file as it stands, which takes no room: what a full disk still allows. Its first line only, cut to the room
    /// that is kept for it. False where even that fails.
    bool overwrite_status(const std::string& status) const;

private:
    std::filesystem::path file_;
    std::string head_;  // scene and machine: they never change
    StepLog steps_;
    std::string status_ = "running";
    std::vector<std::string> series_;
    std::vector<std::string> warnings_;
    std::size_t solver_bytes_ = 0;
    std::map<std::string, double> measured_;
    std::string balance_;  // one JSON object, or nothing
    std::string ranks_;    // one JSON object, or nothing
};

}  // namespace weir::output
