// What all methods on numbered cells share: gathering, the compatible right-hand side, the true residual, and the verdict.
#pragma once
#include "poisson/system.hpp"

#include <chrono>

namespace weir::poisson {

/// Counts iterations against the options and keeps the history. One a solve.
class Progress {
public:
    Progress(const Options& options, Report& report) : options_(options), report_(report) {}
    /// Is another iteration wanted, given the relative residual as the iteration sees it?
    bool wants_more(real relative_residual) const {
        if (report_.iterations >= options_.max_iterations || !std::isfinite(relative_residual)) return false;
        return relative_residual > (options_.fixed_iterations ? nothing_left : options_.tolerance);
    }
    /// Would one more iteration that reaches this residual be the last?
    bool would_end(real relative_residual) const {
        return report_.iterations + 1 >= options_.max_iterations ||
               relative_residual <= (options_.fixed_iterations ? nothing_left : options_.tolerance);
    }
    void count(real relative_residual) {
        ++report_.iterations;
        if (options_.record_history) report_.history.push_back(relative_residual);
    }

private:
    /// A recursive residual this small changes no bit of the solution any more; further down it is round-off divided by round-off.
    static constexpr real nothing_left = 1e-20;

    const Options& options_;
    Report& report_;
};

/// Seconds since its construction.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Throws NumericalFailure if the report's true residual is not finite, or misses the tolerance that the options demand.
void judge(const Options& options, Report& report);
void check_extents(bool same, const char* what);

template <int D>
class ListSolver : public Solver<D> {
public:
    explicit ListSolver(const Options& options) : options_(options) {}
    void setup(const Operator<D>& A) final;
    const Report& solve(Grid<real, D>& p, const Grid<real, D>& b) final { return continue_solve({}, p, b); }
    /// The same, with the iterations and the history of another method's attempt counted in.
    const Report& continue_solve(const Report& attempt, Grid<real, D>& p, const Grid<real, D>& b);
    void aim(real tolerance) final { options_.tolerance = tolerance; }
    std::size_t bytes() const final;

protected:
    /// Called by setup() when system_ is ready.
    virtual void prepare() = 0;
    /// Improves x_ towards A x = b_ until progress is content or nothing more can be gained; b_ is compatible and not zero.
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
