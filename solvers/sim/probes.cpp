#include "sim/probes.hpp"

#include "sim/probe_kinds.hpp"
#include "sim/requested_times.hpp"

#include <fmt/format.h>

#include <cmath>

namespace weir {

std::pair<std::string_view, std::string_view> name_and_unit(std::string_view column) {
    const auto open = column.find(" [");
    if (open == std::string_view::npos) return {column, {}};
    return {column.substr(0, open), column.substr(open + 2, column.size() - open - 3)};
}

std::size_t ProbeSeries::column_number(std::string_view wanted) const {
    std::string known;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (wanted == columns[c] || wanted == name_and_unit(columns[c]).first) return c;
        known += (c == 0 ? "" : ", ") + columns[c];
    }
    throw BadInput("probe \"" + name + "\" has no column \"" + std::string(wanted) + "\"; it has " + known);
}

std::vector<real> ProbeSeries::column(std::size_t number) const {
    std::vector<real> list;
    for (const auto& row : values) list.push_back(row.at(number));
    return list;
}

const ProbeSeries& probe_named(const std::vector<ProbeSeries>& probes, std::string_view name) {
    for (const ProbeSeries& probe : probes)
        if (probe.name == name) return probe;
    throw BadInput("the scene has no probe \"" + std::string(name) + "\"");
}

}  // namespace weir

namespace weir::sim {

namespace {

/// More rows are unreadable and, with many columns, exceed memory: the interval is probably a mistake.
constexpr real most_rows = 1e7;

void require_rows(const scene::Scene& scene, std::size_t probe, real every) {
    const real rows = scene.number("time.end") / every;
    if (rows > most_rows)
        scene.refuse("probes[" + std::to_string(probe) + "].every", fmt::format("until time.end the probe writes {:.3g} rows", rows),
                     fmt::format("at most {:.0e}", most_rows));
}

bool is_at(real t, real requested) { return std::abs(t - requested) <= same_time(requested); }

/// Linear interpolation between the values at the beginning (s = 0) and at the end of a step.
std::vector<real> between(const std::vector<real>& begin, const std::vector<real>& end, real s) {
    std::vector<real> row(end.size());
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = (1 - s) * begin[c] + s * end[c];
    return row;
}

}  // namespace

Probes::Probes(const scene::Scene& scene, Solver& solver) {
    const auto& tables = scene.root().tables("probes");
    if (!tables.empty()) solver.synchronize();
    for (std::size_t i = 0; i < tables.size(); ++i) {
        ProbeSeries series;
        series.name = tables[i].text("name");
        series.kind = tables[i].text("kind");
        kinds_.push_back(make_probe(scene, i, solver));
        kinds_.back()->describe(series);
        series_.push_back(std::move(series));
        clocks_.push_back({.every = tables[i].number_or("every", 0), .begin = {}});
        if (clocks_.back().every > 0) require_rows(scene, i, clocks_.back().every);
    }
}

/// The fields are fetched once, by the first probe that needs them.
std::vector<real> Probes::measured(std::size_t probe, Solver& solver, FieldSet& fields) const {
    if (fields.fields.empty()) {
        solver.synchronize();
        fields = std::as_const(solver).fields();
    }
    return kinds_[probe]->measure(solver, fields);
}

/// A probe that a continued run adds: its first row is at the present time, where this is one of its times.
void Probes::join(std::size_t probe, Solver& solver, FieldSet& fields) {
    Clock& clock = clocks_[probe];
    clock.joins = false;
    clock.next = first_after(clock.every, solver.time());
    if (clock.next == 0 || !is_at(solver.time(), requested_time(clock.every, clock.next - 1))) return;
    if (clock.begin.empty()) clock.begin = measured(probe, solver, fields);
    series_[probe].times.push_back(requested_time(clock.every, clock.next - 1));
    series_[probe].values.push_back(clock.begin);
}

void Probes::before_step(Solver& solver, real dt) {
    began_ = solver.time();
    const real end = began_ + dt;
    FieldSet fields;
    for (std::size_t i = 0; i < clocks_.size(); ++i) {
        Clock& clock = clocks_[i];
        if (clock.every == 0) continue;
        if (clock.joins) join(i, solver, fields);
        const real due = requested_time(clock.every, clock.next);
        if (clock.begin.empty() && due <= end && !is_at(end, due)) clock.begin = measured(i, solver, fields);
    }
}

void Probes::add_rows(std::size_t probe, Solver& solver, FieldSet& fields) {
    Clock& clock = clocks_[probe];
    const real end = solver.time();
    std::vector<real> after;
    for (real due = requested_time(clock.every, clock.next); due <= end + same_time(due); due = requested_time(clock.every, ++clock.next)) {
        if (after.empty()) after = measured(probe, solver, fields);
        const bool passed = !clock.begin.empty() && !is_at(end, due);
        series_[probe].times.push_back(due);
        series_[probe].values.push_back(passed ? between(clock.begin, after, (due - began_) / (end - began_)) : after);
    }
    clock.begin.clear();
}

void Probes::sample(Solver& solver) {
    FieldSet fields;
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
        if (clocks_[i].every > 0) {
            add_rows(i, solver, fields);
        } else {
            series_[i].times.push_back(solver.time());
            series_[i].values.push_back(measured(i, solver, fields));
        }
    }
}

void Probes::keep(Solver& solver) {
    FieldSet fields;
    for (std::size_t i = 0; i < clocks_.size(); ++i)
        if (clocks_[i].every > 0 && clocks_[i].begin.empty()) clocks_[i].begin = measured(i, solver, fields);
}

void Probes::forget() {
    for (Clock& clock : clocks_) clock.begin.clear();
}

std::vector<std::string> Probes::remarks() const {
    std::vector<std::string> list;
    for (const auto& kind : kinds_)
        if (std::string remark = kind->remark(); !remark.empty()) list.push_back(std::move(remark));
    return list;
}

void Probes::release_rows() {
    for (ProbeSeries& series : series_) {
        series.released += static_cast<std::int64_t>(series.times.size());
        series.times.clear();
        series.values.clear();
    }
}

void Probes::save(Checkpoint& to, Solver& solver) const {
    FieldSet fields;
    for (std::size_t i = 0; i < series_.size(); ++i) {
        const std::string key = "probe." + series_[i].name + '.';
        std::vector<real> rows;
        for (const auto& row : series_[i].values) rows.insert(rows.end(), row.begin(), row.end());
        if (series_[i].released > 0) to.put_value(key + "released", series_[i].released);
        to.put(key + "times", series_[i].times);
        to.put(key + "values", rows);
        if (clocks_[i].every == 0) continue;
        to.put_value(key + "row", clocks_[i].next);
        to.put(key + "begin", clocks_[i].begin.empty() ? measured(i, solver, fields) : clocks_[i].begin);
    }
}

void Probes::restore(const Checkpoint& from) {
    for (std::size_t i = 0; i < series_.size(); ++i) {
        ProbeSeries& series = series_[i];
        const std::string key = "probe." + series.name + '.';
        series.times.clear();
        series.values.clear();
        series.released = from.has(key + "released") ? from.get_value<std::int64_t>(key + "released") : 0;
        Checkpoint::require_within(key + "released", series.released, 0, std::int64_t{1} << 53);
        clocks_[i].begin.clear();
        clocks_[i].joins = !from.has(key + "row");  // a probe that the first run did not have begins now
        if (!from.has(key + "times")) continue;
        std::vector<real> rows;
        from.get(key + "times", series.times);
        from.get(key + "values", rows);
        const std::size_t width = series.columns.size();
        if (rows.size() != width * series.times.size())
            throw BadInput("the checkpoint's probe \"" + series.name + "\" differs from that of the scene");
        for (std::size_t r = 0; r < series.times.size(); ++r)
            series.values.emplace_back(rows.begin() + static_cast<std::ptrdiff_t>(r * width),
                                       rows.begin() + static_cast<std::ptrdiff_t>((r + 1) * width));
        if (clocks_[i].every == 0 || clocks_[i].joins) continue;
        clocks_[i].next = from.get_value<std::int64_t>(key + "row");
        from.get(key + "begin", clocks_[i].begin);
        if (!clocks_[i].begin.empty() && clocks_[i].begin.size() != width)
            throw BadInput("the checkpoint's probe \"" + series.name + "\" differs from that of the scene");
    }
}

}  // namespace weir::sim
