// A collapsing column: front Z(T) and height H(tau) against experiments. The scene's probes "front" and "height" give the run.
#include "sim/surface.hpp"
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

/// A front that is thinner than this part of the column's base is not told from dry floor: what a cell is there does not matter then.
constexpr real seen_depth = 1.0 / 16;

real base_of(const scene::Scene& scene) {
    const scene::Table& column = scene.root().tables("liquid").at(0);
    return column.vec<2>("max")[0] - column.vec<2>("min")[0];
}

/// How far the water reaches that is at least so deep [m]: linear between the middles of the grid's columns.
real front_of_depth(const FieldSet& fields, real depth) {
    const GridView& g = fields.grid;
    const auto middle = [&](int i) { return g.origin[0] + (i + 0.5) * g.spacing[0]; };
    real beyond = 0;
    for (int i = g.cells[0] - 1; i >= 0; --i) {
        const real here = sim::liquid_depth(fields, {middle(i), g.origin[1], g.origin[2]}, 1);
        if (here >= depth) return middle(i) + (i + 1 < g.cells[0] ? g.spacing[0] * (here - depth) / (here - beyond) : 0);
        beyond = here;
    }
    return g.origin[0];
}

/// The front of that depth, watched at every step, in the experiment's units.
Curve deep_front(const RunRecord& run, const Reference& ref, std::string_view watched_as) {
    const Curve watched = run.series(watched_as);
    ProbeSeries probe{.name = "front", .times = watched.x};
    for (const real x : watched.y) probe.values.push_back({x});
    return scaled(probe, ref.number("front_time"), ref.number("base"), ref.number("time_shift"),
                  "weir, where a sixteenth of the base deep");
}

real watch_deep_front(const FieldSet& fields, const scene::Scene& scene, real) {
    return front_of_depth(fields, seen_depth * base_of(scene));
}

real relative(real ours, real theirs) { return std::abs(ours - theirs) / theirs; }
real difference(real ours, real theirs) { return std::abs(ours - theirs); }

real distance_of_experiments(const Reference& ref) {
    const Curve &table = ref.curve("front"), &other = ref.curve("front.other");
    Curve both{.label = table.label, .x = {}, .y = {}};
    for (std::size_t i = 0; i < table.size(); ++i)
        if (table.x[i] >= other.x.front() && table.x[i] <= other.x.back()) both.x.push_back(table.x[i]), both.y.push_back(table.y[i]);
    return mean(compare(other, both, relative));
}

}  // namespace

std::vector<Metric> front_metrics() {
    const auto ours = [](real z, real) { return z; };
    return {
        {.name = "front.mean",
         .unit = "",
         .doc = "Mean Z of the front over the table's rows, with the reference's shift of time.",
         .quantity = Quantity::value,
         .measure = [=](const RunRecord& run, const Reference& ref) { return mean(compare(front(run, ref), ref.curve("front"), ours)); }},
        {.name = "front.mean_at_depth",
         .unit = "",
         .doc = "The same of the water that is at least a sixteenth of the column's base deep.",
         .quantity = Quantity::value,
         .measure =
             [=](const RunRecord& run, const Reference& ref) {
                 return mean(compare(deep_front(run, ref, "front.mean_at_depth"), ref.curve("front"), ours));
             },
         .observe = watch_deep_front},
        {.name = "front.error_at_depth",
         .unit = "",
         .doc = "Mean |dZ| / Z, over the table's rows, of the water that is at least a sixteenth of the column's base deep.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 return mean(compare(deep_front(run, ref, "front.error_at_depth"), ref.curve("front"), relative));
             },
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 return Panel{.title = "Front of the water",
                              .x = {"T = t sqrt(2 g / a)"},
                              .y = {"Z = x / a"},
                              .curves = {ref.curve("front"), ref.curve("front.other"), front(run, ref),
                                         deep_front(run, ref, "front.error_at_depth")}};
             },
         .observe = watch_deep_front},
    };
}

/// One list: its entries are data, not steps.
std::vector<Metric> dam_break_metrics() {
    std::vector<Metric> all = front_metrics();
    const std::vector<Metric> errors = {
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
        {.name = "experiments.distance",
         .unit = "",
         .doc = "Mean |dZ| / Z of another experiment's points from the table, over the table's rows between their first and last.",
         .quantity = Quantity::value,
         .measure = [](const RunRecord&, const Reference& ref) { return distance_of_experiments(ref); },
         .figure =
             [](const RunRecord& run, const Reference& ref) {
                 const real h = run.fields.grid.spacing[0], apart = distance_of_experiments(ref);
                 return Panel{.title = "front.mean_error",
                              .curves = {{.label = "another experiment of the same",
                                          .x = {h, ref.number("base") / 9},
                                          .y = {apart, apart},
                                          .dashed = true}}};
             }},
    };
    all.insert(all.end(), errors.begin(), errors.end());
    return all;
}

}  // namespace weir::validation
