// One line on a terminal that tells how a run goes; nothing where there is no terminal.
#pragma once
#include "core/types.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace weir::app {

class Progress {
public:
    Progress(real start, real end, bool quiet);
    void show(real t, std::int64_t step);
    void end();

private:
    using clock = std::chrono::steady_clock;
    real start_, end_;
    bool visible_;
    clock::time_point begun_ = clock::now(), shown_{};
    std::int64_t steps_ = 0;
};

/// "[######......] 52%  t 0.520 / 1 s  36.2 steps/s  1:04 left  0.31x real time"
std::string progress_line(real start, real t, real end, std::int64_t steps, double seconds);

}  // namespace weir::app
