// weir validate, cost and plan as functions that return what the commands print.
#include "python/src/simulation.hpp"

#include "sim/registry.hpp"
#include "validation/cost/measure.hpp"
#include "validation/cost/plan.hpp"
#include "validation/harness/runner.hpp"
#include "validation/report/command.hpp"
#include "validation/uncertainty/scene_plan.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace py = pybind11;
using namespace py::literals;

namespace weir::python {

namespace {

validation::Size size_of(const std::string& name) {
    if (name == "ci") return validation::Size::ci;
    if (name == "full") return validation::Size::full;
    throw BadInput("size \"" + name + "\" is none of \"ci\", \"full\"");
}

/// Called before each run, without the interpreter's lock: Ctrl-C ends the command there.
void tell(const py::object& progress, const std::string& what) {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!progress.is_none()) progress(what);
}

/// Of a list of things with a name those that are wanted; all where none is. Throws BadInput naming those known.
template <class T>
void keep_named(std::vector<T>& list, const std::vector<std::string>& wanted, const std::string& what) {
    if (wanted.empty()) return;
    std::string known;
    for (const auto& one : list) known += (known.empty() ? "" : ", ") + one.name;
    for (const auto& name : wanted)
        if (std::none_of(list.begin(), list.end(), [&](const auto& one) { return one.name == name; }))
            throw BadInput(what + " \"" + name + "\"; known: " + known);
    std::erase_if(list, [&](const auto& one) { return std::find(wanted.begin(), wanted.end(), one.name) == wanted.end(); });
}

py::dict validate(const std::string& name, const std::string& size, const std::vector<std::string>& variants,
                  const std::filesystem::path& out, const py::object& progress) {
    validation::Case plan = validation::read_case(validation::find_case(name), size_of(size));
    keep_named(plan.variants, variants, "case \"" + plan.name + "\" has no variant");
    validation::check_case(plan, sim::registry());
    const auto result = [&] {
        const py::gil_scoped_release release;
        return validation::validate(plan, out, sim::registry(), [&](const std::string& run) { tell(progress, run); });
    }();
    py::list claims;
    for (const auto& variant : result.variants)
        for (const auto& v : variant.verdicts)
            claims.append(py::dict("variant"_a = v.variant, "metric"_a = v.metric, "criterion"_a = v.criterion, "at"_a = v.at,
                                   "measured"_a = v.measured, "low"_a = v.low, "high"_a = v.high, "passed"_a = v.pass,
                                   "verdict"_a = v.word(), "why"_a = v.why, "not_reached"_a = v.not_reached, "note"_a = v.note,
                                   "seconds"_a = v.seconds));
    return py::dict("case"_a = plan.name, "question"_a = plan.question, "blind_to"_a = plan.blind_to, "source"_a = result.source,
                    "passed"_a = result.pass(), "seconds"_a = result.seconds(), "claims"_a = claims);
}

py::list cost(const std::string& name, const std::string& size, const std::vector<std::string>& methods, const py::object& progress) {
    validation::Study study = validation::read_study(validation::find_case(name), size_of(size));
    keep_named(study.methods, methods, "study \"" + study.name + "\" has no method");
    const auto result = [&] {
        const py::gil_scoped_release release;
        return validation::measure_study(study, {}, sim::registry(), [&](const std::string& point) { tell(progress, point); });
    }();
    py::list points;
    for (const auto& p : result.points)
        points.append(py::dict("method"_a = p.method, "setting"_a = p.setting, "error"_a = p.error, "also"_a = p.also,
                               "seconds_per_second"_a = p.seconds_per_second, "ms_per_step"_a = p.ms_per_step, "spread"_a = p.spread,
                               "repeats"_a = p.repeats, "steps"_a = p.steps, "bytes"_a = p.bytes, "threads"_a = p.threads,
                               "failure"_a = p.failure, "on_front"_a = p.on_front));
    return points;
}

py::dict choice(const validation::Plan& plan, const validation::Choice& c) {
    return py::dict("method"_a = c.curve->method, "setting"_a = c.at.setting, "error"_a = c.at.error, "seconds"_a = c.seconds,
                    "ms_per_step"_a = c.at.ms_per_step, "threads"_a = c.at.threads,
                    "command"_a = validation::run_line(plan.study, *c.curve, c.at));
}

py::dict make_plan(const std::string& name, const std::string& error, const std::string& budget, const std::string& frame,
                   const std::filesystem::path& tables) {
    const validation::Plan plan = validation::make_plan({.name = name, .budget = budget, .error = error, .frame = frame, .tables = tables});
    const auto& r = plan.recommendation;
    py::list nearest;
    for (const auto& c : r.nearest) nearest.append(choice(plan, c));
    return py::dict("take"_a = r.take ? py::object(choice(plan, *r.take)) : py::object(py::none()), "nearest"_a = nearest,
                    "prices"_a = plan.prices);
}

/// plan.json of a scene, and the printed text. `options`: budget, frame, time_limit, with and out as the command takes them; an empty `out`
/// keeps nothing.
py::tuple plan_scene(const std::string& name, const std::vector<std::string>& of, const std::vector<std::string>& error,
                     const std::map<std::string, std::string>& options, const Changes& set, const py::object& progress) {
    const std::string& out = options.at("out");
    const validation::ScenePlanOptions asked{.scene = name,
                                             .set = overrides_of(set),
                                             .of = of,
                                             .error = error,
                                             .budget = options.at("budget"),
                                             .frame = options.at("frame"),
                                             .time_limit = options.at("time_limit"),
                                             .with = options.at("with"),
                                             .out = out,
                                             .keep = !out.empty()};
    const auto [json, text] = [&] {
        const py::gil_scoped_release release;
        const auto plan = validation::plan_scene(asked, sim::registry(), [&](const std::string& run) { tell(progress, run); });
        validation::keep_results(plan);
        return std::pair(validation::plan_json(plan), validation::plan_text(plan));
    }();
    return py::make_tuple(json, text);
}

}  // namespace

void add_studies(py::module_& module) {
    module.def("case_folder", validation::find_case);
    module.def("validate", validate);
    module.def("cost", cost);
    module.def("plan", make_plan);
    module.def("plan_scene", plan_scene);
}

}  // namespace weir::python
