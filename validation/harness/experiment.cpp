#include "validation/harness/experiment.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::validation {

ExperimentComparison compare(const std::vector<real>& values, const Experiment& experiment, real band) {
    const auto count = values.size();
    if (count < 2) throw BadInput("an ensemble needs at least two runs");
    ExperimentComparison c{.runs = static_cast<int>(count)};
    for (const real v : values) c.mean += v / static_cast<real>(count);
    for (const real v : values) c.deviation += (v - c.mean) * (v - c.mean) / static_cast<real>(count - 1);
    c.deviation = std::sqrt(c.deviation);
    std::vector<real> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    c.median = 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
    c.error = c.mean - experiment.mean;
    c.numerical = band / 2, c.input = c.deviation, c.measured = experiment.deviation / std::sqrt(static_cast<real>(experiment.samples));
    c.validation = std::sqrt(c.numerical * c.numerical + c.input * c.input + c.measured * c.measured);
    return c;
}

std::string words_of(const ExperimentComparison& c, const Experiment& experiment) {
    const auto part = [&](real value) { return fmt::format("{:.3g}%", 100 * value / std::abs(experiment.mean)); };
    const std::string median = experiment.median ? fmt::format(" (median {:.4g})", *experiment.median) : "";
    return fmt::format(
        "{} runs {:.4g} +- {:.4g} (median {:.4g}), experiment {:.4g} +- {:.4g}{}; E = {}, u_val = {} (numerical {}, input {}, experiment "
        "{}): a "
        "model error above {} would be told apart",
        c.runs, c.mean, c.deviation, c.median, experiment.mean, experiment.deviation, median, part(c.error), part(c.validation),
        part(c.numerical), part(c.input), part(c.measured), part(c.power()));
}

}  // namespace weir::validation
