// A collapsing column: front Z(T) and height H(tau) against experiments. The scene's probes "front" and "height" give the run.
#include "validation/metrics/lists.hpp"

#include <algorithm>

namespace weir::validation {
namespace {

/// Our curve in the experiment's units, `shift` later; before that the column stands as it was.
Curve scaled(const ProbeSeries& probe, real time_unit, real length, real shift, std::string label) {
    Curve c = column(probe, 0);
    c.label = std::move(label);
    for (auto& t : c.x) t = t / time_unit + shift;
    for (auto& y : c.y) y /= length;
    if (shift > 0) c.x.insert(c.x.begin(), 0.0), c.y.insert(c.y.begin(), c.y.front());
    return c;
}

Curve front(const RunRecord& run, const Reference& ref) {
    return scaled(run.probe("front"), ref.number("front_time"), ref.number("base"), ref.number("time_shift"), "weir");
}

/// The gate is one event: its delay is the same time in seconds for front and height.
Curve height(const RunRecord& run, const Reference& ref) {
    const real shift = ref.number("time_shift") * ref.number("front_time") / ref.number("height_time");
    return scaled(run.probe("height"), ref.number("height_time"), ref.number("height"), shift, "weir");
}

/// f(ours, theirs) at every row of the table. A row that the run did not reach gives NaN, and so a failure.
template <class F>
std::vector<real> compare(const Curve& ours, const Curve& table, F&& f) {
    std::vector<real> list;
    for (std::size_t i = 0; i < table.size(); ++i) list.push_back(f(interpolate(ours, table.x[i]), table.y[i]));
    return list;
}

real mean(const std::vector<real>& list) {
    real sum = 0;
    for (const real v : list) sum += v;
    return sum / static_cast<real>(list.size());
}

real relative(real ours, real theirs) { return std::abs(ours - theirs) / theirs; }
real difference(real ours, real theirs) { return std::abs(ours - theirs); }

}  // namespace

std::vector<Metric> dam_break_metrics() {
    return {
        {.name = "front.mean_error",
         .unit = "",
         .doc = "Mean |dZ| / Z of the front over the table's rows, with the reference's shift of time.",
         .measure = [](const RunRecord& run, const Reference& ref) { return mean(compare(front(run, ref), ref.curve("front"), relative)); },
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 Panel panel{.title = "Front of the water",
                             .x = {"T = t sqrt(2 g / a)"},
                             .y = {"Z = x / a"},
                             .curves = {ref.curve("front"), front(run, ref)}};
                 if (ref.curves.count("front.mps")) panel.curves.push_back(ref.curve("front.mps"));
                 return panel;
             }},
        {.name = "height.mean_error",
         .unit = "",
         .doc = "Mean |dH| of the column's height at the back wall over the table's rows, in units of the first height.",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return mean(compare(height(run, ref), ref.curve("height"), difference)); },
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 return Panel{.title = "Height at the back wall",
                              .x = {"tau = t sqrt(g / a)"},
                              .y = {"H = height / (2 a)"},
                              .curves = {ref.curve("height"), height(run, ref)}};
             }},
        {.name = "collapse.error",
         .unit = "",
         .doc = "The larger of front.mean_error and height.mean_error: a column must do both, run along the floor and sink at the wall.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const real f = mean(compare(front(run, ref), ref.curve("front"), relative));
                 const real h = mean(compare(height(run, ref), ref.curve("height"), difference));
                 return std::isnan(f) ? f : std::max(h, f);  // a NaN of either stays
             }},
        {.name = "height.max_error",
         .unit = "",
         .doc = "Largest |dH| of the column's height at the back wall over the table's rows, in units of the first height.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const auto list = compare(height(run, ref), ref.curve("height"), difference);
                 return *std::max_element(list.begin(), list.end(), [](real a, real b) { return a < b || std::isnan(b); });
             }},
    };
}

}  // namespace weir::validation
