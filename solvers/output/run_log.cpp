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
    head_ = head.dump(1);
    head_.erase(head_.rfind('\n'));  // without the closing brace: more keys follow
}

void RunLog::set_ranks(int count, const Cut& cut, Holds holds, const std::string& replicated_work, const std::vector<Traffic>& sent,
                       const std::vector<RankState>& states) {
    json ranks = {{"count", count}, {"cut", cut.at}, {"storage", "every rank stores whole grids"}};
    if (holds == Holds::own_planes) ranks["storage"] = "every rank stores its slab and ghost planes";
    if (holds == Holds::own_particles)
        ranks["cut"] = "equal numbers of particles", ranks["storage"] = "every rank stores its own and ghost particles";
    if (!replicated_work.empty()) ranks["every_rank_does"] = replicated_work;
    for (const Traffic& rank : sent) {
        ranks["messages"].push_back(rank.messages);
        ranks["bytes"].push_back(rank.bytes);
    }
    for (const RankState& rank : states) {
        ranks["solver_bytes"].push_back(rank.solver);
        ranks["resident_bytes"].push_back(rank.resident);
        ranks["peak_bytes"].push_back(rank.peak);
        ranks["busy_seconds"].push_back(rank.busy_seconds);
        if (rank.checkpoint > 0) ranks["checkpoint_bytes"].push_back(rank.checkpoint);
    }
    ranks_ = ranks.dump();
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
    write_file(file_, text + ",\n \"steps\": " + steps_.summary() + "\n}\n");
}

}  // namespace weir::output
