#include "validation/stability/limit.hpp"

#include "core/error.hpp"
#include "core/step_quantities.hpp"
#include "sim/loop.hpp"
#include "sim/simulation.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>

namespace weir::validation {
namespace {

constexpr int values_of_axis = 6;  // from the low end of an axis to its high end

/// Returns whether a quantity has no value before the first step.
bool needs_step(const std::string& series) { return find_step_quantity(series) || series == "fastest"; }

/// Watches one invariant from step to step.
class Watch {
public:
    Watch(const Invariant& invariant, real pushed) : invariant_(&invariant), bound_(invariant.bound * std::pow(pushed, invariant.power)) {}

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

/// What "a", "a^p" or "a^p round" is at `value`.
std::string placeholder_text(const std::string& text, real value) {
    const char* at = text.c_str();
    char* after = nullptr;
    real result = std::strtod(at, &after);
    bool good = after != at;
    real power = 1;
    if (*after == '^') power = std::strtod(at = after + 1, &after), good = good && after != at;
    result *= std::pow(value, power);
    if (std::string_view(after) == " round")
        result = std::max(1.0, std::round(result));
    else
        good = good && *after == '\0';
    if (!good) throw BadInput(fmt::format("<{}>: expected <a>, <a^p> or <a^p round>, with numbers a and p", text));
    return value_text(result);
}

std::string filled_in(const std::string& text, real value) {
    std::string s;
    for (std::size_t at = 0;;) {
        const auto open = text.find('<', at), close = text.find('>', open);
        if (open == std::string::npos || close == std::string::npos) return s + text.substr(at);
        s += text.substr(at, open - at) + placeholder_text(text.substr(open + 1, close - open - 1), value);
        at = close + 1;
    }
}

std::string growth(real power) { return power == 0 ? "" : power == 1 ? " times the key" : fmt::format(" times the key^{:g}", power); }

}  // namespace

std::string_view name(AxisKind kind) { return kind == AxisKind::limit ? "limit" : kind == AxisKind::units ? "units" : "guard"; }

std::string Limit::doubt() const {
    if (!climbed) return {};
    if (stress.open_target && last_stable && *last_stable >= *stress.open_target) return "the open target is met: list it as a floor";
    if (first_unstable && stress.kind == AxisKind::units) return "dimensionally similar parameter values do not all pass";
    if (first_unstable && !stress.unbroken.empty()) return "it fails, although the study states that it cannot";
    if (!first_unstable && stress.kind == AxisKind::limit && stress.unbroken.empty())
        return "no failure up to the highest value: raise \"high\", or give the reason in \"unbroken\"";
    return {};
}

std::string Invariant::text() const {
    switch (test) {
        case Test::at_most:
            return fmt::format("{} <= {:g}{}", series, bound, growth(power));
        case Test::at_least:
            return fmt::format("{} >= {:g}{}", series, bound, growth(power));
        case Test::drift:
            return fmt::format("{} within {:g} of its first value", series, bound);
        case Test::never_rises:
            return fmt::format("{} never rises", series);
    }
    return series;
}

Variant pushed_to(const Stress& stress, real value) {
    Variant variant = stress.base;
    for (scene::Override& change : variant.overrides) change.value = filled_in(change.value, value);
    if (!stress.key.empty()) variant.overrides.push_back({stress.key, value_text(value)});
    return variant;
}

std::optional<Break> run_watched(const Variant& variant, const Stress& stress, real value, const Solvers& solvers,
                                 std::vector<MeasuredValue>* measured) {
    const auto schemas = scene::schemas_of(solvers);
    auto scene = scene_of(variant, 0, schemas);
    const auto failed = [](const NumericalFailure& failure, std::int64_t step, real time) {
        return Break{failure.what(), "the step failed", step, time};
    };
    std::optional<Simulation> simulation;
    try {
        simulation.emplace(std::move(scene), solvers);
    } catch (const NumericalFailure& failure) {
        return failed(failure, 0, 0);
    } catch (const BadInput& refusal) {
        std::string_view why = refusal.what();
        for (const scene::Override& change : variant.overrides)  // which change it was the axis says
            if (const std::string prefix = fmt::format("--set {}={}: ", change.key, change.value); why.starts_with(prefix))
                why.remove_prefix(prefix.size());
        return Break{fmt::format("refused: {}", why), "refused", 0, 0};
    }
    std::vector<Watch> watches;
    for (const Invariant& invariant : stress.watch) watches.emplace_back(invariant, value);
    Preconditions preconditions(stress.preconditions, value);
    const auto check = [&](bool at_start) {
        if (const std::string what = preconditions.missing(at_start); !what.empty())
            throw BadInput(fmt::format("axis \"{}\"{}{} at {:g} does not meet its stated difficulty: {}", stress.name,
                                       stress.method.empty() ? "" : " of ", stress.method, value, what));
    };
    preconditions.start(*simulation), check(true);
    StepReport report;
    const auto broken = [&]() -> std::optional<Break> {
        for (Watch& watch : watches) {
            const std::string& series = watch.invariant().series;
            if (simulation->steps() == 0 && needs_step(series)) continue;
            if (const real v = value_of(series, *simulation, report); !watch.holds(v))
                return Break{fmt::format("{}: {:.4g}", watch.invariant().text(), v), watch.invariant().text(), simulation->steps(),
                             simulation->time()};
        }
        return std::nullopt;
    };
    if (auto at_start = broken()) return at_start;
    std::optional<Break> found;
    try {
        sim::advance(*simulation, {.steps = stress.steps}, [&](const StepReport& last, double) {
            report = last;
            preconditions.step(*simulation, report);
            found = broken();
            return !found;
        });
    } catch (const NumericalFailure& failure) {
        return failed(failure, simulation->steps() + 1, simulation->time());
    }
    if (found) return found;
    preconditions.end(*simulation, report);
    if (!stress.cut) check(false);
    if (measured) *measured = preconditions.measured();
    return std::nullopt;
}

std::optional<Break> push(const Stress& stress, real value, const Solvers& solvers, std::vector<MeasuredValue>* measured) {
    return run_watched(pushed_to(stress, value), stress, value, solvers, measured);
}

std::vector<std::vector<std::optional<Break>>> fill_map(const StressMap& map, const Solvers& solvers,
                                                        const std::function<void(std::size_t)>& progress) {
    std::vector<std::vector<std::optional<Break>>> cells(map.x.values.size());
    std::size_t done = 0;
    for (std::size_t i = 0; i < map.x.values.size(); ++i)
        for (const std::string& y : map.y.values) {
            if (progress) progress(done++);
            Variant variant = map.stress.base;
            variant.overrides.push_back({map.x.key, map.x.values[i]});
            variant.overrides.push_back({map.y.key, y});
            cells[i].push_back(run_watched(variant, map.stress, 1, solvers));
        }
    return cells;
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
    // Climbed in equal steps of the logarithm: what is stable at the end of an axis need not be so below it.
    const bool tried = stress.nested && stress.high < infinity;
    bool holds = !(tried && stable(stress.high)) && stable(stress.low);
    for (int k = 1; holds && stress.high < infinity && k <= values_of_axis; ++k)
        holds = stable(k == values_of_axis ? stress.high
                                           : stress.low * std::pow(stress.high / stress.low, static_cast<real>(k) / values_of_axis));
    if (limit.last_stable && limit.first_unstable)
        while (*limit.first_unstable > factor * *limit.last_stable) stable(std::sqrt(*limit.last_stable * *limit.first_unstable));
    limit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return limit;
}

namespace {

/// The limit with the measured preconditions at its last stable value.
Limit with_preconditions(const Stress& axis, const Stress& stress, real factor, const Solvers& solvers) {
    std::vector<MeasuredValue> latest, at_last_stable;
    Limit limit = bisect(axis, factor, [&](real value) {
        const auto broke = push(stress, value, solvers, &latest);
        if (!broke) at_last_stable = latest;
        return broke;
    });
    limit.preconditions = at_last_stable;
    return limit;
}

}  // namespace

Limit check_guaranteed(const Stress& stress, const Solvers& solvers) {
    Stress at_guaranteed = stress;
    at_guaranteed.low = *stress.guaranteed, at_guaranteed.high = infinity;  // nothing further is tried
    return with_preconditions(at_guaranteed, stress, 1, solvers);
}

Limit recheck(const Stress& stress, std::optional<real> last_stable, std::optional<real> first_unstable, const Solvers& solvers) {
    Limit limit{.stress = stress, .climbed = true};
    const auto start = std::chrono::steady_clock::now();
    if (last_stable && !push(stress, *last_stable, solvers, &limit.preconditions)) limit.last_stable = last_stable;
    if (first_unstable)
        if (const auto broke = push(stress, *first_unstable, solvers)) limit.first_unstable = first_unstable, limit.broke = *broke;
    limit.runs = last_stable.has_value() + first_unstable.has_value();
    limit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return limit;
}

Limit find_limit(const Stress& stress, real factor, const Solvers& solvers) {
    Limit limit = with_preconditions(stress, stress, factor, solvers);
    limit.climbed = true;
    return limit;
}

}  // namespace weir::validation
