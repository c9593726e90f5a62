// The balance of a run as `weir run` prints it at its end, and as run.json has it.
#pragma once
#include "sim/balance.hpp"

#include <string>

namespace weir::app {

/// Where a run's time went [s].
struct TimeSpent {
    double stepping = 0, writing = 0;
};

/// At most twelve lines, aligned.
std::string balance_text(const sim::BalanceOfRun& run, const TimeSpent& spent);

/// One JSON object.
std::string balance_json(const sim::BalanceOfRun& run, const TimeSpent& spent);

}  // namespace weir::app
