// The public face of weir: a scene in, step by step, fields out.
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

/// A field as edit() hands it out: a copy, laid out as FieldView says, that takes the field's place when all of it may be.
struct FieldEdit {
    std::string set, name, unit;
    Where where = Where::cell;
    GridView grid;
    std::vector<std::vector<real>> data;  // one a component
};

/// A key that changes at a time of the run [s].
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
    /// One step that does not pass t [s], which has not been reached; past the end of the scene too.
    StepReport step_until(real t);
    /// Steps until time t [s] is reached exactly, for which the last one or two are shortened; past the end of the scene too.
    void run_until(real t);
    /// time.dt, or what solver and effects advise and time.max_dt allows; shortened or halved so that the end and the scene's changes are
    /// met exactly, and frames with output.at = "exact"; where that is longer than the solver is stable for, an equal part of it
    /// (time.guard). Nothing else shortens a step: frames, probes, checkpoints and observers do not change the solution.
    real next_dt() const { return within_limit(wanted_dt(next_target()), limit()); }
    /// What a user should know, one line each, each kind once: the first step that was longer than the solver is stable for, with its
    /// limit and why; the solver's own concern about the state; a probe that a solid covers.
    const std::vector<std::string>& warnings() const { return warnings_; }

    /// Changes a key that the schema marks as steerable, from the next step on: as if the run went on from a checkpoint with another
    /// --set. Throws BadInput where the key or the value may not be, and leaves all as it was.
    void set(const scene::Override& change);
    void set(const std::string& key, real value);
    void set(const std::string& key, std::span<const real> values);
    /// The same at a time that is not over yet: steps meet it exactly, as if the scene had named it in its `changes`.
    void set_at(real time, const scene::Override& change);
    /// Whether the next step is another one than it would be if the scene ended later.
    bool shortens_for_end() const;
    /// A time that no step up to now would have been cut for, had it been known that something happens there.
    real horizon() const { return time() + 2.5 * std::max(longest_dt_, uncut_dt()); }
    /// Every change that the run is to meet, those that it has met included.
    const std::vector<Change>& changes() const { return changes_; }

    /// Writes a field between two steps: `write` gets it and changes what it likes but the number of values. Then the solver makes good
    /// what every step leaves behind, so that the field may come out otherwise than it was written: a velocity of grids free of divergence
    /// and still at walls, a depth nowhere negative. Throws BadInput where the solver has no such field that may be written (editable()
    /// names them), where a value is not finite or cannot be, or where the run goes over several ranks, and leaves all as it was.
    /// "set.name" where the name alone could be several. While `write` runs the simulation does not change: a step, a change of a key, of
    /// particles or of another field throws BadInput, as what was written would undo it.
    void edit(std::string_view field, const std::function<void(FieldEdit&)>& write);
    /// The fields that edit() takes: "velocity", "smoke", "particles.position", ...
    std::vector<std::string> editable();
    /// New particles of a set ("particles", "markers") at places inside the domain [m] with velocities [m/s], in 2D with z = 0. Markers
    /// make the liquid around them. Throws BadInput as edit() does. Nobody checks how near they are to others.
    void add_particles(std::string_view set, std::span<const Vec<3>> at, std::span<const Vec<3>> velocity);
    /// Takes out particles by their places in the set's fields.
    void remove_particles(std::string_view set, std::span<const std::size_t> which);

    /// From here on called after each frame, or after every so many steps: a look at the run, or a hand in it (set, edit). What it throws
    /// comes out of step().
    using Observer = std::function<void(Simulation&, const StepReport&)>;
    void observe_frames(Observer observer) { observers_.push_back({0, std::move(observer)}); }
    void observe_steps(Observer observer, std::int64_t every = 1);

    bool finished() const { return reached(end_) || steady_ || end_ <= ended_; }
    /// The run ended because nothing changed any more (time.stop_when_steady).
    bool steady() const { return steady_; }
    real time() const { return solver_->time(); }  // [s]
    /// Time t [s] has come, but for rounding.
    bool reached(real t) const;
    real end_time() const;  // as far as is known now [s]
    std::int64_t steps() const { return steps_; }
    /// Frames stand at 0, after the first step that reaches each multiple of output.every, and at the end. frame() counts them from 0; it
    /// is the last one that was reached.
    bool at_frame() const { return at_frame_; }
    bool has_frames() const { return every_ < infinity; }  // others than the first and the last
    std::int64_t frame() const { return frame_; }

    /// Threads of the next step: as many as were set, else at most those that the scene has work for (ThreadsWorth), as measured times
    /// choose (ThreadChoice).
    int threads() const;
    FieldSet fields() const { return static_cast<const Solver&>(*solver_).fields(); }
    Solver& solver() { return *solver_; }
    const Solver& solver() const { return *solver_; }
    const scene::Scene& scene() const { return scene_; }
    /// What each of several ranks has of the scene now. Its cut of planes is empty in one process, and where particles are shared.
    const sim::Shares& shares() const { return *shares_; }
    /// Whether a state, as save() has put it or as it was read, asks for another cut: whoever has most to do would have a tenth less. All
    /// ranks ask together.
    bool asks_for_other_cut(const Checkpoint& state) const;
    /// Cuts the planes anew, as the state of now asks for, read from a file by all ranks together. Changes no bit of what is computed.
    void cut_anew(const Checkpoint& state);
    /// What the scene's probes have measured so far.
    const std::vector<ProbeSeries>& probes() const { return probes_.series(); }
    const ProbeSeries& probe_series(std::string_view name) const { return probes_.series(name); }
    /// For runs whose probes are written as they come (sim/probe_files.hpp): rows up to now leave the memory, and later checkpoints.
    void release_probe_rows() { probes_.release_rows(); }

    /// Everything that the next step depends on, the scene included.
    void save(Checkpoint& to) const;
    /// Continues where save() was called. Throws BadInput when the checkpoint belongs to another kind of scene.
    void restore(const Checkpoint& from);

private:
    real next_frame() const;
    real next_target() const;
    real next_target_but_end() const;
    real uncut_dt() const;
    void read_times();
    void steer(const scene::Override& change);
    void meet_changes();
    Cut better_cut(const Checkpoint& state) const;
    void replace(std::unique_ptr<Solver> solver);
    void resume_changes(const Checkpoint& from);
    real wanted_dt(real target) const;
    bool hopeless(real dt) const;
    [[noreturn]] void refuse_step(const char* which, real dt) const;
    StepLimit limit() const { return guard_ ? solver_->stable_dt() : StepLimit{}; }
    real within_limit(real dt, const StepLimit& limit) const;
    void tell_concern(const std::string& concern);
    void tell_of_parts(real wanted, real dt, const StepLimit& limit);
    StepReport step_towards(real target);
    void choose_threads(const sim::StepTime& step);
    void measure();
    EditableField editable_named(std::string_view field);
    void change_state(const std::function<void(Solver&)>& change);
    void refuse_while_edited(const char* what) const;

    scene::Scene scene_;
    scene::SolverKind kind_;
    std::shared_ptr<sim::Shares> shares_;  // of this simulation alone
    std::unique_ptr<Solver> solver_;
    sim::Probes probes_;
    real end_ = 0, every_ = infinity, fixed_dt_ = 0, max_dt_ = infinity;  // fixed_dt_ 0: the solver advises
    bool meets_frames_ = false;                                           // output.at = "exact": steps are shortened for frames
    real ended_ = -infinity;                                              // the end of the run that this one continues [s]
    std::int64_t steps_ = 0, frame_ = 0;
    bool at_frame_ = true, guard_ = true, steady_ = false;
    real steady_rate_ = 0;                          // [m/s^2]; 0: not asked for
    std::vector<std::vector<real>> last_velocity_;  // where it is, that of the last step
    bool split_ = false;                            // whether a step was taken in parts
    std::vector<std::string> warnings_, concerns_;  // concerns_: the kinds that were told
    std::vector<Change> changes_;
    std::int64_t changed_ = 0;  // how many of them the run has met
    std::string edited_;        // the field that edit() writes now
    struct Watch {
        std::int64_t every = 0;  // steps; 0: at frames
        Observer observer;
    };
    std::vector<Watch> observers_;
    sim::ThreadChoice threads_;
    real longest_dt_ = 0;  // that was wanted so far, before it was shortened [s]
};

/// Says in a checkpoint that the run reached this end [s], to which the steps after the checkpoint were shortened: it continues to a later
/// end as if that had been the scene's from the start, and with the same end nothing is left to do.
void put_ended(Checkpoint& to, real end);

/// The scene that a checkpoint was made from, as its text and overrides. Throws BadInput.
scene::Scene scene_of(const Checkpoint& checkpoint, const std::vector<scene::Override>& more = {});

}  // namespace weir
