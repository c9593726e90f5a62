#include "validation/uncertainty/recorded_run.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "scene/names.hpp"
#include "sim/balance.hpp"
#include "sim/loop.hpp"
#include "sim/simulation.hpp"
#include "validation/cost/load.hpp"
#include "validation/harness/generic_metrics.hpp"
#include "validation/uncertainty/json_numbers.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

using nlohmann::json;

/// Pressures and forces are results of a step: before the first one has ended they are zero, or on their way from zero.
void drop_before_first_step(RecordedSeries& series, real first_dt) {
    if (!series.unit.starts_with("Pa") && !series.unit.starts_with("N")) return;
    std::size_t first = 0;
    while (first < series.curve.x.size() && series.curve.x[first] < first_dt * (1 - 1e-12)) ++first;
    const auto drop = [&](std::vector<real>& list) { list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(first)); };
    drop(series.curve.x), drop(series.curve.y);
}

std::vector<RecordedSeries> series_of(const RunRecord& record) {
    std::vector<RecordedSeries> all;
    for (const ProbeSeries& probe : record.probes)
        for (std::size_t c = 0; c < probe.columns.size(); ++c) {
            const auto [name, unit] = name_and_unit(probe.columns[c]);
            all.push_back({.name = fmt::format("{}.{}", probe.name, name),
                           .unit = std::string(unit),
                           .integral = probe.kind == "integral",
                           .curve = column(probe, c)});
        }
    for (const Integral& i : record.integrals) all.push_back({i.name, i.unit, true, record.series(i.name)});
    if (record.history.size() > 1)
        for (RecordedSeries& series : all) drop_before_first_step(series, record.history[1].time);
    return all;
}

/// Steps the simulation to its end and adds up the computing time.
void step_to_end(Simulation& simulation, RunWatch& watch, sim::Balance& balance, double time_limit, RecordedRun& run) {
    double start = computing_seconds(), without_first = 0;
    real first_dt = 0;
    sim::advance(simulation, {}, [&](const StepReport& report, double wall) {
        const double now = computing_seconds(), took = now - start;
        run.seconds += took;
        if (simulation.steps() > 1)
            without_first += took;
        else
            first_dt = report.dt;
        watch.on_step(report, wall);
        balance.on_step(simulation, report);
        if (run.seconds > time_limit)
            throw NumericalFailure("time limit", fmt::format("not finished after {:g} s of computing", time_limit));
        start = computing_seconds();  // what the record takes does not count
        return true;
    });
    run.steps = simulation.steps();
    run.end = simulation.time();
    if (run.steps == 0) return;
    run.mean_dt = run.end / static_cast<real>(run.steps);
    const bool several = run.steps > 1;  // the first step touches memory for the first time
    run.ms_per_step = 1e3 * (several ? without_first / static_cast<double>(run.steps - 1) : run.seconds);
    run.seconds_per_second = several ? without_first / (run.end - first_dt) : run.seconds / run.end;
}

std::vector<const Metric*> registered(const std::vector<std::string>& metrics) {
    std::vector<const Metric*> list;
    for (const auto& name : metrics) list.push_back(find_metric(name));
    return list;
}

}  // namespace

double RecordedRun::seconds_per_frame(double frame) const { return std::max(1e-3 * ms_per_step, seconds_per_second * frame); }

RecordedRun record_run(const scene::Scene& scene, const std::vector<std::string>& metrics, double time_limit, const Solvers& solvers) {
    const ThreadsScope one_thread(1);  // its computing time does not depend on what other programs do
    RecordedRun run;
    for (const double n : scene.root().numbers("grid.cells")) run.cells.push_back(static_cast<int>(n));
    try {
        Simulation simulation(scene, solvers);
        RunWatch watch(simulation, registered(metrics));
        sim::Balance balance(simulation);
        for (const auto& name : metrics) check_metric(name, watch.record(), {});
        step_to_end(simulation, watch, balance, time_limit, run);
        const RunRecord& record = watch.record();
        run.series = series_of(record);
        for (const auto& name : metrics) run.measured[name] = measure(name, record, {});
        run.warnings = balance.of_run(simulation).warnings;
        run.balanced = run.warnings.empty();
        for (const auto& warning : simulation.warnings()) run.warnings.push_back(warning);
    } catch (const NumericalFailure& failure) {
        run.failure = failure.what();
    } catch (const BadInput& wrong) {
        run.failure = wrong.what();
    }
    return run;
}

std::vector<RecordedSeries> series_at_start(const scene::Scene& scene, const Solvers& solvers) {
    const Simulation simulation(scene, solvers);
    std::vector<RecordedSeries> all;
    for (const ProbeSeries& probe : simulation.probes())
        for (const std::string& column : probe.columns) {
            const auto [name, unit] = name_and_unit(column);
            all.push_back({.name = fmt::format("{}.{}", probe.name, name), .unit = std::string(unit)});
        }
    for (const Integral& i : simulation.integrals()) all.push_back({i.name, i.unit, true, {}});
    return all;
}

const RecordedSeries& series_named(const std::vector<RecordedSeries>& series, std::string_view name) {
    std::vector<const RecordedSeries*> columns;
    std::vector<std::string> known;
    for (const RecordedSeries& s : series) {
        if (s.name == name) return s;
        if (s.name.starts_with(std::string(name) + ".")) columns.push_back(&s);
        if (s.name.find('#') == std::string::npos || s.name.ends_with("#0")) known.push_back(s.name);
    }
    if (columns.size() == 1) return *columns[0];
    if (columns.size() > 1) {
        std::vector<std::string> names;
        for (const auto* c : columns) names.push_back(c->name);
        throw BadInput(fmt::format("{} has several columns; name one: {}", name, fmt::join(names, ", ")));
    }
    throw BadInput(fmt::format("no probe or integral is called \"{}\"{}; this scene has: {}", name,
                               scene::did_you_mean(std::string(name), known), fmt::join(known, ", ")));
}

std::string to_json(const RecordedRun& run) {
    json all{{"cells", run.cells},
             {"seconds", run.seconds},
             {"ms_per_step", run.ms_per_step},
             {"seconds_per_second", run.seconds_per_second},
             {"steps", run.steps},
             {"mean_dt", run.mean_dt},
             {"end", run.end},
             {"warnings", run.warnings},
             {"balanced", run.balanced},
             {"measured", json::object()},
             {"series", json::array()}};
    all["failure"] = run.failure ? json(*run.failure) : json();
    for (const auto& [name, value] : run.measured) all["measured"][name] = json_number(value);
    for (const RecordedSeries& s : run.series)
        all["series"].push_back({{"name", s.name},
                                 {"unit", s.unit},
                                 {"integral", s.integral},
                                 {"t", json_numbers(s.curve.x)},
                                 {"values", json_numbers(s.curve.y)}});
    return all.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

RecordedRun run_from_json(const std::string& text) {
    try {
        const json all = json::parse(text);
        RecordedRun run{.cells = all.at("cells").get<std::vector<int>>(),
                        .seconds = all.at("seconds"),
                        .ms_per_step = all.at("ms_per_step"),
                        .seconds_per_second = all.at("seconds_per_second"),
                        .steps = all.at("steps"),
                        .mean_dt = all.at("mean_dt"),
                        .end = all.at("end"),
                        .warnings = all.at("warnings").get<std::vector<std::string>>(),
                        .balanced = all.at("balanced")};
        if (!all.at("failure").is_null()) run.failure = all.at("failure").get<std::string>();
        for (const auto& [name, value] : all.at("measured").items()) run.measured[name] = number_of(value);
        for (const json& s : all.at("series")) {
            const std::string name = s.at("name");
            run.series.push_back({.name = name,
                                  .unit = s.at("unit"),
                                  .integral = s.at("integral"),
                                  .curve = {.label = name, .x = numbers_of(s.at("t")), .y = numbers_of(s.at("values"))}});
            if (run.series.back().curve.x.size() != run.series.back().curve.y.size())
                throw BadInput("a series has fewer values than times");
        }
        return run;
    } catch (const json::exception& wrong) {
        throw BadInput(std::string("not a recorded run: ") + wrong.what());
    }
}

}  // namespace weir::validation
