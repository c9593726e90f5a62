// The public interface of weir: load a scene, advance it step by step, read its fields.
//
//   weir::Simulation simulation("cases/dam_break_2d");
//   while (!simulation.finished()) simulation.step();
//   const weir::FieldSet fields = simulation.fields();
#pragma once
#include "core/error.hpp"
#include "core/solver.hpp"
#include "scene/scene.hpp"
#include "scene/solver_kind.hpp"
#include "sim/probes.hpp"
#include "sim/thread_choice.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace weir {

namespace sim {
struct Shares;  // sim/shares.hpp
}

/// A field passed to the callback of edit(): a copy in the layout of FieldView. It replaces the field if all values are valid.
struct FieldEdit {
    std::string set, name, unit;
    Where where = Where::cell;
    GridView grid;
    std::vector<std::vector<real>> data;  // one per component
};

/// A key that changes at a given time of the run [s].
struct Change {
    real time = 0;
    scene::Override what;
};

class Simulation {
public:
    /// A scene file, or a folder with a scene.toml. Throws BadInput.
    explicit Simulation(const std::filesystem::path& scene, const std::vector<scene::Override>& overrides = {});
    explicit Simulation(scene::Scene scene);
    /// With solvers that are not in the registry.
    Simulation(scene::Scene scene, const std::vector<scene::SolverKind>& kinds);

    /// One step of next_dt(). Throws NumericalFailure, with step and time, when a field is no longer finite or a solve fails.
    StepReport step();
    /// One step that does not pass t [s], which must lie ahead; past the end of the scene too.
    StepReport step_until(real t);
    /// Steps until time t [s] is reached exactly: the last one or two steps are shortened. Works past the end of the scene too.
    void run_until(real t);
    /// time.dt, or the step that solver, effects and time.max_dt allow. It is shortened or halved to reach the end, the scene's changes
    /// and, with output.at = "exact", frames exactly. Beyond the stability limit of the solver an equal part of it is taken (time.guard).
    /// Nothing else shortens a step: frames, probes, checkpoints and observers do not change the solution.
    real next_dt() const { return within_limit(wanted_dt(next_target()), limit()); }
    /// Warnings for the user, one line each, each kind once: the first step beyond the stability limit, with the limit and its reason; the
    /// solver's concern about the state; a probe inside a solid.
    const std::vector<std::string>& warnings() const { return warnings_; }

    /// Changes a key that the schema marks as steerable, from the next step on: equivalent to continuing from a checkpoint with another
    /// --set. Throws BadInput where the key or the value is not allowed, and leaves everything unchanged.
    void set(const scene::Override& change);
    void set(const std::string& key, real value);
    void set(const std::string& key, std::span<const real> values);
    /// The same at a time that is not in the past: steps reach it exactly, as if the scene had listed it in its `changes`.
    void set_at(real time, const scene::Override& change);
    /// Returns whether the next step depends on the end of the scene.
    bool shortens_for_end() const;
    /// The latest time that could have shortened a step up to now, had an event been scheduled there.
    real horizon() const { return time() + 2.5 * std::max(longest_dt_, uncut_dt()); }
    /// Every change of the run, including those already applied.
    const std::vector<Change>& changes() const { return changes_; }

    /// Writes a field between two steps: `write` may change all values, but not their number. Then the solver restores the invariants of a
    /// step, so the result may differ from the values written: grid velocities are projected (divergence-free, zero normal velocity at
    /// walls), depths are not negative. Throws BadInput, and leaves everything unchanged, where the field is not editable (see editable()),
    /// a value is not finite or not allowed, or the run is distributed over several ranks. "set.name" selects the set of a field whose name
    /// is ambiguous. While `write` runs, a step or a change of a key, of particles or of another field throws BadInput, because the edit
    /// would overwrite it.
    void edit(std::string_view field, const std::function<void(FieldEdit&)>& write);
    /// The fields that edit() takes: "velocity", "smoke", "particles.position", ...
    std::vector<std::string> editable();
    /// Adds particles to a set ("particles", "markers") at positions inside the domain [m] with velocities [m/s], in 2D with z = 0. Markers
    /// add liquid around them. Throws BadInput as edit() does. Distances to other particles are not checked.
    void add_particles(std::string_view set, std::span<const Vec<3>> at, std::span<const Vec<3>> velocity);
    /// Removes particles by their indices in the set's fields.
    void remove_particles(std::string_view set, std::span<const std::size_t> which);

    /// Registers a callback after each frame, or after a number of steps: to monitor the run or to steer it (set, edit). Its exceptions
    /// propagate out of step().
    using Observer = std::function<void(Simulation&, const StepReport&)>;
    void observe_frames(Observer observer) { observers_.push_back({0, std::move(observer)}); }
    void observe_steps(Observer observer, std::int64_t every = 1);

    bool finished() const { return reached(end_) || steady_ || end_ <= ended_; }
    /// The run ended because the flow is steady (time.stop_when_steady).
    bool steady() const { return steady_; }
    real time() const { return solver_->time(); }  // [s]
    /// Returns whether time t [s] is reached, up to rounding.
    bool reached(real t) const;
    real end_time() const;  // as far as known now [s]
    std::int64_t steps() const { return steps_; }
    /// Frames are at 0, after the first step that reaches each multiple of output.every, and at the end. frame() counts them from 0 and is
    /// the last one reached.
    bool at_frame() const { return at_frame_; }
    bool has_frames() const { return every_ < infinity; }  // besides the first and the last
    std::int64_t frame() const { return frame_; }

    /// Threads of the next step: the number that was set, otherwise at most as many as the scene has work for (ProblemSizeScope), chosen by
    /// measured times (ThreadChoice).
    int threads() const;
    /// In parallel collective (Solver::synchronize).
    FieldSet fields() const {
        solver_->synchronize();
        return static_cast<const Solver&>(*solver_).fields();
    }
    /// Volume, energy and other integrals over the domain; in parallel collective, as fields().
    std::vector<Integral> integrals() const {
        solver_->synchronize();
        return solver_->integrals();
    }
    Solver& solver() { return *solver_; }
    const Solver& solver() const { return *solver_; }
    const scene::Scene& scene() const { return scene_; }
    /// The present partition of the scene. Its partition of planes is empty in one process, and where particles are replicated.
    const sim::Shares& shares() const { return *shares_; }
    /// Returns whether a state, as written by save() or read from a file, should be repartitioned: the rank with most work would have a
    /// tenth less. The call is collective.
    bool needs_repartition(const Checkpoint& state) const;
    /// Repartitions the planes for load balance, from a state in a file that all ranks read. The call is collective and changes no bit of
    /// the solution.
    void repartition(const Checkpoint& state);
    /// Samples of the scene's probes up to now.
    const std::vector<ProbeSeries>& probes() const { return probes_.series(); }
    const ProbeSeries& probe_series(std::string_view name) const { return probe_named(probes(), name); }
    /// For runs that write their probes continuously (sim/probe_files.hpp): removes the rows up to now from memory and later checkpoints.
    void release_probe_rows() { probes_.release_rows(); }

    /// Saves everything that the next step depends on, the scene included.
    void save(Checkpoint& to) const;
    /// Continues from a saved state. Throws BadInput when the checkpoint does not fit the scene.
    void restore(const Checkpoint& from);

private:
    real next_frame() const;
    real next_target() const;
    real next_target_but_end() const;
    real uncut_dt() const;
    void read_times();
    void steer(const scene::Override& change);
    void meet_changes();
    Partition balanced_partition(const Checkpoint& state) const;
    void replace(std::unique_ptr<Solver> solver);
    void resume_changes(const Checkpoint& from);
    real wanted_dt(real target) const;
    bool hopeless(real dt) const;
    [[noreturn]] void refuse_step(const char* which, real dt) const;
    StepLimit limit() const { return guard_ ? solver_->stable_dt() : StepLimit{}; }
    real within_limit(real dt, const StepLimit& limit) const;
    void warn_of_concern(const std::string& concern);
    void warn_of_parts(real wanted, real dt, const StepLimit& limit);
    StepReport step_towards(real target);
    void choose_threads(const sim::StepTime& step);
    void measure();
    EditableField editable_named(std::string_view field);
    void change_state(const std::function<void(Solver&)>& change);
    void refuse_while_edited(const char* what) const;

    scene::Scene scene_;
    scene::SolverKind kind_;
    std::shared_ptr<sim::Shares> shares_;  // used by this simulation alone
    std::unique_ptr<Solver> solver_;
    sim::Probes probes_;
    real end_ = 0, every_ = infinity, fixed_dt_ = 0, max_dt_ = infinity;  // fixed_dt_ 0: the solver advises the step
    bool meets_frames_ = false;                                           // output.at = "exact": steps are shortened for frames
    real ended_ = -infinity;                                              // the end of the run that is continued [s]
    std::int64_t steps_ = 0, frame_ = 0;
    bool at_frame_ = true, guard_ = true, steady_ = false;
    real steady_rate_ = 0;                          // [m/s^2]; 0: no stop when steady
    std::vector<std::vector<real>> last_velocity_;  // that of the last step, where the steady check needs it
    bool split_ = false;                            // whether a step was split
    std::vector<std::string> warnings_, concerns_;  // concerns_: the kinds already reported
    std::vector<Change> changes_;
    std::string files_;         // of the scene, with their contents (sim/scene_files.hpp)
    std::int64_t changed_ = 0;  // number of changes applied
    std::string edited_;        // the field that edit() is writing
    struct Watch {
        std::int64_t every = 0;  // steps; 0: at frames
        Observer observer;
    };
    std::vector<Watch> observers_;
    sim::ThreadChoice threads_;
    real longest_dt_ = 0;  // longest unshortened step so far [s]
};

/// Records in a checkpoint that the run reached this end [s], for which the steps after the checkpoint were shortened. Continued to a later
/// end, the run equals one with that end from the start. With the same end there is nothing left to do.
void put_ended(Checkpoint& to, real end);

/// Reads the scene of a checkpoint from its text and overrides. Throws BadInput.
scene::Scene scene_of(const Checkpoint& checkpoint, const std::vector<scene::Override>& more = {});

}  // namespace weir
