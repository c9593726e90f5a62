// The two ways in which a run ends early. Bad input (exit code 2) is detected before anything is written. A numerical failure (exit code 3)
// stops the run; it reports the step and the quantity, and the last good state is saved.
#pragma once
#include "core/types.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>

namespace weir {

/// exit_internal_error: EX_SOFTWARE of sysexits.h.
enum ExitCode : int { exit_success = 0, exit_claim_failed = 1, exit_bad_input = 2, exit_numerical_failure = 3, exit_internal_error = 70 };

/// The input is invalid: exit code 2. The text states what was found and what is allowed.
struct BadInput : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A quantity became NaN, a solve missed its tolerance, a run diverged: exit code 3. Solvers throw it from step() and
/// name the quantity; the time loop adds step and time.
struct NumericalFailure : std::runtime_error {
    NumericalFailure(std::string quantity_, const std::string& what) : std::runtime_error(what), quantity(std::move(quantity_)) {}
    std::string quantity;
    std::int64_t step = -1;
    real time = 0;
};

/// Writing failed (disk full, folder gone): exit code 2. Frames already complete stay readable.
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace weir
