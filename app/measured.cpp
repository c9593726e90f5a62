#include "app/measured.hpp"

#include "validation/cost/measure.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <fmt/format.h>

#include <utility>

namespace weir::app {

namespace {

std::vector<const validation::Metric*> registered(const std::vector<std::string>& metrics) {
    std::vector<const validation::Metric*> list;
    for (const auto& name : metrics) list.push_back(validation::find_metric(name));
    return list;
}

}  // namespace

Measured::Measured(Simulation& simulation, std::vector<std::string> metrics, const std::string& reference)
    : metrics_(std::move(metrics)),
      reference_(validation::make_reference(reference, simulation.scene(), std::filesystem::path(simulation.scene().file()).parent_path())),
      watch_(simulation, registered(metrics_)) {
    for (const auto& name : metrics_) validation::check_metric(name, watch_.record(), reference_);
}

const std::map<std::string, double>& Measured::values() {
    const validation::RunRecord& record = watch_.record();
    for (const auto& name : metrics_) values_[name] = validation::measure(name, record, reference_);
    const validation::Timing timing = validation::timing_of(record);
    values_["ms_per_step"] = timing.ms_per_step();
    values_["seconds_per_second"] = timing.seconds_per_second();
    return values_;
}

std::string Measured::text() {
    const auto& all = values();
    std::string text;
    for (const auto& name : metrics_) {
        const std::string unit = validation::unit_of(name, watch_.record());
        text += fmt::format("{} = {:.6g}{}{}\n", name, all.at(name), unit.empty() ? "" : " ", unit);
    }
    return text + fmt::format("{:.4g} ms of computing per step, {:.4g} s per simulated second\n", all.at("ms_per_step"),
                              all.at("seconds_per_second"));
}

}  // namespace weir::app
