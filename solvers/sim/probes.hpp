// Probes: what a scene measures while it runs. A probe with an interval has rows at 0, every, 2 every, ..., each linear in time between the
// states before and after the step that passes that time; a probe without one has a row after each step. Steps are never shortened for a
// probe.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// Samples of one probe. Row i of `values` is of times[i] [s] and has one entry a column.
struct ProbeSeries {
    std::string name;
    std::string kind;                  // point, line, gauge, wall_pressure, integral, body, front
    std::vector<std::string> columns;  // "velocity_x [m/s]", "height [m]", ...
    std::vector<Vec<3>> positions;     // of each column's sample where it has one (points, lines, gauges) [m]
    std::vector<real> times;
    std::vector<std::vector<real>> values;
    std::int64_t released = 0;  // rows before these, which were written to a file and are no longer in memory

    /// One column over all times, by its name with or without the unit. Throws BadInput naming the columns there are.
    std::vector<real> column(std::string_view wanted) const;
};

namespace sim {

/// One way to measure: its columns are fixed when it is made, its values are taken from the fields of the moment.
class ProbeKind {
public:
    virtual ~ProbeKind() = default;
    virtual void describe(ProbeSeries& series) const = 0;
    virtual std::vector<real> measure(const Solver& solver, const FieldSet& fields) const = 0;
    /// What a user should know of the last measurement, said once; empty where nothing is.
    virtual std::string remark() const { return {}; }
};

class Probes {
public:
    Probes() = default;
    /// The scene's probes; those that ask for what the solver does not have are refused (BadScene).
    Probes(const scene::Scene& scene, const Solver& solver);
    /// Measures, before a step of dt [s], with the probes that have a time within it.
    void before_step(const Solver& solver, real dt);
    /// Measures, at the start and after each step, with every probe that is due.
    void sample(const Solver& solver);
    /// Measures now for the rows of the next step, which begins at the present time: the solver is about to be replaced by one that has
    /// the same state, and need not show the same fields before it has stepped.
    void keep(const Solver& solver);
    /// The state was changed: what was measured of it is no longer where the next step begins.
    void forget();
    /// What there is to say of measurements since the last call, one line each.
    std::vector<std::string> remarks() const;
    const std::vector<ProbeSeries>& series() const { return series_; }
    const ProbeSeries& series(std::string_view name) const;
    /// All rows up to now are in files: memory and checkpoints keep how many they are.
    void release_rows();
    void save(Checkpoint& to, const Solver& solver) const;
    void restore(const Checkpoint& from);

private:
    struct Clock {
        real every = 0;           // 0: each step
        std::int64_t next = 0;    // the row that is due is number `next`, at asked_time(every, next)
        bool joins = false;       // the probe begins in the middle of a run: `next` is not known yet
        std::vector<real> begin;  // measured where the step begins; empty: it was not
    };
    void join(std::size_t probe, const Solver& solver, FieldSet& fields);
    std::vector<real> measured(std::size_t probe, const Solver& solver, FieldSet& fields) const;
    void add_rows(std::size_t probe, const Solver& solver, FieldSet& fields);

    std::vector<std::unique_ptr<ProbeKind>> kinds_;
    std::vector<Clock> clocks_;
    std::vector<ProbeSeries> series_;
    real began_ = 0;  // the present or the last step [s]
};

}  // namespace sim
}  // namespace weir
