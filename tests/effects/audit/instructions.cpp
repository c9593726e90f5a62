#include "effects/audit/instructions.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

#include <valgrind/callgrind.h>

namespace weir::test {

namespace {

Instructions counts;
std::vector<std::string> open_passes;
int dumps = 0;

/// Instructions since the last call or zeroing. Callgrind writes each dump into a file with the next number.
long since_last() {
    CALLGRIND_DUMP_STATS;
    const std::string name = std::string(std::getenv("WEIR_CALLGRIND_OUT")) + "." + std::to_string(++dumps);
    long sum = -1;
    {
        std::ifstream file(name);
        for (std::string line; std::getline(file, line);)
            if (line.rfind("totals: ", 0) == 0) sum = std::stol(line.substr(8));
    }
    if (sum < 0) throw std::runtime_error("callgrind left no totals in " + name);
    std::filesystem::remove(name);
    CALLGRIND_ZERO_STATS;
    return sum;
}

void watch(const Pass& pass, bool begins) {
    const long n = since_last();
    counts[open_passes.empty() ? "" : open_passes.back()] += n;
    if (begins)
        open_passes.push_back(pass.name);
    else
        open_passes.pop_back();
    CALLGRIND_ZERO_STATS;
}

}  // namespace

bool counted() { return RUNNING_ON_VALGRIND > 0 && std::getenv("WEIR_CALLGRIND_OUT") != nullptr; }

Instructions instructions_of_step(Solver& solver, real dt) {
    counts.clear();
    pass_watch = watch;
    CALLGRIND_START_INSTRUMENTATION;
    CALLGRIND_ZERO_STATS;
    solver.step(dt);
    counts[""] += since_last();
    CALLGRIND_STOP_INSTRUMENTATION;
    pass_watch = nullptr;
    return counts;
}

long total(const Instructions& of) {
    long sum = 0;
    for (const auto& [pass, n] : of) sum += n;
    return sum;
}

}  // namespace weir::test
