// Shared by all methods on numbered cells: gathering, the compatible right-hand side, the true residual, and the check of the tolerance.
#pragma once
#include "poisson/system.hpp"

#include <chrono>

namespace weir::poisson {

/// Counts iterations against the options and records the history. One per solve.
class Progress {
public:
    Progress(const Options& options, Report& report) : options_(options), report_(report) {}
    /// Returns whether another iteration is required, given the relative residual of the iteration.
    bool wants_more(real relative_residual) const {
        if (report_.iterations >= options_.max_iterations || !std::isfinite(relative_residual)) return false;
        return relative_residual > (options_.fixed_iterations ? nothing_left : options_.tolerance);
    }
    /// Returns whether an iteration that reaches this residual would be the last.
    bool would_end(real relative_residual) const {
        return report_.iterations + 1 >= options_.max_iterations ||
               relative_residual <= (options_.fixed_iterations ? nothing_left : options_.tolerance);
    }
    void count(real relative_residual) {
        ++report_.iterations;
        if (options_.record_history) report_.history.push_back(relative_residual);
    }

private:
    /// A smaller recursive residual no longer changes the solution; below it is a ratio of round-off errors.
    static constexpr real nothing_left = 1e-20;

    const Options& options_;
    Report& report_;
};

/// Measures seconds since its construction.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Throws NumericalFailure if the report's true residual is not finite, or misses the required tolerance.
void judge(const Options& options, Report& report);
void check_extents(bool same, const char* what);

template <int D>
class ListSolver : public Solver<D> {
public:
    explicit ListSolver(const Options& options) : options_(options) {}
    void setup(const Operator<D>& A) final;
    const Report& solve(Grid<real, D>& p, const Grid<real, D>& b) final { return continue_solve({}, p, b); }
    /// The same; iterations and history include those of another method's attempt.
    const Report& continue_solve(const Report& attempt, Grid<real, D>& p, const Grid<real, D>& b);
    void set_tolerance(real tolerance) final { options_.tolerance = tolerance; }
    std::size_t bytes() const final;

protected:
    /// Called by setup() when system_ is ready.
    virtual void prepare() = 0;
    /// Improves x_ towards A x = b_ until progress is satisfied or no further gain is possible; b_ is compatible and not zero.
    virtual void iterate(Progress& progress) = 0;
    virtual std::size_t own_bytes() const { return 0; }

    Options options_;
    System<D> system_;
    Vector x_, b_, r_;
    real b_norm_ = 0;

private:
    real true_residual();
    Index<D> extent_{};
    Report report_;
};

}  // namespace weir::poisson
