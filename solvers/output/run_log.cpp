#include "output/run_log.hpp"

#include "output/atomic_file.hpp"
#include "output/machine.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

namespace weir::output {

namespace {

using json = nlohmann::ordered_json;

const std::string status_key = ",\n \"status\": ";
constexpr std::size_t status_room = 400;  // characters, blanks included
constexpr auto replace_bad_text = json::error_handler_t::replace;

json scene_json(const scene::Scene& scene) {
    json overrides = json::array();
    for (const auto& change : scene.overrides()) overrides.push_back(change.key + '=' + change.value);
    return {{"file", scene.file()},
            {"source", scene.source()},
            {"overrides", overrides},
            {"values", json::parse(scene::to_json(scene.root()))}};
}

json machine_json(const Machine& machine) {
    return {{"processor", machine.processor}, {"logical_cores", machine.logical_cores},
            {"threads", machine.threads},     {"memory_gib", machine.memory_gib},
            {"system", machine.system},       {"compiler", machine.compiler},
            {"build", machine.build}};
}

/// Quantities that the solver does not have (NaN) are left out.
void put(json& to, const char* key, real value) {
    if (std::isfinite(value)) to[key] = value;
}

json step_json(std::int64_t step, real t, const StepReport& report, double seconds) {
    json j = {{"step", step}, {"time", t}, {"dt", report.dt}};
    put(j, "cfl", report.cfl);
    put(j, "max_divergence", report.max_divergence);
    put(j, "density_error", report.density_error);
    put(j, "max_density_error", report.max_density_error);
    j["iterations"] = report.iterations;
    if (report.viscous_iterations > 0) j["viscous_iterations"] = report.viscous_iterations;
    if (report.viscous_turns > 0) j["viscous_turns"] = report.viscous_turns;
    put(j, "residual_before", report.residual_before);
    put(j, "residual_after", report.residual_after);
    put(j, "residual_max", report.residual_max);
    j["milliseconds"] = 1e3 * seconds;
    return j;
}

}  // namespace

RunLog::RunLog(std::filesystem::path file, const scene::Scene& scene) : file_(std::move(file)) {
    const Machine machine = this_machine();
    json head = {{"weir", machine.version}, {"commit", machine.commit}, {"machine", machine_json(machine)}, {"scene", scene_json(scene)}};
    head_ = head.dump(1);
    head_.erase(head_.rfind('\n'));  // open at its end: more keys follow
}

void RunLog::add_step(std::int64_t step, real t, const StepReport& report, const Passes& passes, double seconds) {
    json milliseconds = json::object();
    const auto& list = passes.list();
    seconds_before_.resize(list.size(), 0);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const double spent =
            list[i].seconds >= seconds_before_[i] ? list[i].seconds - seconds_before_[i] : list[i].seconds;  // or: were reset
        if (spent > 0) milliseconds[list[i].name] = 1e3 * spent;
        seconds_before_[i] = list[i].seconds;
    }
    json j = step_json(step, t, report, seconds);
    j["passes"] = milliseconds;
    steps_.push_back(j.dump());
}

void RunLog::set_ranks(int count, const Cut& cut, Holds holds, const std::string& by_all, const std::vector<Traffic>& sent,
                       const std::vector<RankMemory>& memory) {
    json ranks = {{"count", count}, {"cut", cut.at}, {"storage", "every rank holds whole grids"}};
    if (holds == Holds::own_planes) ranks["storage"] = "every rank holds its own planes and those near its cuts";
    if (holds == Holds::own_particles)
        ranks["cut"] = "as many particles to each", ranks["storage"] = "every rank holds its own particles and those near its cuts";
    if (!by_all.empty()) ranks["every_rank_does"] = by_all;
    for (const Traffic& rank : sent) {
        ranks["messages"].push_back(rank.messages);
        ranks["bytes"].push_back(rank.bytes);
    }
    for (const RankMemory& rank : memory) {
        ranks["solver_bytes"].push_back(rank.solver);
        ranks["resident_bytes"].push_back(rank.resident);
        ranks["peak_bytes"].push_back(rank.peak);
        if (rank.checkpoint > 0) ranks["checkpoint_bytes"].push_back(rank.checkpoint);
    }
    ranks_ = ranks.dump();
}

void RunLog::resume(std::int64_t last) {
    std::ifstream old(file_);
    const json j = json::parse(old, nullptr, false);
    if (!j.is_object() || !j.contains("steps") || !j["steps"].is_array()) return;
    for (const auto& step : j["steps"])
        if (step.is_object() && step.value("step", std::int64_t{0}) <= last) steps_.push_back(step.dump());
}

bool RunLog::overwrite_status(const std::string& status) const {
    const std::string text = json(status.substr(0, std::min(status.find('\n'), status_room / 2))).dump(-1, ' ', true, replace_bad_text);
    if (text.size() > status_room) return false;
    std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(head_.size() + status_key.size()));
    file << text << std::string(status_room - text.size(), ' ') << std::flush;
    return file.good();
}

void RunLog::write() const {
    std::string status = json(status_).dump();
    status.resize(std::max(status.size(), status_room), ' ');
    std::string text =
        head_ + status_key + status + ",\n \"series\": " + json(series_).dump() + ",\n \"solver_bytes\": " + std::to_string(solver_bytes_);
    if (!warnings_.empty()) text += ",\n \"warnings\": " + json(warnings_).dump();
    json measured = json::object();
    for (const auto& [name, value] : measured_) put(measured, name.c_str(), value);
    if (!measured.empty()) text += ",\n \"measured\": " + measured.dump();
    if (!balance_.empty()) text += ",\n \"balance\": " + balance_;
    if (!ranks_.empty()) text += ",\n \"ranks\": " + ranks_;
    text += ",\n \"steps\": [";
    for (std::size_t i = 0; i < steps_.size(); ++i) text += (i == 0 ? "\n  " : ",\n  ") + steps_[i];
    write_file(file_, text + "\n ]\n}\n");
}

}  // namespace weir::output
