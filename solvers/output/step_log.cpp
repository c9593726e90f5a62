#include "output/step_log.hpp"

#include "core/step_quantities.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace weir::output {

namespace {

using json = nlohmann::ordered_json;

const std::string unit = " [ms]";
const std::string whole_step = "all";

json numbers(const ColumnSummary& c) { return {{"min", c.min}, {"mean", c.sum / static_cast<real>(c.count)}, {"max", c.max}}; }

std::string pass_of(const ColumnSummary& column) { return column.name.substr(0, column.name.size() - unit.size()); }

/// "dt [s]", "cfl", ...: the time, and every quantity of a report.
std::vector<std::string> columns() {
    std::vector<std::string> names{"t [s]"};
    for (const StepQuantity& q : step_quantities)
        names.push_back(q.name + (*q.unit == '\0' ? std::string() : " [" + std::string(q.unit) + ']'));
    return names;
}

}  // namespace

StepLog::StepLog(const std::filesystem::path& folder)
    : steps_(folder / steps_file, columns()), timings_(folder / timings_file, {whole_step + unit}) {}

void StepLog::begin() {
    steps_.begin();
    timings_.begin();
}

void StepLog::resume(std::int64_t last) {
    steps_.resume(last);
    timings_.resume(last, true);
    for (std::size_t i = 1; i < timings_.columns().size(); ++i) passes_.push_back({pass_of(timings_.columns()[i])});
}

/// Index in passes_ of the solver's pass number `at`; usually unchanged.
std::size_t StepLog::place_of(std::size_t at, const std::string& pass) {
    if (at < passes_.size() && passes_[at].name == pass) return at;
    const auto found = std::find_if(passes_.begin(), passes_.end(), [&](const TimedPass& p) { return p.name == pass; });
    if (found != passes_.end()) return static_cast<std::size_t>(found - passes_.begin());
    timings_.add_column(pass + unit);
    passes_.push_back({pass});
    row_.push_back(not_applicable);
    return passes_.size() - 1;
}

void StepLog::add(std::int64_t step, real t, const StepReport& report, const Passes& passes, double seconds) {
    row_ = {t};
    for (const StepQuantity& q : step_quantities) {
        const real value = q.value(report);
        row_.push_back(q.kind == StepQuantity::Kind::count_if_any && value == 0 ? not_applicable : value);
    }
    steps_.add(step, row_);

    row_.assign(passes_.size() + 1, not_applicable);
    row_[0] = 1e3 * seconds;
    const auto& list = passes.list();
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::size_t at = place_of(i, list[i].name);
        double& before = passes_[at].before;
        const double spent = list[i].seconds >= before ? list[i].seconds - before : list[i].seconds;  // or the passes were reset
        if (spent > 0) row_[at + 1] = 1e3 * spent;
        before = list[i].seconds;
    }
    timings_.add(step, row_);
}

std::string StepLog::summary() const {
    json j = {{"count", steps_.count()}, {"last", steps_.last_step()}, {"files", {steps_file, timings_file}}};
    for (const auto& column : steps_.columns())
        if (column.count > 0) j["columns"][column.name] = numbers(column);
    for (const auto& column : timings_.columns())
        if (column.count > 0) j["milliseconds"][pass_of(column)] = {{"sum", column.sum}, {"max", column.max}};
    return j.dump();
}

}  // namespace weir::output
