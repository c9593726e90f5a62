// Probes: measurements while a scene runs. A probe with an interval has rows at 0, every, 2 every, ... Each row is interpolated linearly
// between the states before and after the step that passes its time. A probe without an interval has a row after each step. Probes never
// shorten steps.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weir {

/// Samples of one probe. Row i of `values` belongs to times[i] [s] and has one entry per column.
struct ProbeSeries {
    std::string name{};
    std::string kind{};                  // point, line, gauge, wall_pressure, integral, body, front
    std::vector<std::string> columns{};  // "velocity_x [m/s]", "height [m]", ...
    std::vector<Vec<3>> positions{};     // of the sample of each column, where it has one (points, lines, gauges) [m]
    std::vector<real> times{};
    std::vector<std::vector<real>> values{};
    std::int64_t released = 0;  // number of first rows that were written to a file and removed from memory

    /// Number of a column, by its name with or without the unit. Throws BadInput naming the available columns.
    std::size_t column_number(std::string_view wanted) const;
    /// That column over all times.
    std::vector<real> column(std::string_view wanted) const { return column(column_number(wanted)); }
    std::vector<real> column(std::size_t number) const;
};

/// A column split into its name and its unit: "height [m]" into "height" and "m". The unit may be empty.
std::pair<std::string_view, std::string_view> name_and_unit(std::string_view column);

/// The probe of that name. Throws BadInput where there is none.
const ProbeSeries& probe_named(const std::vector<ProbeSeries>& probes, std::string_view name);

namespace sim {

/// One kind of measurement: its columns are fixed at construction, its values come from the current fields.
class ProbeKind {
public:
    virtual ~ProbeKind() = default;
    virtual void describe(ProbeSeries& series) const = 0;
    virtual std::vector<real> measure(const Solver& solver, const FieldSet& fields) const = 0;
    /// A remark about the last measurement for the user, returned once; empty where there is none.
    virtual std::string remark() const { return {}; }
};

class Probes {
public:
    Probes() = default;
    /// The scene's probes. Throws BadScene for probes of quantities that the solver does not have.
    Probes(const scene::Scene& scene, Solver& solver);
    /// Before a step of dt [s]: measures the probes that have a sample time within it.
    void before_step(Solver& solver, real dt);
    /// At the start and after each step: measures every probe that is due.
    void sample(Solver& solver);
    /// Measures now for the rows of the next step. The solver is about to be replaced by one with the same state, which may not provide the
    /// same fields before its first step.
    void keep(Solver& solver);
    /// The state was changed: measurements at the beginning of the next step are no longer valid.
    void forget();
    /// Remarks about measurements since the last call, one line each.
    std::vector<std::string> remarks() const;
    const std::vector<ProbeSeries>& series() const { return series_; }
    /// All rows up to now were written to files: memory and checkpoints keep only their number.
    void release_rows();
    void save(Checkpoint& to, Solver& solver) const;
    void restore(const Checkpoint& from);

private:
    struct Clock {
        real every = 0;           // 0: each step
        std::int64_t next = 0;    // index of the row that is due, at requested_time(every, next)
        bool joins = false;       // the probe begins in the middle of a run: `next` is not known yet
        std::vector<real> begin;  // measured at the beginning of the step; empty: not measured
    };
    void join(std::size_t probe, Solver& solver, FieldSet& fields);
    std::vector<real> measured(std::size_t probe, Solver& solver, FieldSet& fields) const;
    void add_rows(std::size_t probe, Solver& solver, FieldSet& fields);

    std::vector<std::unique_ptr<ProbeKind>> kinds_;
    std::vector<Clock> clocks_;
    std::vector<ProbeSeries> series_;
    real began_ = 0;  // start of the present or the last step [s]
};

}  // namespace sim
}  // namespace weir
