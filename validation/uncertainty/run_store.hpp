// Runs of a study, kept in a folder: a run that was made before, of the same scene by the same program, is read instead of made again.
#pragma once
#include "validation/uncertainty/recorded_run.hpp"

#include <filesystem>

namespace weir::validation {

class RunStore {
public:
    /// An empty folder name: runs are not kept.
    RunStore(std::filesystem::path folder, std::vector<std::string> metrics, double time_limit, const Solvers& solvers);

    /// The run of this scene. A kept run of another program, or without the metrics, is made again.
    const RecordedRun& run(const scene::Scene& scene);
    /// Computing time of the runs made, not read [s].
    double seconds() const { return seconds_; }

private:
    std::filesystem::path file_of(const std::string& key) const;

    std::filesystem::path folder_;
    std::vector<std::string> metrics_;
    double time_limit_;
    const Solvers* solvers_;
    std::map<std::string, RecordedRun> runs_{};
    double seconds_ = 0;
};

}  // namespace weir::validation
