#include "output/run_log.hpp"

#include "output/atomic_file.hpp"
#include "output/machine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

namespace weir::output {

namespace {

using json = nlohmann::ordered_json;

const std::string status_key = ",\n \"status\": ";
constexpr std::size_t status_room = 400;  // characters, including padding
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

/// "finished", or "failed" and the next key, "failure", with the message.
std::string status_text(RunStatus status, const std::string& failure) {
    constexpr std::array names{"running", "finished", "interrupted", "failed"};
    std::string text = json(names[static_cast<std::size_t>(status)]).dump();
    if (status == RunStatus::failed) text += ",\n \"failure\": " + json(failure).dump(-1, ' ', true, replace_bad_text);
    return text;
}

/// Omits quantities that the solver does not have (NaN).
void put(json& to, const char* key, real value) {
    if (std::isfinite(value)) to[key] = value;
}

}  // namespace

RunLog::RunLog(std::filesystem::path file, const scene::Scene& scene, const std::string& run)
    : file_(std::move(file)), steps_(file_.parent_path()) {
    const Machine machine = this_machine();
    json head = {{"run", run},
                 {"weir", machine.version},
                 {"commit", machine.commit},
                 {"machine", machine_json(machine)},
                 {"scene", scene_json(scene)}};
    head_ = head.dump(1, ' ', false, replace_bad_text);
    head_.erase(head_.rfind('\n'));  // without the closing brace: more keys follow
}

void RunLog::set_ranks(const Ranks& of) {
    const bool by_particles = of.storage == Storage::particles;
    json ranks = {{"count", of.count}, {"partition", by_particles ? "particles" : of.cut.empty() ? "none" : "planes"}};
    if (!by_particles) ranks["cut"] = of.cut.at;
    ranks["storage"] = by_particles ? "particles" : of.storage == Storage::planes ? "planes" : "replicated";
    ranks["replicated_work"] = json::array();
    for (const scene::ReplicatedWork work : of.replicated_work) ranks["replicated_work"].push_back(scene::name_of(work));
    for (const Traffic& rank : of.sent) {
        ranks["messages"].push_back(rank.messages);
        ranks["bytes"].push_back(rank.bytes);
    }
    for (const RankState& rank : of.states) {
        ranks["solver_bytes"].push_back(rank.solver);
        ranks["resident_bytes"].push_back(rank.resident);
        ranks["peak_bytes"].push_back(rank.peak);
        ranks["busy_seconds"].push_back(rank.busy_seconds);
        if (rank.checkpoint > 0) ranks["checkpoint_bytes"].push_back(rank.checkpoint);
    }
    ranks_ = ranks.dump();
}

bool RunLog::overwrite_status(RunStatus status, const std::string& failure) const {
    const std::string text = status_text(status, failure.substr(0, std::min(failure.find('\n'), status_room / 2)));
    if (text.size() > status_room) return false;
    std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(head_.size() + status_key.size()));
    file << text << std::string(status_room - text.size(), ' ') << std::flush;
    return file.good();
}

void RunLog::write() const {
    std::string status = status_text(status_, failure_);
    status.resize(std::max(status.size(), status_room), ' ');
    std::string text =
        head_ + status_key + status + ",\n \"series\": " + json(series_).dump() + ",\n \"solver_bytes\": " + std::to_string(solver_bytes_);
    if (!warnings_.empty()) text += ",\n \"warnings\": " + json(warnings_).dump(-1, ' ', false, replace_bad_text);
    json measured = json::object();
    for (const auto& [name, value] : measured_) put(measured, name.c_str(), value);
    if (!measured.empty()) text += ",\n \"measured\": " + measured.dump();
    if (!balance_.empty()) text += ",\n \"balance\": " + balance_;
    if (!ranks_.empty()) text += ",\n \"ranks\": " + ranks_;
    write_file(file_, text + ",\n \"steps\": " + steps_.summary() + "\n}\n");
}

}  // namespace weir::output
