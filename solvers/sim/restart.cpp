// Checkpoints of a run: the scene, its changes, the solver and the probes; a run that continues from one equals the uninterrupted run.
#include "core/error.hpp"
#include "parallel/communicator.hpp"
#include "parallel/plane_checkpoint.hpp"
#include "scene/names.hpp"
#include "sim/finite.hpp"
#include "sim/make_solver.hpp"
#include "sim/registry.hpp"
#include "sim/requested_times.hpp"
#include "sim/scene_files.hpp"
#include "sim/shares.hpp"
#include "sim/simulation.hpp"
#include "sim/steadiness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace weir {

namespace {

/// Checkpoint block with the end that a run reached; the state is that before the steps that were shortened for it.
constexpr const char* ended_at = "sim.ended";

/// Checkpoint block with the domain: a run continues in its own domain.
constexpr const char* domain_block = "sim.domain";

std::vector<real> domain_of(const scene::Scene& scene) {
    std::vector<real> all;
    for (const char* key : {"grid.cells", "grid.size", "grid.origin"}) {
        std::vector<real> list = scene.root().numbers(key);
        list.resize(static_cast<std::size_t>(scene.dim()), list.size() == 1 ? list[0] : 0);
        all.insert(all.end(), list.begin(), list.end());
    }
    return all;
}

void require_same_domain(const scene::Scene& scene, const Checkpoint& from) {
    if (!from.has(domain_block)) return;  // files of older versions have no such block
    std::vector<real> there;
    from.get(domain_block, there);
    if (const std::vector<real> here = domain_of(scene); here != there)
        throw BadInput(
            fmt::format("{}: the checkpoint does not match the scene: it belongs to a run with [cells, size, origin] = [{}], and the scene "
                        "has [{}]; leave grid.cells, grid.size and grid.origin unchanged",
                        scene.file(), fmt::join(there, ", "), fmt::join(here, ", ")));
}

/// Checkpoint block with the files of the scene (scene_files.hpp); absent where it names none.
constexpr const char* files_block = "sim.files";

void require_same_files(const scene::Scene& scene, const std::string& files, const std::string& there) {
    if (const std::string changed = sim::changed_file(files, there); !changed.empty())
        throw BadInput(
            fmt::format("{}: the file {} has changed since the checkpoint: a run continues with the files it began with; name a "
                        "file that differs by --set, or start a new run",
                        scene.file(), changed));
}

void put_text(Checkpoint& to, const std::string& name, const std::string& text) { to.put(name, std::span<const char>(text)); }

/// Checks that a state from a file is valid: every number is finite, and the time is not negative.
void require_sound(const Simulation& simulation) {
    constexpr real far = 1e6;  // an embedding program may step past the end, but not this far
    if (!(simulation.time() >= 0 && simulation.time() <= far * simulation.end_time()))
        throw BadInput(fmt::format("the checkpoint is invalid: its time is {} s, and the end of its scene is {} s",
                                   scene::number_text(simulation.time()), scene::number_text(simulation.end_time())));
    if (communicator().several()) return;  // in parallel (MPI) a rank holds a part of them: the first step checks it
    try {
        sim::check_finite(simulation.fields(), {});
    } catch (const NumericalFailure& failure) {
        throw BadInput(std::string("the checkpoint is invalid: ") + failure.what());
    }
}

/// Checks that all rows of a probe up to now exist, except those before the probe was added.
void require_rows(const Checkpoint& from, const scene::Scene& scene, real time) {
    constexpr std::int64_t most_missing = 10000000;
    for (const scene::Table& probe : scene.root().tables("probes")) {
        const std::string row = "probe." + probe.text("name") + ".row";
        const real every = probe.number_or("every", 0);
        if (!(every > 0) || !from.has(row)) continue;
        const std::int64_t next = sim::first_after(every, time);
        Checkpoint::require_within(row, from.get_value<std::int64_t>(row), std::max<std::int64_t>(0, next - most_missing), next + 1);
    }
}

std::string get_text(const Checkpoint& from, const std::string& name) {
    std::vector<char> text;
    from.get(name, text);
    return {text.begin(), text.end()};
}

/// key=value pairs, each terminated by a zero byte.
std::vector<scene::Override> get_overrides(const Checkpoint& from) {
    std::vector<scene::Override> overrides;
    const std::string lines = get_text(from, "sim.overrides");
    for (std::size_t at = 0; at < lines.size();) {
        const std::size_t stop = lines.find('\0', at), equals = lines.find('=', at);
        if (stop == std::string::npos || equals > stop)
            throw std::runtime_error("checkpoint block \"sim.overrides\" is not a list of changes");
        overrides.push_back({lines.substr(at, equals - at), lines.substr(equals + 1, stop - equals - 1)});
        at = stop + 1;
    }
    return overrides;
}

}  // namespace

void Simulation::save(Checkpoint& to) const {
    put_text(to, "sim.source", scene_.source());
    put_text(to, "sim.file", scene_.file());
    std::string overrides;
    for (const auto& o : scene_.overrides()) overrides += o.key + '=' + o.value + '\0';
    put_text(to, "sim.overrides", overrides);
    to.put(domain_block, domain_of(scene_));
    if (!files_.empty()) put_text(to, files_block, files_);
    to.put_value("sim.steps", steps_);
    to.put_value("sim.frame", frame_);
    to.put_value("sim.at_frame", at_frame_);
    if (changed_ > 0) to.put_value("sim.changed", changed_);
    probes_.save(to, *solver_);
    solver_->save(to);
}

/// Restores the scene at the time of the checkpoint. A scene that was read from the checkpoint already contains its changes, and possibly
/// later overrides by the user.
void Simulation::resume_changes(const Checkpoint& from) {
    const auto met = from.has("sim.changed") ? get_count(from, "sim.changed") : 0;
    for (; changed_ < met && static_cast<std::size_t>(changed_) < changes_.size(); ++changed_) {
        const auto& what = changes_[static_cast<std::size_t>(changed_)].what;
        const auto& done = scene_.overrides();
        if (std::none_of(done.begin(), done.end(), [&](const auto& o) { return o.key == what.key && o.value == what.value; })) steer(what);
    }
}

void Simulation::restore(const Checkpoint& from) {
    refuse_while_edited("the simulation restarts from a checkpoint");
    try {
        require_same_domain(scene_, from);
        if (from.has(files_block)) require_same_files(scene_, files_, get_text(from, files_block));
        resume_changes(from);
        if (Partition cut = balanced_partition(from); !cut.empty()) {
            solver_ = sim::make_solver(scene_, kind_, cut);
            shares_->cut = std::move(cut);
        }
        solver_->restore(from);
        require_sound(*this);
        require_rows(from, scene_, time());
        probes_.restore(from);
        steps_ = get_count(from, "sim.steps");
        frame_ = get_count(from, "sim.frame");
        at_frame_ = from.get_value<char>("sim.at_frame") != 0;
        ended_ = from.has(ended_at) ? from.get_value<real>(ended_at) : -infinity;
        if (steady_rate_ > 0) last_velocity_ = sim::grid_velocity(fields());
    } catch (const BadInput&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {  // also for invalid vector sizes
        throw BadInput(std::string("the checkpoint does not match the scene: ") + error.what());
    }
}

void put_ended(Checkpoint& to, real end) { to.put_value(ended_at, end); }

scene::Scene scene_of(const Checkpoint& checkpoint, const std::vector<scene::Override>& more) {
    std::vector<scene::Override> overrides;
    std::string source, file;
    try {
        overrides = get_overrides(checkpoint);
        source = get_text(checkpoint, "sim.source"), file = get_text(checkpoint, "sim.file");
    } catch (const BadInput&) {
        throw;
    } catch (const std::runtime_error& error) {
        throw BadInput(std::string("the checkpoint contains no scene: ") + error.what());
    }
    overrides.insert(overrides.end(), more.begin(), more.end());
    return scene::parse(source, file, sim::schemas(), overrides);
}

}  // namespace weir
