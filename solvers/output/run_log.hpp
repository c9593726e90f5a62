// run.json: the scene as understood, the machine, and what every step answered.
#pragma once
#include "core/passes.hpp"
#include "core/slabs.hpp"
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::output {

class RunLog {
public:
    /// Nothing is written before the first write().
    RunLog(std::filesystem::path file, const scene::Scene& scene);

    /// What step number `step`, which ended at t, answered; `passes` as they accumulate in the solver, `seconds` of the whole step.
    void add_step(std::int64_t step, real t, const StepReport& report, const Passes& passes, double seconds);
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
    /// Of a rank: what its solver holds, what of the process stands in memory that no file backs, and what it has read of the checkpoint
    /// that it continues [bytes].
    struct RankMemory {
        std::size_t solver = 0, resident = 0, peak = 0, checkpoint = 0;
    };
    enum class Holds { whole_grids, own_planes, own_particles };
    /// Where planes are cut among the ranks of the run, what each of them holds, what of a step each does alone (nothing said: all is
    /// shared), and at the end what each has sent and holds; it is told of several ranks only.
    void set_ranks(int count, const Cut& cut, Holds holds, const std::string& by_all, const std::vector<Traffic>& sent,
                   const std::vector<RankMemory>& memory);
    /// Takes over the steps up to `last` of an earlier run's file, where it can be read.
    void resume(std::int64_t last);
    /// Replaces the file. Throws OutputError.
    void write() const;
    /// Sets the status in the file as it stands, which takes no room: what a full disk still allows. Its first line only, cut to the room
    /// that is kept for it. False where even that fails.
    bool overwrite_status(const std::string& status) const;

private:
    std::filesystem::path file_;
    std::string head_;                    // scene and machine: they never change
    std::vector<std::string> steps_;      // one JSON object each, as text, so that a long run is not encoded again for each frame
    std::vector<double> seconds_before_;  // of each pass, when the last step was added
    std::string status_ = "running";
    std::vector<std::string> series_;
    std::vector<std::string> warnings_;
    std::size_t solver_bytes_ = 0;
    std::map<std::string, double> measured_;
    std::string balance_;  // one JSON object, or nothing
    std::string ranks_;    // one JSON object, or nothing
};

}  // namespace weir::output
