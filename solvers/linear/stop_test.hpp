// The stop test of iterative linear solves, and their one message for a missed tolerance.
#pragma once
#include "core/types.hpp"

#include <cmath>
#include <vector>

namespace weir::linear {

/// A smaller recursive residual no longer changes the solution; below it is a ratio of round-off errors.
inline constexpr real round_off = 1e-20;

/// Ends the iterations at a relative residual of at most `tolerance`, after `limit` iterations, or at a residual that is not finite. Counts
/// the iterations in `iterations`, which may include those of an earlier attempt, and appends each residual to `history` unless that is
/// nullptr.
class StopTest {
public:
    StopTest(real tolerance, int limit, int& iterations, std::vector<real>* history = nullptr)
        : tolerance_(tolerance), limit_(limit), iterations_(iterations), history_(history) {}
    /// Returns whether another iteration is required, given the relative residual of the iteration.
    bool wants_more(real relative_residual) const {
        return iterations_ < limit_ && std::isfinite(relative_residual) && relative_residual > tolerance_;
    }
    /// Returns whether an iteration that reaches this residual would be the last.
    bool would_end(real relative_residual) const { return iterations_ + 1 >= limit_ || relative_residual <= tolerance_; }
    void count(real relative_residual) {
        ++iterations_;
        if (history_) history_->push_back(relative_residual);
    }
    real tolerance() const { return tolerance_; }
    int iterations() const { return iterations_; }

private:
    real tolerance_;
    int limit_;
    int& iterations_;
    std::vector<real>* history_;
};

/// Result of a solve: the last relative residual, and whether it ended without a direction p with p·A p > 0 (and r·z > 0). That is
/// round-off at the end of the convergence, or A or M is not positive definite.
struct Outcome {
    real relative_residual = 0;
    bool broke_down = false;
};

/// Throws NumericalFailure(quantity): "SOLVE: relative residual R after N iterations, tolerance T".
[[noreturn]] void fail(const char* quantity, const char* solve, const Outcome& outcome, int iterations, real tolerance);
/// The same where the outcome misses the tolerance.
void require_converged(const char* quantity, const char* solve, const Outcome& outcome, const StopTest& stop);

}  // namespace weir::linear
