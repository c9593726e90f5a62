// What came out of the runs of a case, and what that says about its claims.
#pragma once
#include "validation/harness/band.hpp"
#include "validation/harness/case.hpp"
#include "validation/harness/curve.hpp"
#include "validation/harness/order_table.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// What is kept of one run: its numbers, not its fields.
struct RunResult {
    std::string label{};  // the sweep's value as text; empty without a sweep
    real value = 0;       // of the sweep
    real h = 0;           // mesh width for a sweep over cells [m], else the sweep's value
    double seconds = 0;   // wall clock of all steps
    std::int64_t steps = 0;
    real formal_order = 1;                       // of its solver (harness/band.hpp)
    std::optional<std::string> failure{};        // the run ended early, or a number could not be measured
    bool bad_input = false;                      // ... because the case asks for what is not there (exit code 2, not 1)
    std::map<std::string, real> measured{};      // by metric
    std::map<std::string, std::string> units{};  // of the metrics
    std::map<std::string, Curve> series{};       // histories that claims or figures need
    std::vector<Panel> panels{};                 // drawn by the metrics
};

/// One judged claim.
struct Verdict {
    std::string variant{};
    std::string metric{};
    std::string criterion{};  // at_most, order_at_least, ...
    std::string at{};         // the sweep value it speaks of, where it speaks of one
    real measured = std::nan("");
    real band = std::nan("");  // uncertainty of a value from the grids of its sweep; NaN where it has none
    real low = -infinity, high = infinity;
    bool pass = false;
    std::string why{};
    std::string not_reached{};  // why an open target is not met: listed, not claimed
    std::string note{};         // a failure's message, or a warning about the grids
    double seconds = 0;         // of the runs that it rests on
    /// "<= 1e-08", "in [0.9, 1.1]", ">= 1.8", "<= 2 u_val"
    std::string bound() const;
    /// A claim must hold. What is listed as not reached must have been measured and fall short: once it is met the list is wrong.
    bool as_said() const { return not_reached.empty() ? pass : !pass && !std::isnan(measured); }
    /// "pass", "FAIL", "open": an open target, not met.
    const char* word() const { return !as_said() ? "FAIL" : pass ? "pass" : "open"; }
};

struct VariantResult {
    Variant plan;
    std::vector<RunResult> runs;
    std::vector<Verdict> verdicts;
};

struct CaseResult {
    Case plan;
    std::string source{};  // the reference's citation
    std::vector<VariantResult> variants{};
    bool pass() const;
    bool bad_input() const;
    double seconds() const;
};

/// Judges every claim of a variant. What is NaN, missing, or rests on a failed run does not pass. `before`: variants of the case that were
/// run before, whose grids claims may name.
std::vector<Verdict> judge(const Variant& plan, const std::vector<RunResult>& runs, const std::vector<VariantResult>& before = {});
/// Orders of one metric over the runs of a variant.
OrderTable order_table(const std::vector<RunResult>& runs, const std::string& metric);
/// The band of a value on the finest grid of a sweep over grids; no value for errors, other sweeps, and fewer than three grids.
std::optional<Band> band_of(const Variant& plan, const std::vector<RunResult>& runs, const std::string& metric);
/// Largest rise (or fall) of a series between neighbours, relative to its largest magnitude; NaN if it holds a NaN or nothing.
real largest_rise(const Curve& series, bool falls = false);

}  // namespace weir::validation
