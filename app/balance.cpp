#include "app/balance.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace weir::app {

namespace {

using json = nlohmann::ordered_json;

std::string with_unit(real value, const std::string& unit) { return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit); }

/// "-9.4%"; of round-off "0%".
std::string signed_percent(real part) { return std::abs(part) < 5e-7 ? "0%" : (part > 0 ? "+" : "") + sim::percent_text(part); }

std::string line(const std::string& name, const std::string& text) { return fmt::format("  {:<14}{}\n", name, text); }

std::string of_quantity(const sim::Balanced& b) {
    std::string text = fmt::format("{:.4g} to {}", b.start, with_unit(b.end, b.unit));
    if (std::abs(b.start) > 0) text += fmt::format(", {}", signed_percent((b.end - b.start) / std::abs(b.start)));
    if (b.highest) text += fmt::format("; highest {:.4g}", *b.highest);
    if (b.inflow && std::abs(*b.inflow) > 1e-9 * b.scale) text += fmt::format("; net inflow {:.4g}", *b.inflow);
    if (!b.unexplained)
        return text + (b.highest ? "; work on the fluid is not counted" : b.inflow ? "" : "; inflow and outflow are not counted");
    text += b.highest ? fmt::format(" ({} relative to the start)", signed_percent(*b.unexplained))
                      : fmt::format("; unexplained {}", signed_percent(*b.unexplained));
    if (b.furthest && std::abs(*b.furthest) > std::abs(*b.unexplained) + 1e-6)
        text += fmt::format(", at a frame {}", signed_percent(*b.furthest));
    return text;
}

std::string label(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

std::string of_list(const std::vector<Integral>& list) {
    std::string text;
    for (const Integral& i : list)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", label(i.name), with_unit(i.value, i.unit == "1" ? "" : i.unit));
    return text;
}

std::string of_thin(const std::vector<std::pair<std::string, real>>& list) {
    constexpr std::size_t named = 3;
    std::string text = "thinner than 2 cells: ";
    for (std::size_t i = 0; i < std::min(named, list.size()); ++i)
        text += fmt::format("{}{} ({:.2g})", i == 0 ? "" : ", ", list[i].first, list[i].second);
    return text + (list.size() > named ? fmt::format(" and {} more", list.size() - named) : "");
}

double real_time_factor(const sim::BalanceOfRun& run, const TimeSpent& spent) {
    return (run.to - run.from) / std::max(spent.stepping + spent.writing, 1e-9);
}

json json_of(const sim::Balanced& b) {
    json j = {{"unit", b.unit}, {"start", b.start}, {"end", b.end}};
    for (const auto& [key, value] :
         {std::pair{"net_inflow", b.inflow}, {"highest", b.highest}, {"unexplained", b.unexplained}, {"largest_unexplained", b.furthest}})
        if (value) j[key] = *value;
    return j;
}

}  // namespace

std::string balance_text(const sim::BalanceOfRun& run, const TimeSpent& spent) {
    std::string text = fmt::format("balance from t = {:.4g} to {:.4g} s\n", run.from, run.to);
    for (const sim::Balanced& b : run.quantities) text += line(label(b.name), of_quantity(b));
    if (!std::isnan(run.divergence))
        text += line("divergence", fmt::format("at most {:.2g} 1/s: a cell gains or loses at most {:.2g} of its volume in a step",
                                               run.divergence, run.cell_change));
    if (!run.corrected.empty()) text += line("corrected", of_list(run.corrected));
    if (!run.air.empty()) text += line("air", of_list(run.air));
    if (!run.thin.empty()) text += line("solids", of_thin(run.thin));
    const double factor = real_time_factor(run, spent);
    return text + line("time", fmt::format("{:.3g} s of steps, {:.3g} s of writing; {}", spent.stepping, spent.writing,
                                           factor < 1 ? fmt::format("{:.3g} times slower than real time", 1 / std::max(factor, 1e-9))
                                                      : fmt::format("{:.3g} times faster than real time", factor)));
}

std::string balance_json(const sim::BalanceOfRun& run, const TimeSpent& spent) {
    json j = {{"from", run.from}, {"to", run.to}, {"quantities", json::object()}};
    for (const sim::Balanced& b : run.quantities) j["quantities"][b.name] = json_of(b);
    if (!std::isnan(run.divergence)) j["max_divergence"] = run.divergence, j["max_cell_volume_change"] = run.cell_change;
    for (const Integral& i : run.corrected) j["corrected"][i.name] = i.value;
    for (const Integral& i : run.air) j["enclosed_air"][i.name] = i.value;
    for (const auto& [solid, cells] : run.thin) j["solids_under_resolved"][solid] = cells;
    j["stepping_seconds"] = spent.stepping, j["writing_seconds"] = spent.writing;
    j["real_time_factor"] = real_time_factor(run, spent);
    j["warnings"] = run.warnings;
    return j.dump();
}

}  // namespace weir::app
