#include "validation/stability/limit.hpp"

#include "core/error.hpp"
#include "sim/simulation.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <map>

namespace weir::validation {
namespace {

/// The value of a series now: an integral, a number of the step's report, or the sum of two: "kinetic_energy+potential_energy".
real value_of(const std::string& series, const Simulation& simulation, const StepReport& report) {
    if (const auto plus = series.find('+'); plus != std::string::npos)
        return value_of(series.substr(0, plus), simulation, report) + value_of(series.substr(plus + 1), simulation, report);
    if (series == "divergence") return report.max_divergence;
    if (series == "iterations") return static_cast<real>(report.iterations);
    if (series == "density_error") return report.density_error;
    if (series == "dt") return report.dt;
    for (const Integral& i : simulation.solver().integrals())
        if (i.name == series) return i.value;
    throw BadInput(fmt::format("no integral or step report is called \"{}\"", series));
}

/// Watches one invariant from step to step.
class Watch {
public:
    Watch(const Invariant& invariant, real pushed)
        : invariant_(&invariant), bound_(invariant.times_value ? pushed * invariant.bound : invariant.bound) {}

    bool holds(real value) {
        using Test = Invariant::Test;
        if (!seen_) first_ = last_ = value, seen_ = true;
        largest_ = std::max(largest_, std::abs(value));
        const real rise = value - last_;
        last_ = value;
        switch (invariant_->test) {
            case Test::at_most:
                return value <= bound_;
            case Test::at_least:
                return value >= bound_;
            case Test::drift:
                return std::abs(value - first_) <= bound_ * std::abs(first_);
            case Test::never_rises:
                return rise <= bound_ * largest_;
        }
        return false;
    }
    const Invariant& invariant() const { return *invariant_; }

private:
    const Invariant* invariant_;
    real bound_;
    bool seen_ = false;
    real first_ = 0, last_ = 0, largest_ = 0;
};

std::string value_text(real value) {
    return value == std::floor(value) && std::abs(value) < 1e15 ? fmt::format("{:.0f}", value) : fmt::format("{:.17g}", value);
}

}  // namespace

std::string Invariant::text() const {
    switch (test) {
        case Test::at_most:
            return fmt::format("{} <= {:g}{}", series, bound, times_value ? " times the key" : "");
        case Test::at_least:
            return fmt::format("{} >= {:g}{}", series, bound, times_value ? " times the key" : "");
        case Test::drift:
            return fmt::format("{} within {:g} of its first value", series, bound);
        case Test::never_rises:
            return fmt::format("{} never rises", series);
    }
    return series;
}

std::optional<Break> push(const Stress& stress, real value, const Solvers& solvers) {
    std::vector<scene::SolverSchema> schemas;
    for (const auto& kind : solvers) schemas.push_back(kind.schema);
    Variant variant = stress.base;
    variant.overrides.push_back({stress.key, value_text(value)});
    try {
        Simulation simulation(scene_of(variant, 0, schemas), solvers);
        std::vector<Watch> watches;
        for (const Invariant& invariant : stress.watch) watches.emplace_back(invariant, value);
        StepReport report;
        const auto broken = [&]() -> std::optional<Break> {
            for (Watch& watch : watches) {
                const std::string& series = watch.invariant().series;
                if (simulation.steps() == 0 && (series == "divergence" || series == "density_error" || series == "dt")) continue;
                if (const real v = value_of(series, simulation, report); !watch.holds(v))
                    return Break{fmt::format("{}: {:.4g}", watch.invariant().text(), v), simulation.steps(), simulation.time()};
            }
            return std::nullopt;
        };
        if (auto at_start = broken()) return at_start;
        while (!simulation.finished() && simulation.steps() < stress.steps) {
            try {
                report = simulation.step();
            } catch (const NumericalFailure& failure) {
                return Break{failure.what(), simulation.steps() + 1, simulation.time()};
            }
            if (auto found = broken()) return found;
        }
    } catch (const NumericalFailure& failure) {  // of the initial state
        return Break{failure.what(), 0, 0};
    }
    return std::nullopt;
}

Limit bisect(const Stress& stress, real factor, const std::function<std::optional<Break>(real)>& push) {
    Limit limit{.stress = stress};
    const auto start = std::chrono::steady_clock::now();
    const auto stable = [&](real value) {
        ++limit.runs;
        const auto broke = push(value);
        if (broke)
            limit.first_unstable = value, limit.broke = *broke;
        else
            limit.last_stable = value;
        return !broke;
    };
    if (stable(stress.low) && stress.high < infinity && !stable(stress.high))
        while (*limit.first_unstable > factor * *limit.last_stable) stable(std::sqrt(*limit.last_stable * *limit.first_unstable));
    limit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return limit;
}

Limit check_floor(const Stress& stress, const Solvers& solvers) {
    Stress at_floor = stress;
    at_floor.low = *stress.floor, at_floor.high = infinity;  // nothing further is tried
    return bisect(at_floor, 1, [&](real value) { return push(stress, value, solvers); });
}

Limit find_limit(const Stress& stress, real factor, const Solvers& solvers) {
    return bisect(stress, factor, [&](real value) { return push(stress, value, solvers); });
}

}  // namespace weir::validation
