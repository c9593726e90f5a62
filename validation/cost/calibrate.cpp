#include "validation/cost/calibrate.hpp"

#include "core/error.hpp"
#include "validation/cost/load.hpp"
#include "validation/cost/measure.hpp"

#include <algorithm>
#include <numeric>

namespace weir::validation {
namespace {

const Priced& cheapest(const CostCurve& curve) {
    return *std::min_element(curve.points.begin(), curve.points.end(),
                             [](const Priced& a, const Priced& b) { return a.seconds() < b.seconds(); });
}

double middle_of(std::vector<double> list) {
    std::sort(list.begin(), list.end());
    return list[list.size() / 2];
}

/// Milliseconds of a step now over those of the table; nothing where the setting fails here.
std::optional<double> factor_of(const Study& study, const CostCurve& curve, const Priced& row, const Solvers& solvers) {
    Study one = study_of_row(study, curve.method, row.index);
    if (one.methods.empty()) return std::nullopt;
    one.methods.front().threads = row.threads;
    const MeasureOptions options{.repeats = 3, .enough_seconds = 1, .least_seconds = 0.2, .most_repeats = 11};
    const StudyResult result = measure_study(one, options, solvers);
    const CostPoint& now = result.points.front();
    if (now.failure || !(now.ms_per_step > 0) || !(row.ms_per_step > 0)) return std::nullopt;
    return now.ms_per_step / row.ms_per_step;
}

}  // namespace

Calibration calibrate(const Study& study, const std::vector<CostCurve>& curves, const Solvers& solvers, double enough) {
    std::vector<std::size_t> order(curves.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return cheapest(curves[a]).seconds() < cheapest(curves[b]).seconds(); });
    std::vector<std::optional<double>> found(curves.size());
    std::vector<double> all;
    const double start = work_so_far().wall;
    for (const std::size_t i : order) {
        const Priced& row = cheapest(curves[i]);
        const double spent = work_so_far().wall - start;
        if (!all.empty() && spent + row.seconds() * middle_of(all) > enough) break;
        found[i] = factor_of(study, curves[i], row, solvers);
        if (found[i]) all.push_back(*found[i]);
    }
    if (all.empty()) throw BadInput(study.name + ": no configuration of this table runs here, so its times cannot be scaled");
    Calibration c{
        .measured = all.size(), .least = *std::min_element(all.begin(), all.end()), .most = *std::max_element(all.begin(), all.end())};
    for (const auto& f : found) c.factors.push_back(f.value_or(middle_of(all)));
    c.seconds = work_so_far().wall - start;
    return c;
}

std::vector<CostCurve> scaled(std::vector<CostCurve> curves, const Calibration& calibration) {
    for (std::size_t i = 0; i < curves.size(); ++i)
        for (Priced& p : curves[i].points) {
            p.ms_per_step *= calibration.factors.at(i);
            p.seconds_per_second *= calibration.factors.at(i);
        }
    return curves;
}

}  // namespace weir::validation
