// Bodies that float, are let go, heave, capsize and are moored. The scene's probe "body" follows the one that is asked about; what is said
// of all bodies asks for a probe of each.
#include "rigid/bodies.hpp"
#include "validation/harness/fitting.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

Curve track(const RunRecord& run, const std::string& name) { return column(run.probe("body"), name); }

/// Mean over the last part of a run.
real body_late_mean(const Curve& c, real from, const std::function<real(real)>& of) {
    real sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < c.size(); ++i)
        if (c.x[i] >= from) sum += of(c.y[i]), ++count;
    return count ? sum / static_cast<real>(count) : std::nan("");
}

/// In cells.
real body_draft_error(const RunRecord& run, const Reference& ref) {
    const Curve y = track(run, "position_y");
    return std::abs(body_late_mean(y, 0.25 * run.time, [](real v) { return v; }) - ref.number("height")) / run.fields.grid.spacing[1];
}

/// a0 = (1 − s) g/(s + C), from the velocity after the first step.
real added_mass_error(const RunRecord& run, const Reference& ref) {
    const Curve v = track(run, "velocity_y");
    const real s = run.scene->root().tables("bodies").at(0).number("density") / run.scene->number("fluid.density");
    const real g = -needed_effect(*run.scene, "gravity").numbers("g").at(1), start = (v.y.at(1) - v.y.at(0)) / (v.x.at(1) - v.x.at(0));
    return std::abs(((1 - s) * g / start - s) / ref.number("coefficient") - 1);
}

/// Of the height over its first value.
Curve body_heave(const RunRecord& run, const Reference& ref) {
    Curve y = track(run, "position_y");
    const real level = run.scene->root().tables("liquid").at(0).numbers("max").at(1);
    for (real& v : y.y) v = (v - level) / ref.number("start");
    y.label = "weir";
    return y;
}

/// The period between the first and the third time that the body passes its place of rest.
real period(const Curve& c) {
    const auto t = zero_crossings(c);
    return t.size() < 3 ? std::nan("") : t[2] - t[0];
}

/// The least and the greatest values between the first crossings, signed, as many as both have, at most three.
std::vector<real> first_extrema(const Curve& c) {
    const auto t = zero_crossings(c);
    std::vector<real> list;
    for (std::size_t k = 0; k + 1 < t.size() && k < 3; ++k) {
        real extreme = 0;
        for (std::size_t i = 0; i < c.size(); ++i)
            if (c.x[i] > t[k] && c.x[i] < t[k + 1] && std::abs(c.y[i]) > std::abs(extreme)) extreme = c.y[i];
        list.push_back(extreme);
    }
    return list;
}

real extrema_error(const RunRecord& run, const Reference& ref) {
    const auto ours = first_extrema(body_heave(run, ref)), exact = first_extrema(ref.curve("heave"));
    if (exact.size() < 3) return std::nan("");
    real worst = 0;  // what has not swung as often has not swung at all
    for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::abs((i < ours.size() ? ours[i] : 0) - exact[i]));
    return worst;
}

Panel body_heave_panel(const RunRecord& run, const Reference& ref) {
    Curve exact = ref.curve("heave");
    exact.dashed = true;
    return {.title = "Height over where it was let go", .x = {"t [s]"}, .y = {"y/y0"}, .curves = {exact, body_heave(run, ref)}};
}

/// How fast the body sinks.
Curve body_fall(const RunRecord& run) {
    Curve v = track(run, "velocity_y");
    for (real& value : v.y) value = -value;
    v.label = "weir";
    return v;
}

real fastest_fall(const RunRecord& run) {
    const Curve v = body_fall(run);
    return *std::max_element(v.y.begin(), v.y.end());
}

/// At the reference's times that the run has reached.
real fall_error(const RunRecord& run, const Reference& ref) {
    const Curve ours = body_fall(run), theirs = ref.curve("fall");
    const real scale = *std::max_element(theirs.y.begin(), theirs.y.end());
    real worst = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i)
        if (theirs.x[i] <= run.time) worst = std::max(worst, std::abs(interpolate(ours, theirs.x[i]) - theirs.y[i]) / scale);
    return worst;
}

Panel body_fall_panel(const RunRecord& run, const Reference& ref) {
    return {.title = "Speed of sinking", .x = {"t [s]"}, .y = {"v [m/s]"}, .curves = {ref.curve("fall"), body_fall(run)}};
}

/// A square looks the same after a quarter turn: its tilt is at most an eighth of one.
real tilt(real angle) { return std::abs(std::remainder(angle, pi / 2)); }

Panel body_tilt_panel(const RunRecord& run, const Reference&) {
    Curve c = track(run, "angle");
    c.label = "weir";
    return {.title = "Angle", .x = {"t [s]"}, .y = {"angle [rad]"}, .curves = {c}};
}

/// The greatest of what `of` says of all bodies at the times of their probes.
template <int D, class F>
real greatest_of(const RunRecord& run, F&& of) {
    rigid::Bodies<D> bodies(*run.scene);
    std::vector<const ProbeSeries*> series;
    for (const auto& body : bodies.all())
        for (const auto& table : run.scene->root().tables("probes"))
            if (table.text("kind") == "body" && table.text("body") == body.name) series.push_back(&run.probe(table.text("name")));
    if (series.empty() || series.size() != bodies.count()) throw BadInput("a probe \"body\" of each body is what this is measured by");
    real greatest = -infinity;
    for (std::size_t row = 0; row < series[0]->times.size(); ++row) {
        bodies.recall([&](const char* field, std::size_t component, std::size_t body) {
            const std::string name = D == 2 && std::string_view(field) == "angle" ? field : std::string(field) + '_' + "xyz"[component];
            const auto& columns = series[body]->columns;
            for (std::size_t c = 0; c < columns.size(); ++c)
                if (columns[c].substr(0, columns[c].find(' ')) == name) return series[body]->values.at(row).at(c);
            throw BadInput("the probe \"" + series[body]->name + "\" has no column \"" + name + "\"");
        });
        greatest = std::max(greatest, of(bodies));
    }
    return greatest;
}

template <int D>
real lean_of(const rigid::Bodies<D>& bodies) {
    real most = 0;
    for (const auto& body : bodies.all()) most = std::max(most, std::acos(std::clamp(body.pose().rotation[1][1], -1.0, 1.0)));
    return most;
}

template <int D>
real outside_of(const rigid::Bodies<D>& bodies, const scene::Scene& scene) {
    const Vec<D> min = scene.vec<D>("grid.origin"), max = min + scene.vec<D>("grid.size");
    real most = 0;
    for (const auto& body : bodies.all())
        for (const auto& sphere : body.contact_spheres) {
            const Vec<D> x = body.pose().to_world(sphere.at);
            for (int a = 0; a < D; ++a) most = std::max({most, min[a] - x[a] + sphere.radius, x[a] + sphere.radius - max[a]});
        }
    return most;
}

template <int D>
real overstretch_of(const rigid::Bodies<D>& bodies) {
    real most = -infinity;
    for (const auto& joint : bodies.joints().all())
        if (joint.kind == rigid::JointKind::mooring) {
            const auto ends = bodies.joints().ends(joint, bodies.all());
            most = std::max(most, norm(ends[0] - ends[1]) - joint.length);
        }
    return most;
}

real bodies_lean(const RunRecord& run, const Reference&) {
    return run.scene->dim() == 2 ? greatest_of<2>(run, lean_of<2>) : greatest_of<3>(run, lean_of<3>);
}
real bodies_outside(const RunRecord& run, const Reference&) {
    const auto of = [&](const auto& bodies) { return outside_of(bodies, *run.scene); };
    return run.scene->dim() == 2 ? greatest_of<2>(run, of) : greatest_of<3>(run, of);
}
real mooring_stretch(const RunRecord& run, const Reference&) {
    return run.scene->dim() == 2 ? greatest_of<2>(run, overstretch_of<2>) : greatest_of<3>(run, overstretch_of<3>);
}

}  // namespace

/// One list: its entries are data, not steps.
std::vector<Metric> body_metrics() {
    return {
        {.name = "body.draft_error",
         .unit = "cells",
         .doc = "Distance of the body's mean height, after the first quarter of the run, from the reference's.",
         .measure = body_draft_error},
        {.name = "body.added_mass_error",
         .unit = "",
         .doc = "Relative error of the added mass that the acceleration of the first step says, g (1 - s)/(s + C).",
         .measure = added_mass_error},
        {.name = "body.period_error",
         .unit = "",
         .doc = "Relative error of the time between the first and the third crossing of the place of rest.",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return std::abs(period(body_heave(run, ref)) / period(ref.curve("heave")) - 1); },
         .figure = body_heave_panel},
        {.name = "body.extrema_error",
         .unit = "",
         .doc = "Largest difference of the first three extrema to the reference's, over the height of release.",
         .measure = extrema_error},
        {.name = "body.period_ratio",
         .unit = "",
         .doc = "Time between the first and the third crossing of the place of rest, over the reference's.",
         .measure = [](const RunRecord& run, const Reference& ref) { return period(body_heave(run, ref)) / period(ref.curve("heave")); },
         .figure = body_heave_panel},
        {.name = "body.trough_error",
         .unit = "",
         .doc = "Difference of the first extreme to the reference's, over the height of release.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const auto ours = first_extrema(body_heave(run, ref));
                 return ours.empty() ? std::nan("") : std::abs(ours[0] - first_extrema(ref.curve("heave")).at(0));
             }},
        {.name = "body.peak_fall_error",
         .unit = "",
         .doc = "Relative error of the greatest speed at which the body sinks.",
         .measure = [](const RunRecord& run, const Reference& ref) { return std::abs(fastest_fall(run) / ref.number("fastest_fall") - 1); },
         .figure = body_fall_panel},
        {.name = "body.fall_error",
         .unit = "",
         .doc = "Largest difference of the speed at which the body sinks to the reference's, over its largest.",
         .measure = fall_error,
         .figure = body_fall_panel},
        {.name = "body.tilt_error",
         .unit = "rad",
         .doc = "Distance of the mean tilt of a square section over the last quarter of the run from the reference's.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 return std::abs(body_late_mean(track(run, "angle"), 0.75 * run.time, tilt) - ref.number("angle"));
             },
         .figure = body_tilt_panel},
        {.name = "body.rest_speed",
         .unit = "m/s",
         .doc = "Greatest speed at which the body rose or sank in the last quarter of the run.",
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const Curve v = track(run, "velocity_y");
                 real most = 0;
                 for (std::size_t i = 0; i < v.size(); ++i)
                     if (v.x[i] >= 0.75 * run.time) most = std::max(most, std::abs(v.y[i]));
                 return most;
             }},
        {.name = "bodies.lean",
         .unit = "rad",
         .doc = "Greatest angle by which any body was tilted from how the scene puts it.",
         .measure = bodies_lean},
        {.name = "bodies.outside",
         .unit = "m",
         .doc = "Greatest length by which any body reached out of the domain.",
         .measure = bodies_outside},
        {.name = "mooring.stretch",
         .unit = "m",
         .doc = "Greatest length of a mooring beyond its length without tension; negative where it was always slack.",
         .measure = mooring_stretch},
    };
}

}  // namespace weir::validation
