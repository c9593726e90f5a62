#include "app/output_fields.hpp"

#include "parallel/partition.hpp"
#include "sim/registry.hpp"
#include "validation/cost/effect_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <vector>

namespace weir::app {

namespace {

struct OutputQuantity {
    std::string name, unit, where, takes;  // takes: what a scene must say; empty: nothing
};

std::string place_of(const FieldView& field) {
    if (!field.set.empty()) return field.set;
    return field.where == Where::face ? "faces" : "cells";
}

/// Components of integrals are told apart by their last letter: momentum_x, momentum_y.
void add(std::vector<OutputQuantity>& list, OutputQuantity shown) {
    const auto same = [&](const OutputQuantity& s) { return s.name == shown.name && s.where == shown.where; };
    if (std::none_of(list.begin(), list.end(), same)) list.push_back(std::move(shown));
}

void add_all(std::vector<OutputQuantity>& list, const scene::SolverKind& kind, const scene::Scene& scene, const std::string& takes) {
    const std::unique_ptr<Solver> solver = kind.make(scene, {});
    for (const FieldView& field : static_cast<const Solver&>(*solver).fields().fields)
        add(list, {field.name, field.unit, place_of(field), takes});
    for (const Integral& integral : solver->integrals()) add(list, {integral.name, integral.unit, "integral", takes});
}

/// Minimal scenes of the studies, which have no plain scene.
std::vector<std::pair<std::string, std::string>> studies_of(const std::string& solver) {
    const std::string head = "solver = \"" + solver + "\"\ndim = 3\ngrid = { cells = [8, 8, 8], size = [1, 1, 1] }\ntime = { end = 1.0 }\n";
    if (solver == "poisson") return {{head + "problem = \"N3\"\n", ""}};
    if (solver == "reconstruction")
        return {
            {head + "liquid = [ { shape = \"box\", min = [0, 0, 0], max = [0.5, 0.5, 0.5] } ]\noutput.surface = \"zhu_bridson\"\n", ""}};
    if (solver == "phase_diagram")
        return {{"solver = \"" + solver +
                     "\"\ndim = 2\ngrid = { cells = [8, 8], size = [400, 8], origin = [200, 0] }\ntime = { end = 1.0 }\n" +
                     "substance = \"water\"\nsamples = { temperature = [300], pressure = [1e5] }\n",
                 ""}};
    if (solver == "closed_vessel")
        return {{"solver = \"" + solver + "\"\ndim = 2\ngrid = { cells = [8, 8], size = [1, 1] }\ntime = { end = 1.0 }\n" +
                     "substance = \"water\"\nvessel = { volume = 1, mass = 10, temperature = 300, transfer = 1e-5 }\n",
                 ""}};
    const std::string flow = head + "flow = { name = \"constant\", value = [0, 0, 0] }\n";
    const std::string ball = " = { name = \"ball\", centre = [0.5, 0.5, 0.5], radius = 0.2, value = 1.0, outside = 0.0 }\n";
    return {{flow + "initial.tracer" + ball, "initial.tracer"}, {flow + "initial.temperature" + ball, "initial.temperature"}};
}

std::vector<OutputQuantity> output_quantities(const scene::SolverKind& kind) {
    constexpr int cells = 8, dim = 3;
    std::vector<OutputQuantity> list;
    if (kind.schema.study) {
        for (const auto& [text, takes] : studies_of(kind.schema.name))
            add_all(list, kind, scene::parse(text, kind.schema.name + ".toml", {kind.schema}), takes);
        for (OutputQuantity& s : list)  // what is carried is asked for by name, the flow is always there
            if (s.takes != "initial." + s.name) s.takes.clear();
        return list;
    }
    const scene::Scene plain = validation::plain_scene(kind, dim, cells);
    add_all(list, kind, plain, "");
    if (const auto solver = kind.make(plain, {}); !static_cast<const Solver&>(*solver).fields().sheets.empty())  // a surface by itself
        add_all(list, kind, scene::parse(plain.source(), plain.file(), {kind.schema}, {{"grid.cells", "[8, 1, 8]"}}),
                "grid.cells = [n, 1, m]");
    const std::string solids = plain.source() + "solids = [ { shape = \"box\", min = [0.3, 0, 0.3], max = [0.7, 0.7, 0.7] } ]\n";
    if (!scene::is_without(kind.schema, "solids")) add_all(list, kind, scene::parse(solids, plain.file(), {kind.schema}), "solids");
    const std::string bodies =
        plain.source() + "bodies = [ { shape = \"sphere\", centre = [0.5, 0.5, 0.5], radius = 0.2, density = 1.0 } ]\n";
    if (scene::find_key(kind.schema.keys, "bodies")) add_all(list, kind, scene::parse(bodies, plain.file(), {kind.schema}), "bodies");
    for (const scene::Variant& effect : kind.schema.effects)
        add_all(list, kind, validation::scene_with(kind, dim, cells, {effect.name}, validation::negligible), "effects." + effect.name);
    return list;
}

}  // namespace

std::string output_fields_text() {
    std::string text;
    for (const scene::SolverKind& kind : sim::registry()) {
        text += kind.schema.name + "\n";
        for (const OutputQuantity& s : output_quantities(kind))
            text += fmt::format("  {:22} {:12} {:10} {}\n", s.name, s.unit.empty() ? "-" : s.unit, s.where, s.takes);
    }
    return text;
}

std::string output_fields_markdown() {
    std::string text =
        "# Fields and integrals of solvers\n\n`weir list fields --markdown` writes this page from scenes that it builds, in 3D.\n\nFields "
        "are written to frames (`output.fields`) and to probes, integrals to probes of kind `integral` and to the metrics of cases. The "
        "last column gives the key that a scene requires for a name to exist; `emitters.smoke` and `initial.smoke` also create smoke.\n";
    for (const scene::SolverKind& kind : sim::registry()) {
        text +=
            fmt::format("\n## `{}`\n{}\n\n| name | unit | where | required key |\n|---|---|---|---|\n", kind.schema.name, kind.schema.doc);
        for (const OutputQuantity& s : output_quantities(kind))
            text += fmt::format("| `{}` | {} | {} | {} |\n", s.name, s.unit, s.where, s.takes.empty() ? "" : "`" + s.takes + "`");
    }
    return text;
}

}  // namespace weir::app
