// What a study's milliseconds are on this machine, where its table was measured on another: a few of its settings are measured again.
#pragma once
#include "validation/cost/recommend.hpp"

#include <cstddef>
#include <vector>

namespace weir::validation {

struct Calibration {
    std::vector<double> factors{};  // by curve: milliseconds here over milliseconds in the table
    std::size_t measured = 0;       // how many of them were; the others are the median of these
    double least = 1, most = 1;     // of those measured
    double seconds = 0;             // that it took
};

/// Each method's cheapest setting, the cheapest methods first, as many as fit into `enough` seconds and at least one.
Calibration calibrate(const Study& study, const std::vector<CostCurve>& curves, const Solvers& solvers, double enough = 10);
/// The curves with this machine's milliseconds.
std::vector<CostCurve> scaled(std::vector<CostCurve> curves, const Calibration& calibration);

}  // namespace weir::validation
