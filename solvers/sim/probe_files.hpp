// Probes as CSV: <folder>/<name>.csv, a head of column names with units, then one row a sample, numbers in full precision.
#pragma once
#include "sim/probes.hpp"

#include <filesystem>
#include <vector>

namespace weir::sim {

class ProbeFiles {
public:
    explicit ProbeFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// Appends what was measured since the last call; the first call begins new files. Throws OutputError.
    void update(const std::vector<ProbeSeries>& probes);

private:
    std::filesystem::path folder_;
    std::vector<std::size_t> written_;  // rows of each probe
};

}  // namespace weir::sim
