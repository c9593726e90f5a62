// A run of a scene: the time loop's step, changes of keys, and the partition of the grid.
#include "sim/simulation.hpp"

#include "core/parallel.hpp"
#include "core/thread_count.hpp"
#include "geometry/mesh/mesh.hpp"
#include "mac/bodies/thin_solids.hpp"
#include "parallel/load_balance.hpp"
#include "scene/given.hpp"
#include "scene/names.hpp"
#include "scene/steer.hpp"
#include "sim/finite.hpp"
#include "sim/make_solver.hpp"
#include "sim/memory_estimate.hpp"
#include "sim/registry.hpp"
#include "sim/requested_times.hpp"
#include "sim/room.hpp"
#include "sim/scene_files.hpp"
#include "sim/shares.hpp"
#include "sim/steadiness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace weir {

namespace {

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
      solver_(sim::make_solver(scene_, kind_, shares_->cut)),
      probes_(scene_, *solver_),
      every_(scene_.root().number_or("output.every", infinity)),
      meets_frames_(scene_.text("output.at") == "exact"),
      steady_rate_(scene_.root().number_or("time.stop_when_steady", 0)),
      changes_(changes_in(scene_)),
      files_(sim::lines_of(sim::scene_files(scene_))),
      threads_(sim::threads_for(scene_)) {
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
    std::unique_ptr<Solver> solver = sim::make_solver(changed, kind_, shares_->cut);
    if (!change.key.starts_with("time.") && !changed.root().was_read(change.key))
        changed.refuse(change.key, change.key + " has no effect in this scene");
    solver->restore(state);
    replace(std::move(solver));
    scene_ = std::move(changed);
    files_ = sim::lines_of(sim::scene_files(scene_));
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
    std::unique_ptr<Solver> solver = sim::make_solver(scene_, kind_, cut);
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

/// Reports only the first concern of each kind; texts that differ only in their numbers are of the same kind.
void Simulation::warn_of_concern(const std::string& concern) {
    const std::string kind = concern.substr(0, concern.find_first_of("0123456789"));
    if (std::find(concerns_.begin(), concerns_.end(), kind) != concerns_.end()) return;
    concerns_.push_back(kind);
    warnings_.push_back(scene_.file() + ": " + concern);
}

}  // namespace weir
