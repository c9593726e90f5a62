// One finished run of a scene as metrics see it: the last fields, every step's report and integrals, the probes, the cost.
#pragma once
#include "core/error.hpp"
#include "core/solver.hpp"
#include "core/step_quantities.hpp"
#include "scene/scene.hpp"
#include "sim/probes.hpp"
#include "validation/harness/curve.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace weir {
class Simulation;
}

namespace weir::validation {

/// The run at one time: index 0 is the initial state (its report is empty), then one entry a step.
struct Moment {
    std::int64_t step = 0;
    real time = 0;       // [s]
    double seconds = 0;  // wall clock of this step
    StepReport report{};
    std::vector<real> integrals{};  // in the order of RunRecord::integrals
    std::vector<real> observed{};   // in the order of RunRecord::observers
};

/// History of one column of a probe.
inline Curve column(const ProbeSeries& probe, std::size_t c) { return {.label = probe.name, .x = probe.times, .y = probe.column(c)}; }
inline Curve column(const ProbeSeries& probe, std::string_view name) { return column(probe, probe.column_number(name)); }

struct RunRecord {
    std::shared_ptr<const scene::Scene> scene;
    std::shared_ptr<Simulation> simulation;  // as it stands at the end; keeps `fields` alive. Null in tests of synthetic records
    FieldSet fields;                         // at the end
    real time = 0;                           // at the end [s]
    std::vector<Integral> integrals;         // names, units and last values
    std::vector<std::string> observers;      // names of metrics that watched every step
    std::vector<Moment> history;
    std::vector<ProbeSeries> probes;
    std::vector<Pass> passes;            // calls and seconds of each pass over the whole run
    double seconds = 0;                  // wall clock of all steps
    std::optional<std::string> failure;  // why the run ended early: its numbers must not be used

    std::int64_t steps() const { return history.empty() ? 0 : history.back().step; }
    const ProbeSeries& probe(std::string_view name) const { return probe_named(probes, name); }
    const FieldView& field(std::string_view name) const {
        if (const FieldView* f = fields.find(name)) return *f;
        throw BadInput("the solver provides no field \"" + std::string(name) + "\"");
    }
    bool has_integral(std::string_view name) const { return index_of(name) < integrals.size(); }
    /// An integral, an observed metric, a probe ("probe.NAME", its first column, or "probe.NAME.velocity_x"), or a quantity of the step
    /// reports (core/step_quantities.hpp) against time. Reports have no value at the initial state, so their series begins with the first
    /// step.
    Curve series(std::string_view name) const;

private:
    Curve probe_column(std::string_view name) const;
    std::size_t index_of(std::string_view name) const {
        std::size_t i = 0;
        while (i < integrals.size() && integrals[i].name != name) ++i;
        return i;
    }
};

/// "NAME" or "NAME.COLUMN", the column without its unit.
inline Curve RunRecord::probe_column(std::string_view name) const {
    const auto dot = std::min(name.find('.'), name.size());
    const ProbeSeries& p = probe(name.substr(0, dot));
    return dot == name.size() ? column(p, 0) : column(p, name.substr(dot + 1));
}

inline Curve RunRecord::series(std::string_view name) const {
    if (name.starts_with("probe.")) return probe_column(name.substr(6));
    Curve curve{.label = std::string(name), .x = {}, .y = {}};
    const auto add = [&](const Moment& m, real value) { curve.x.push_back(m.time), curve.y.push_back(value); };
    if (const std::size_t i = index_of(name); i < integrals.size()) {
        for (const auto& m : history) add(m, m.integrals.at(i));
        return curve;
    }
    for (std::size_t i = 0; i < observers.size(); ++i) {
        if (observers[i] != name) continue;
        for (const auto& m : history) add(m, m.observed.at(i));
        return curve;
    }
    const StepQuantity* quantity = find_step_quantity(name);
    if (!quantity) throw BadInput("no integral, observed metric or step report is called \"" + std::string(name) + "\"");
    for (const auto& m : history)
        if (m.step > 0) add(m, quantity->value(m.report));
    return curve;
}

}  // namespace weir::validation
