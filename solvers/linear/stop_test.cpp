#include "linear/stop_test.hpp"

#include "core/error.hpp"

#include <cstdio>

namespace weir::linear {

void fail(const char* quantity, const char* solve, const Outcome& outcome, int iterations, real tolerance) {
    char text[240];
    std::snprintf(text, sizeof text, "%s: relative residual %.3g after %d iterations, tolerance %.3g%s", solve, outcome.relative_residual,
                  iterations, tolerance, outcome.broke_down ? "; no descent direction is left: the matrix is not positive definite" : "");
    throw NumericalFailure(quantity, text);
}

void require_converged(const char* quantity, const char* solve, const Outcome& outcome, const StopTest& stop) {
    if (!(outcome.relative_residual <= stop.tolerance())) fail(quantity, solve, outcome, stop.iterations(), stop.tolerance());
}

}  // namespace weir::linear
