// A simulation in Python: scene in, step, fields and probes out.
#include "python/src/simulation.hpp"

#include "app/picture/draw.hpp"
#include "core/parallel.hpp"
#include "core/step_quantities.hpp"
#include "output/read_frame.hpp"
#include "sim/frame_options.hpp"
#include "sim/loop.hpp"
#include "sim/memory_estimate.hpp"
#include "sim/registry.hpp"
#include "validation/report/command.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include <unistd.h>

namespace py = pybind11;

namespace weir::python {

std::vector<scene::Override> overrides_of(const Changes& changes) {
    std::vector<scene::Override> overrides;
    for (const auto& [key, value] : changes) overrides.push_back({key, value});
    return overrides;
}

namespace {

StatePtr build(scene::Scene scene) {
    sim::require_memory(scene, sim::registry(), sim::Use::run);
    return std::make_shared<State>(std::move(scene));
}

/// As the command takes it: a path, or the name of a case.
StatePtr from_file(const std::string& name, const Changes& changes) {
    return build(scene::read(validation::scene_named(name), sim::schemas(), overrides_of(changes)));
}

StatePtr from_text(const std::string& text, const std::string& name, const Changes& changes) {
    return build(scene::parse(text, name, sim::schemas(), overrides_of(changes)));
}

/// Steps that do not pass t; the last one's report. Other threads of Python run meanwhile.
StepReport step(const StatePtr& state, real t, std::int64_t count) {
    const Change change(state);
    const py::gil_scoped_release release;
    return sim::advance(state->simulation, {.until = t, .steps = count, .past_end = true}, [&](const StepReport& report, double seconds) {
        if (state->measured) state->measured->on_step(report, seconds);
        return true;
    });
}

const char* word(Where where) { return where == Where::cell ? "cell" : where == Where::face ? "face" : "particle"; }

py::list fields(const StatePtr& state) {
    py::list list;
    for (const auto& f : state->shown().fields) list.append(py::make_tuple(f.set, f.name, f.unit, word(f.where), f.components()));
    return list;
}

py::dict integrals(const StatePtr& state) {
    py::dict all;
    for (const auto& i : state->simulation.integrals()) all[py::str(i.name)] = i.value;
    return all;
}

py::dict probe(const StatePtr& state, const std::string& name) {
    const ProbeSeries* at = nullptr;
    try {
        at = &state->simulation.probe_series(name);
    } catch (const BadInput& missing) {
        throw py::key_error(missing.what());
    }
    const std::size_t rows = at->times.size(), columns = at->columns.size();
    py::array_t<real> times(static_cast<py::ssize_t>(rows)), values({rows, columns}), positions({at->positions.size(), std::size_t{3}});
    for (std::size_t i = 0; i < rows; ++i) {
        times.mutable_at(i) = at->times[i];
        for (std::size_t c = 0; c < columns; ++c) values.mutable_at(i, c) = at->values[i][c];
    }
    for (std::size_t i = 0; i < at->positions.size(); ++i)
        for (int d = 0; d < 3; ++d) positions.mutable_at(i, static_cast<std::size_t>(d)) = at->positions[i][d];
    using namespace py::literals;
    return py::dict("kind"_a = at->kind, "columns"_a = at->columns, "times"_a = times, "values"_a = values, "positions"_a = positions);
}

std::vector<std::string> probe_names(const StatePtr& state) {
    std::vector<std::string> names;
    for (const auto& p : state->simulation.probes()) names.push_back(p.name);
    return names;
}

void set(const StatePtr& state, const std::string& key, const std::string& value, std::optional<real> at) {
    const Change change(state);
    if (at)
        state->simulation.set_at(*at, {key, value});
    else
        state->simulation.set({key, value});
}

using Component = py::array_t<real, py::array::f_style | py::array::forcecast>;

/// Every component of a field anew, in the shapes in which `component` gives them.
void write(const StatePtr& state, const std::string& name, const std::vector<Component>& components) {
    std::vector<std::vector<real>> data;
    for (const auto& c : components) data.emplace_back(c.data(), c.data() + c.size());
    const Change change(state);
    const py::gil_scoped_release release;
    state->simulation.edit(name, [&](FieldEdit& field) { field.data = std::move(data); });
}

void begin_edit(const StatePtr& state, const std::string& name) {
    if (!state->edited.empty())
        throw BadInput(fmt::format("\"{}\" is being edited: one field at a time, \"{}\" after it", state->edited, name));
    state->edited = name;
}

void end_edit(const StatePtr& state) { state->edited.clear(); }

std::vector<Vec<3>> points(const Component& rows) {
    std::vector<Vec<3>> list(static_cast<std::size_t>(rows.shape(0)), Vec<3>{});
    for (py::ssize_t i = 0; i < rows.shape(0); ++i)
        for (py::ssize_t d = 0; d < rows.shape(1); ++d) list[static_cast<std::size_t>(i)][static_cast<std::size_t>(d)] = rows.at(i, d);
    return list;
}

void add_particles(const StatePtr& state, const std::string& set, const Component& at, const Component& velocity) {
    const auto x = points(at), u = points(velocity);
    const Change change(state);
    const py::gil_scoped_release release;
    state->simulation.add_particles(set, x, u);
}

void remove_particles(const StatePtr& state, const std::string& set, const std::vector<std::size_t>& which) {
    const Change change(state);
    const py::gil_scoped_release release;
    state->simulation.remove_particles(set, which);
}

std::vector<std::string> editable(const StatePtr& state) {
    const Change change(state);  // views may be filled anew
    return state->simulation.editable();
}

void save(const StatePtr& state, const std::filesystem::path& file) {
    Checkpoint checkpoint;
    state->simulation.save(checkpoint);
    checkpoint.write(file);
}

void restore(const StatePtr& state, const std::filesystem::path& file) {
    const Change change(state);
    state->simulation.restore(Checkpoint::read(file));
}

/// A frame as `weir run` writes it; the series begins with the first one.
std::vector<std::filesystem::path> write_frame(const StatePtr& state, const std::filesystem::path& folder) {
    if (!state->frames) state->frames.emplace(folder, sim::frame_options(state->simulation.scene()));
    state->frames->write(state->shown(), state->simulation.time());
    return state->frames->series();
}

py::bytes picture(const StatePtr& state, const std::string& field, int size) {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("weir-{}-{}.png", ::getpid(), state->moment);
    picture::draw(state->simulation.scene(), output::frame_of(state->shown(), state->simulation.time()), {.field = field, .size = size})
        .write(file);
    std::ifstream in(file, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    std::filesystem::remove(file);
    return bytes;
}

void measure(const StatePtr& state, const std::vector<std::string>& metrics, const std::string& reference) {
    if (state->simulation.steps() > 0) throw BadInput("metrics require a run from its start: request them before the first step");
    state->measured.emplace(state->simulation, metrics, reference);
}

std::map<std::string, double> measured(const StatePtr& state) {
    if (!state->measured) throw BadInput("no metrics were requested: request them before the first step");
    return state->measured->values();
}

template <class F>
auto of_simulation(F get) {
    return [get](const StatePtr& state) { return get(static_cast<const Simulation&>(state->simulation)); };
}

}  // namespace

void add_simulation(py::module_& module) {
    py::class_<StepReport> report(module, "StepReport", "Report of one step; nan where the solver does not provide the quantity.");
    py::list quantities;
    for (const StepQuantity& q : step_quantities) {
        const auto get = [&q](const StepReport& r) -> py::object {
            if (q.is_count()) return py::int_(static_cast<std::int64_t>(q.value(r)));
            return py::float_(q.value(r));
        };
        report.def_property_readonly(q.name, get, fmt::format("[{}]", *q.unit == '\0' ? "1" : q.unit).c_str());
        quantities.append(py::make_tuple(q.name, q.is_count()));
    }
    module.attr("step_quantities") = quantities;
    report.def("__repr__", [](const StepReport& r) {
        return fmt::format("StepReport(dt={:.6g}, cfl={:.3g}, iterations={})", r.dt, r.cfl, r.iterations);
    });

    py::class_<State, StatePtr>(module, "Core")
        .def_static("from_file", from_file)
        .def_static("from_text", from_text)
        .def("step", [](const StatePtr& s, std::int64_t count) { return step(s, infinity, count); })
        .def("step_until", [](const StatePtr& s, real t) { return step(s, t, 1); })
        .def_property_readonly("time", of_simulation([](const Simulation& s) { return s.time(); }))
        .def("reached", [](const StatePtr& s, real t) { return s->simulation.reached(t); })
        .def_property_readonly("end_time", of_simulation([](const Simulation& s) { return s.end_time(); }))
        .def_property_readonly("steps", of_simulation([](const Simulation& s) { return s.steps(); }))
        .def_property_readonly("finished", of_simulation([](const Simulation& s) { return s.finished(); }))
        .def_property_readonly("at_frame", of_simulation([](const Simulation& s) { return s.at_frame(); }))
        .def_property_readonly("frame", of_simulation([](const Simulation& s) { return s.frame(); }))
        .def_property_readonly("next_dt", of_simulation([](const Simulation& s) { return s.next_dt(); }))
        .def_property_readonly("threads", of_simulation([](const Simulation& s) { return s.threads(); }))
        .def_property_readonly("warnings", of_simulation([](const Simulation& s) { return s.warnings(); }))
        .def_property_readonly("bytes", of_simulation([](const Simulation& s) { return s.solver().bytes(); }))
        .def_property_readonly("solver", of_simulation([](const Simulation& s) { return s.scene().solver(); }))
        .def_property_readonly("scene", of_simulation([](const Simulation& s) { return scene::to_toml(s.scene().root()); }))
        .def_property_readonly("dim", of_simulation([](const Simulation& s) { return s.scene().dim(); }))
        .def_property_readonly("moment", [](const StatePtr& s) { return s->moment; })
        .def_property_readonly("grid",
                               [](const StatePtr& s) {
                                   const GridView& g = s->shown().grid;
                                   return py::make_tuple(g.dim, g.cells, g.origin, g.spacing);
                               })
        .def("fields", fields)
        .def("component", component)
        .def("integrals", integrals)
        .def("probe_names", probe_names)
        .def("probe", probe)
        .def("set", set)
        .def("editable", editable)
        .def("begin_edit", begin_edit)
        .def("end_edit", end_edit)
        .def("write", write)
        .def("add_particles", add_particles)
        .def("remove_particles", remove_particles)
        .def("save", save)
        .def("restore", restore)
        .def("write_frame", write_frame)
        .def("picture", picture)
        .def("measure", measure)
        .def("measured", measured);
}

}  // namespace weir::python
