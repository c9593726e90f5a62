#include "sim/simulation.hpp"

#include "core/parallel.hpp"
#include "core/thread_count.hpp"
#include "geometry/mesh/mesh.hpp"
#include "mac/bodies/thin_solids.hpp"
#include "parallel/load_balance.hpp"
#include "scene/given.hpp"
#include "scene/names.hpp"
#include "scene/steer.hpp"
#include "sim/extremes.hpp"
#include "sim/finite.hpp"
#include "sim/memory_estimate.hpp"
#include "sim/registry.hpp"
#include "sim/requested_times.hpp"
#include "sim/room.hpp"
#include "sim/shares.hpp"
#include "sim/steadiness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace weir {

namespace {

/// A step may exceed its limit by this factor, so that a sum of rounded steps leaves no sliver before a frame. n steps round n times, by at
/// most n ε t / 2, which is n² ε / 2 of a step; 1e-6 covers a hundred thousand steps.
constexpr real stretch = 1 + 1e-6;

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

void put_text(Checkpoint& to, const std::string& name, const std::string& text) { to.put(name, std::span<const char>(text)); }

/// A count of steps, frames or changes; all fit in a double.
std::int64_t get_count(const Checkpoint& from, const std::string& name) {
    const auto count = from.get_value<std::int64_t>(name);
    Checkpoint::require_within(name, count, 0, std::int64_t{1} << 53);
    return count;
}

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

long cells_of(const scene::Scene& scene) {
    long cells = 1;
    for (const real n : scene.root().numbers("grid.cells")) cells *= static_cast<long>(n);
    return cells;
}

/// Number of threads that the cells of a scene have enough work for.
int threads_for(const scene::Scene& scene) {
    const ProblemSizeScope size(cells_of(scene));
    return weir::threads();
}

std::unique_ptr<Solver> make_solver(const scene::Scene& scene, const scene::SolverKind& kind, const Partition& cut) {
    const ProblemSizeScope size(cells_of(scene));
    return kind.make(scene, cut);
}

std::vector<Change> changes_in(const scene::Scene& scene) {
    std::vector<Change> list;
    for (auto& change : scene::changes_of(scene.root())) list.push_back({change.time, std::move(change.what)});
    return list;
}

void refuse_ignored(const scene::Scene& scene, const scene::SolverKind& kind) {
    if (auto ignored = scene::ignored_keys(scene, kind.schema); !ignored.empty()) scene.refuse(std::move(ignored));
}

/// Checks that run before any part of the scene is built.
scene::Scene fitting(scene::Scene scene, const std::vector<scene::SolverKind>& kinds) {
    geometry::require_meshes(scene);
    sim::require_memory(scene, kinds);
    sim::require_room(scene);
    return scene;
}

void check_output_fields(const scene::Scene& scene, const FieldSet& fields) {
    std::vector<std::string> known;
    for (const auto& field : fields.fields)
        if (std::find(known.begin(), known.end(), field.name) == known.end()) known.push_back(field.name);
    for (const auto& name : scene.root().texts("output.fields"))
        if (std::find(known.begin(), known.end(), name) == known.end())
            scene.refuse("output.fields", "this scene has no field " + scene::quote(name) + scene::did_you_mean(name, known),
                         scene::known(known));
}

/// Resets the record of keys that were read: keys not read from here on are reported as ignored.
scene::Scene unread(scene::Scene scene) {
    scene.forget_reading();
    return scene;
}

}  // namespace

Simulation::Simulation(const std::filesystem::path& scene, const std::vector<scene::Override>& overrides)
    : Simulation(scene::read(scene, sim::schemas(), overrides)) {}

Simulation::Simulation(scene::Scene scene) : Simulation(std::move(scene), sim::registry()) {}

Simulation::Simulation(scene::Scene scene, const std::vector<scene::SolverKind>& kinds)
    : scene_(unread(fitting(std::move(scene), kinds))),
      kind_(sim::kind_named(scene_.solver(), kinds)),
      shares_(std::make_shared<sim::Shares>(sim::shares_of(scene_, communicator().ranks(), kind_))),
      solver_(make_solver(scene_, kind_, shares_->cut)),
      probes_(scene_, *solver_),
      every_(scene_.root().number_or("output.every", infinity)),
      meets_frames_(scene_.text("output.at") == "exact"),
      steady_rate_(scene_.root().number_or("time.stop_when_steady", 0)),
      changes_(changes_in(scene_)),
      threads_(threads_for(scene_)) {
    read_times();
    if (scene_.has("output.fields")) {
        const auto parts = static_cast<const Solver&>(*solver_).distributed_view();
        check_output_fields(scene_, fields());
    }
    refuse_ignored(scene_, kind_);
    for (const std::string& remark : mac::remarks_on_thin_solids(scene_)) warnings_.push_back(scene_.file() + ": " + remark);
    measure();
    if (steady_rate_ > 0) last_velocity_ = sim::grid_velocity(fields());
}

int Simulation::threads() const {
    const ThreadCountScope scope(threads_.count());
    return weir::threads();
}

void Simulation::read_times() {
    end_ = scene_.number("time.end");
    fixed_dt_ = scene_.root().number_or("time.dt", 0);
    max_dt_ = scene_.root().number_or("time.max_dt", infinity);
    guard_ = scene_.text("time.guard") != "off";
}

/// The solver is rebuilt from the changed scene and gets the old state, as in a restart. Solvers need no code for changes, and derived data
/// match the scene.
void Simulation::steer(const scene::Override& change) {
    refuse_while_edited("a key changes");
    scene::Scene changed = unread(scene_.steered(change, {kind_.schema}));
    probes_.keep(*solver_);
    Checkpoint state;
    solver_->save(state);
    std::unique_ptr<Solver> solver = make_solver(changed, kind_, shares_->cut);
    if (!change.key.starts_with("time.") && !changed.root().was_read(change.key))
        changed.refuse(change.key, change.key + " has no effect in this scene");
    solver->restore(state);
    replace(std::move(solver));
    scene_ = std::move(changed);
    read_times();
}

/// Replaces the solver by one that has the same state.
void Simulation::replace(std::unique_ptr<Solver> solver) {
    if (const BrushForcing* forcing = solver_->brush()) solver->brush()->keys = forcing->keys;
    solver->passes().reset();
    for (const Pass& pass : static_cast<const Solver&>(*solver_).passes().list()) solver->passes().add(pass.name, pass.seconds, pass.calls);
    solver_ = std::move(solver);
}

/// Empty where the present partition is good enough.
Partition Simulation::balanced_partition(const Checkpoint& state) const {
    const Partition& present = shares_->cut;
    if (present.empty() || !kind_.parallel.work_of_planes) return {};
    constexpr double worth = 0.9;  // the solver is rebuilt for it, which takes as long as some steps
    const auto work = kind_.parallel.work_of_planes(scene_, &state);
    if (static_cast<int>(work.size()) != present.planes()) return {};  // of another scene, which the solver rejects
    Partition cut = load_balanced_partition(work, present.ranks());
    const auto most = [&](const Partition& c) { return static_cast<double>(largest_share(work, c)); };
    return most(cut) < worth * most(present) ? cut : Partition{};
}

bool Simulation::needs_repartition(const Checkpoint& state) const { return !balanced_partition(state).empty(); }

void Simulation::repartition(const Checkpoint& state) {
    Partition cut = balanced_partition(state);
    if (cut.empty()) return;
    probes_.keep(*solver_);
    std::unique_ptr<Solver> solver = make_solver(scene_, kind_, cut);
    solver->restore(state);
    replace(std::move(solver));
    shares_->cut = std::move(cut);
    if (steady_rate_ > 0) last_velocity_ = sim::grid_velocity(fields());
}

real Simulation::end_time() const {
    real end = end_;
    for (auto at = static_cast<std::size_t>(changed_); at < changes_.size() && changes_[at].time < end; ++at)
        if (changes_[at].what.key == "time.end") end = std::stod(changes_[at].what.value);
    return end;
}

void Simulation::set(const scene::Override& change) { steer(change); }
void Simulation::set(const std::string& key, real value) { steer({key, scene::number_text(value)}); }
void Simulation::set(const std::string& key, std::span<const real> values) {
    steer({key, scene::to_toml(scene::Value(std::vector<double>(values.begin(), values.end())))});
}

void Simulation::set_at(real time, const scene::Override& change) {
    if (!(time >= this->time() && time < infinity))
        throw BadInput(fmt::format("{} cannot change at {} s: the run is at {} s", change.key, scene::number_text(time),
                                   scene::number_text(this->time())));
    scene_.steered(change, {kind_.schema});  // throws for changes that are not allowed
    const auto later = [](real t, const Change& other) { return t < other.time; };
    changes_.insert(std::upper_bound(changes_.begin() + changed_, changes_.end(), time, later), {time, change});
}

/// Applies the changes that are due.
void Simulation::meet_changes() {
    for (; static_cast<std::size_t>(changed_) < changes_.size(); ++changed_) {
        const auto& next = changes_[static_cast<std::size_t>(changed_)];
        if (!reached(next.time)) return;
        steer(next.what);
    }
}

StepReport Simulation::step() { return step_until(infinity); }

StepReport Simulation::step_until(real t) {
    if (std::isnan(t)) throw BadInput("step_until(nan): expected a time [s]");
    refuse_while_edited("the simulation steps");
    meet_changes();
    const StepReport report = step_towards(std::min(t, finished() && t < infinity ? infinity : next_target()));
    for (std::size_t i = 0; i < observers_.size(); ++i) {  // an observer may add another
        const std::int64_t every = observers_[i].every;
        if (every == 0 ? !at_frame_ : steps_ % every != 0) continue;
        const Observer observer = observers_[i].observer;
        observer(*this, report);
    }
    return report;
}

void Simulation::run_until(real t) {
    if (!std::isfinite(t)) throw BadInput(fmt::format("run_until({}): expected a finite time [s]", t));
    while (!reached(t)) step_until(t);
}

StepReport Simulation::step_towards(real target) {
    const ThreadCountScope scope(threads_.count());
    const sim::StepClock clock;
    const real frame_target = next_frame();
    StepReport report;
    try {
        longest_dt_ = std::max(longest_dt_, uncut_dt());
        const real wanted = wanted_dt(target);
        const StepLimit stable = limit();
        const real dt = within_limit(wanted, stable);
        if (dt < wanted && !split_) warn_of_parts(wanted, dt, stable);
        probes_.before_step(*solver_, dt);
        report = solver_->step(dt);
        sim::check_finite(solver_->checks_itself() ? FieldSet{} : fields(), report);
    } catch (NumericalFailure& failure) {
        failure.step = steps_ + 1;
        failure.time = time();
        throw;
    }
    ++steps_;
    if (steady_rate_ > 0) steady_ = sim::change_and_keep(fields(), last_velocity_) <= steady_rate_ * report.dt;
    choose_threads(clock.elapsed());
    if (const std::string concern = solver_->concern(); !concern.empty()) warn_of_concern(concern);
    at_frame_ = reached(frame_target) || steady_;
    if (at_frame_) ++frame_;
    measure();
    return report;
}

/// In parallel (MPI) a step waits for other processes; its time then says nothing about threads.
void Simulation::choose_threads(const sim::StepTime& step) {
    if (communicator().several()) return;
    threads_.add(step);
    if (const std::string warning = threads_.warning(); !warning.empty()) warnings_.push_back(scene_.file() + ": " + warning);
}

void Simulation::measure() {
    probes_.sample(*solver_);
    for (const std::string& remark : probes_.remarks()) warnings_.push_back(scene_.file() + ": " + remark);
}

bool Simulation::reached(real t) const { return time() >= t - sim::same_time(t); }

/// The time for which steps are shortened: the end or the next change, whichever comes first, and frames with output.at = "exact".
real Simulation::next_target() const {
    real target = meets_frames_ ? next_frame() : end_;
    for (auto at = static_cast<std::size_t>(changed_); at < changes_.size(); ++at)
        if (!reached(changes_[at].time)) return std::min(target, changes_[at].time);
    return target;
}

/// The same without the end of the scene.
real Simulation::next_target_but_end() const {
    real target = meets_frames_ && every_ < infinity ? sim::requested_time(every_, sim::first_after(every_, time())) : infinity;
    for (auto at = static_cast<std::size_t>(changed_); at < changes_.size(); ++at)
        if (!reached(changes_[at].time)) return std::min(target, changes_[at].time);
    return target;
}

bool Simulation::shortens_for_end() const {
    if (finished()) return false;
    const StepLimit stable = limit();
    return within_limit(wanted_dt(next_target()), stable) != within_limit(wanted_dt(next_target_but_end()), stable);
}

/// The next frame, or the end where that comes first. A frame that rounding puts just before the end equals the end.
real Simulation::next_frame() const {
    if (every_ == infinity || finished()) return end_;
    const real frame = sim::requested_time(every_, sim::first_after(every_, time()));
    return frame >= end_ - 1e-9 * every_ ? end_ : frame;
}

real Simulation::uncut_dt() const { return fixed_dt_ > 0 ? fixed_dt_ : std::min(solver_->advised_dt(), max_dt_); }

/// Such a step makes no progress: less than a millionth of the longest step and a billionth of the frame interval.
bool Simulation::hopeless(real dt) const { return dt < 1e-6 * longest_dt_ && dt < 1e-9 * std::min(end_, every_); }

void Simulation::refuse_step(const char* which, real dt) const {
    throw NumericalFailure("time step", fmt::format("the {} step is {} s{}: time no longer advances. Now {}", which, scene::number_text(dt),
                                                    longest_dt_ > dt ? fmt::format(" (the longest was {:.3g} s)", longest_dt_) : "",
                                                    sim::extremes(scene_, fields(), time())));
}

real Simulation::wanted_dt(real target) const {
    const real remaining = target - time();
    const bool fixed = fixed_dt_ > 0;
    const real dt = uncut_dt();
    if (remaining > 0 && (!(dt > sim::same_time(time())) || (!fixed && hopeless(dt)))) refuse_step("advised time", dt);
    if (remaining <= 0) return dt;
    if (dt * stretch >= remaining) return remaining;
    return !fixed && 2 * dt > remaining ? remaining / 2 : dt;  // two equal steps rather than one step and a sliver
}

/// The step itself, bit for bit, where it is stable; otherwise the largest equal part of it that is stable.
real Simulation::within_limit(real dt, const StepLimit& limit) const {
    if (!(dt > limit.dt * stretch)) return dt;
    const real part = dt / std::ceil(dt / limit.dt);
    if (!(part > sim::same_time(time())) || hopeless(part)) refuse_step("longest stable", limit.dt);
    return part;
}

/// Reports only the first concern of each kind; texts that differ only in their numbers are of the same kind.
void Simulation::warn_of_concern(const std::string& concern) {
    const std::string kind = concern.substr(0, concern.find_first_of("0123456789"));
    if (std::find(concerns_.begin(), concerns_.end(), kind) != concerns_.end()) return;
    concerns_.push_back(kind);
    warnings_.push_back(scene_.file() + ": " + concern);
}

void Simulation::warn_of_parts(real wanted, real dt, const StepLimit& limit) {
    split_ = true;
    const char* key = scene_.has("time.dt") ? "time.dt" : "time.cfl";
    warnings_.push_back(
        fmt::format("{}: {} requests a step of {:.4g} s at t = {:.4g} s, and the solver is stable up to {:.4g} s ({}): from here on such "
                    "steps are divided into substeps, now of {:.4g} s (time.guard = \"off\" disables this)",
                    scene_.file(), key, wanted, time(), limit.dt, limit.why, dt));
}

void Simulation::save(Checkpoint& to) const {
    put_text(to, "sim.source", scene_.source());
    put_text(to, "sim.file", scene_.file());
    std::string overrides;
    for (const auto& o : scene_.overrides()) overrides += o.key + '=' + o.value + '\0';
    put_text(to, "sim.overrides", overrides);
    to.put(domain_block, domain_of(scene_));
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
        resume_changes(from);
        if (Partition cut = balanced_partition(from); !cut.empty()) {
            solver_ = make_solver(scene_, kind_, cut);
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

namespace {

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
