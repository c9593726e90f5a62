// Claims that hold to round-off or to a solver's tolerance: discrete Poisson errors, the identity of the projection, rest, mirrors.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"
#include "validation/metrics/samples.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// How far the error of "pressure" is from the table's error of the exactly solved difference equations, relative; RMS or largest,
/// whichever is worse.
real discrete_deviation(const RunRecord& run, const Reference& ref) {
    const auto& p = needed_field(run.fields, "", "pressure").data[0];
    const ScalarField& exact = ref.scalar("pressure");
    const auto count = static_cast<real>(p.size());
    std::vector<real> error(p.size());
    real mean = 0;
    for_each_sample(run.fields.grid, -1, [&](const Vec<3>& x, real, std::size_t i) {
        error[i] = p[i] - exact(x, run.time);
        mean += error[i] / count;
    });
    if (!ref.up_to_a_constant.count("pressure")) mean = 0;
    real square = 0, largest = 0;
    for (const real e : error) square += (e - mean) * (e - mean) / count, largest = std::max(largest, std::abs(e - mean));
    const std::string n = std::to_string(run.fields.grid.cells[0]);
    return std::max(std::abs(std::sqrt(square) / ref.number("rms." + n) - 1), std::abs(largest / ref.number("max." + n) - 1));
}

/// Largest |max |div u| - dt/rho max |r|| of any step, over the largest speed of the run a cell: what round-off is measured by.
real identity_error(const RunRecord& run, const Reference&) {
    const real rho = run.scene->number("fluid.density");
    real worst = run.steps() > 0 ? 0 : std::nan("");
    for (const Moment& m : run.history) {
        if (m.step == 0) continue;
        const real error = std::abs(m.report.max_divergence - m.report.dt / rho * m.report.residual_max);
        if (!(error <= worst)) worst = error;
    }
    return worst * run.fields.grid.spacing[0] / largest(run.series("projection.identity_error"));
}

/// Largest |u(x) - mirrored u| over largest |u|, mirrored at the middle plane across `axis`: the normal component changes its sign.
real asymmetry(const FieldSet& fields, int axis) {
    const FieldView& u = needed_field(fields, "", "velocity");
    const GridView& g = fields.grid;
    real worst = 0;
    for (int c = 0; c < u.components(); ++c) {
        const std::array<int, 3> n = sample_counts(g, u.where == Where::face ? c : -1);
        for (int k = 0; k < n[2]; ++k)
            for (int j = 0; j < n[1]; ++j)
                for (int i = 0; i < n[0]; ++i) {
                    std::array<int, 3> I{i, j, k}, mirrored = I;
                    const auto A = static_cast<std::size_t>(axis);
                    mirrored[A] = n[A] - 1 - I[A];
                    const real sign = c == axis ? -1 : 1;
                    worst = std::max(worst, std::abs(value_at(u, g, c, I) - sign * value_at(u, g, c, mirrored)));
                }
    }
    const real speed = max_speed(fields);
    return speed > 0 ? worst / speed : 0;
}

}  // namespace

std::vector<Metric> exactness_metrics() {
    return {
        {.name = "pressure.discrete_deviation",
         .unit = "",
         .doc = "Relative difference of RMS and largest error to those of the exactly solved difference equations; the worse of the two.",
         .measure = discrete_deviation},
        {.name = "projection.identity_error",
         .unit = "",
         .doc = "Largest deviation from max |div u| = dt/rho max |residual| over all steps, over the largest speed a cell width.",
         .measure = identity_error,
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return max_speed(fields); }},
        {.name = "rest.speed",
         .unit = "",
         .doc = "Largest speed at any step, over sqrt(g H).",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 return largest(run.series("rest.speed")) / std::sqrt(ref.number("gravity") * ref.number("depth"));
             },
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return max_speed(fields); }},
        {.name = "flow.asymmetry",
         .unit = "",
         .doc = "Largest difference of the velocity to its mirror image across x at any step, over the largest speed.",
         .measure = [](const RunRecord& run, const Reference&) { return largest(run.series("flow.asymmetry")); },
         .observe = [](const FieldSet& fields, const scene::Scene&, real) { return asymmetry(fields, 0); }},
    };
}

}  // namespace weir::validation
