#include "sim/probes.hpp"

#include "sim/probe_kinds.hpp"

#include <cmath>
#include <limits>

namespace weir {

std::vector<real> ProbeSeries::column(std::string_view wanted) const {
    std::string known;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (wanted == columns[c] || wanted == std::string_view(columns[c]).substr(0, columns[c].find(" ["))) {
            std::vector<real> list;
            for (const auto& row : values) list.push_back(row[c]);
            return list;
        }
        known += (c == 0 ? "" : ", ") + columns[c];
    }
    throw BadInput("probe \"" + name + "\" has no column \"" + std::string(wanted) + "\"; it has " + known);
}

}  // namespace weir

namespace weir::sim {

namespace {

/// A step ends "at" a sampling time when only rounding separates them.
constexpr real rounding = 64 * std::numeric_limits<real>::epsilon();

}  // namespace

Probes::Probes(const scene::Scene& scene, const Solver& solver) {
    const auto& tables = scene.root().tables("probes");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        ProbeSeries series;
        series.name = tables[i].text("name");
        series.kind = tables[i].text("kind");
        const std::string key = "probes[" + std::to_string(i) + "].name";
        if (series.name.empty() || series.name.find_first_of("/\\") != std::string::npos || series.name[0] == '.')
            scene.refuse(key, "\"" + series.name + "\" cannot be the name of a file", "a probe's name becomes probes/<name>.csv");
        for (const auto& other : series_)
            if (other.name == series.name) scene.refuse(key, "two probes are called \"" + series.name + "\"");
        kinds_.push_back(make_probe(scene, i, solver));
        kinds_.back()->describe(series);
        series_.push_back(std::move(series));
        clocks_.push_back({.every = tables[i].number_or("every", 0), .next = -infinity});
    }
}

void Probes::sample(const Solver& solver) {
    const real t = solver.time();
    FieldSet fields;
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
        Clock& clock = clocks_[i];
        if (t * (1 + rounding) < clock.next) continue;
        if (fields.fields.empty()) fields = solver.fields();
        series_[i].times.push_back(t);
        series_[i].values.push_back(kinds_[i]->measure(solver, fields));
        if (clock.every > 0) clock.next = (std::floor(t * (1 + rounding) / clock.every * (1 + rounding)) + 1) * clock.every;
    }
}

const ProbeSeries& Probes::series(std::string_view name) const {
    for (const auto& series : series_)
        if (series.name == name) return series;
    throw BadInput("the scene has no probe \"" + std::string(name) + "\"");
}

void Probes::save(Checkpoint& to) const {
    for (std::size_t i = 0; i < series_.size(); ++i) {
        const std::string key = "probe." + series_[i].name + '.';
        std::vector<real> rows;
        for (const auto& row : series_[i].values) rows.insert(rows.end(), row.begin(), row.end());
        to.put(key + "times", series_[i].times);
        to.put(key + "values", rows);
        to.put_value(key + "next", clocks_[i].next);
    }
}

void Probes::restore(const Checkpoint& from) {
    for (std::size_t i = 0; i < series_.size(); ++i) {
        ProbeSeries& series = series_[i];
        const std::string key = "probe." + series.name + '.';
        series.times.clear();
        series.values.clear();
        clocks_[i].next = -infinity;
        if (!from.has(key + "times")) continue;  // a probe that the first run did not have begins now
        std::vector<real> rows;
        from.get(key + "times", series.times);
        from.get(key + "values", rows);
        const std::size_t width = series.columns.size();
        if (rows.size() != width * series.times.size()) throw BadInput("the checkpoint's probe \"" + series.name + "\" is another one");
        for (std::size_t r = 0; r < series.times.size(); ++r)
            series.values.emplace_back(rows.begin() + static_cast<std::ptrdiff_t>(r * width),
                                       rows.begin() + static_cast<std::ptrdiff_t>((r + 1) * width));
        clocks_[i].next = from.get_value<real>(key + "next");
    }
}

}  // namespace weir::sim
