// Shared by all methods on numbered cells: gathering, the compatible right-hand side, the true residual, and the check of the tolerance.
#pragma once
#include "linear/stop_test.hpp"
#include "poisson/matrix/system.hpp"
#include "poisson/zero_coupling.hpp"

#include <chrono>

namespace weir::poisson {

/// The stop test of a solve; it counts in the report. With fixed_iterations only round-off ends it earlier.
inline linear::StopTest stop_test(const Options& options, Report& report) {
    return {options.fixed_iterations ? linear::round_off : options.tolerance, options.max_iterations, report.iterations,
            options.record_history ? &report.history : nullptr};
}

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
class ListSolver : public Solver<D>, public ZeroCoupling<D> {
public:
    explicit ListSolver(const Options& options) : options_(options) {}
    void setup(const Operator<D>& A) final;
    const Report& solve(Grid<real, D>& p, const Grid<real, D>& b) final { return continue_solve({}, p, b); }
    /// The same; iterations and history include those of another method's attempt.
    const Report& continue_solve(const Report& attempt, Grid<real, D>& p, const Grid<real, D>& b);
    void couple_to_zero(const Grid<real, D>* z) final { zero_ = z; }
    void set_tolerance(real tolerance) final { options_.tolerance = tolerance; }
    std::size_t bytes() const final;

protected:
    /// Called by setup() when system_ is ready.
    virtual void prepare() = 0;
    /// Improves x_ towards A x = b_ until the stop test ends it or no further gain is possible; b_ is compatible and not zero. On entry
    /// r_ = b_ − A x_, and `relative` is its norm.
    virtual void iterate(linear::StopTest& stop, real relative) = 0;
    virtual std::size_t own_bytes() const { return 0; }

    Options options_;
    System<D> system_;
    Vector x_, b_, r_;
    real b_norm_ = 0;

private:
    real true_residual();
    Index<D> extent_{};
    const Grid<real, D>* zero_ = nullptr;
    Report report_;
};

}  // namespace weir::poisson
