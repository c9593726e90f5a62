// Comparison of an ensemble of runs with repeated experiments: ASME V&V 20-2009. E = S − D is judged by the validation
// uncertainty
//     u_val² = u_num² + u_input² + u_D²                                      section 1-5
// u_num is half the band of the grids (which holds 95%), u_input the standard deviation of runs whose inputs and seeds are drawn from their
// errors (section 3), u_D the standard error of the experiments' mean.
#pragma once
#include "core/types.hpp"

#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

struct Experiment {
    real mean = 0, deviation = 0;  // over the repeats
    int samples = 1;
    std::optional<real> median{};
    std::string grids{};  // the variant whose grids give u_num
    real power = 1;       // relative: a comparison that could not tell a larger model error apart validates nothing
};

struct ExperimentComparison {
    real mean = 0, deviation = 0, median = 0;                     // of the ensemble
    real error = 0;                                               // E
    real numerical = 0, input = 0, measured = 0, validation = 0;  // standard uncertainties
    int runs = 0;
    /// The smallest model error that would be told apart: E beyond it has no other explanation, at 95%.
    real power() const { return 2 * validation; }
};

/// `band`: of the grids, U of 95%. Throws BadInput for fewer than two runs.
ExperimentComparison compare(const std::vector<real>& values, const Experiment& experiment, real band);

/// "20 runs 52.1 +- 18.2 (median 47.3), experiment 48.2 +- 15 (median 46); E = 8.1%, u_val = 38% (numerical 12%, input 36%, experiment
/// 3.1%): a model error above 76% would be told apart"
std::string words_of(const ExperimentComparison& comparison, const Experiment& experiment);

}  // namespace weir::validation
