// Probes as CSV: <folder>/<name>.csv, a header of column names with units, then one row per sample, numbers in full precision.
#pragma once
#include "sim/probes.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace weir::sim {

class ProbeFiles {
public:
    explicit ProbeFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// Creates the files. For a continued run, released rows of the series are kept from the present file, or copied from the file in
    /// folder `earlier`. Where neither has them, the new file begins with the rows after them. Throws OutputError.
    void begin(const std::vector<ProbeSeries>& probes, const std::filesystem::path& earlier = {});
    /// Appends the samples since the last call. Throws OutputError.
    void update(const std::vector<ProbeSeries>& probes);

private:
    std::filesystem::path file_of(const ProbeSeries& probe) const { return folder_ / (probe.name + ".csv"); }
    bool keeps_released(const ProbeSeries& probe, const std::filesystem::path& earlier) const;

    std::filesystem::path folder_;
    std::vector<std::int64_t> written_;  // number of rows of each probe
};

}  // namespace weir::sim
