// Probes: what a scene measures while it runs. A probe is sampled at the first step at or after each multiple of its interval, and the
// time of that step is recorded: steps are never cut for a probe, and nothing is interpolated in time.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// Samples of one probe. Row i of `values` was taken at times[i] [s] and has one entry a column.
struct ProbeSeries {
    std::string name;
    std::string kind;                  // point, line, gauge, wall_pressure, integral, body, front
    std::vector<std::string> columns;  // "velocity_x [m/s]", "height [m]", ...
    std::vector<Vec<3>> positions;     // of each column's sample where it has one (points, lines, gauges) [m]
    std::vector<real> times;
    std::vector<std::vector<real>> values;

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
};

class Probes {
public:
    Probes() = default;
    /// The scene's probes; those that ask for what the solver does not have are refused (BadScene).
    Probes(const scene::Scene& scene, const Solver& solver);
    /// Measures with every probe that is due at this time.
    void sample(const Solver& solver);
    const std::vector<ProbeSeries>& series() const { return series_; }
    const ProbeSeries& series(std::string_view name) const;
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);

private:
    struct Clock {
        real every = 0;  // 0: each step
        real next = 0;   // due at or after [s]
    };
    std::vector<std::unique_ptr<ProbeKind>> kinds_;
    std::vector<Clock> clocks_;
    std::vector<ProbeSeries> series_;
};

}  // namespace sim
}  // namespace weir
