// Columns moved a second by both models of a height field, whole steps, waves on a square of columns.
//   bench_heightfield [--csv] [--cells N] [--threads N]
#include "core/parallel.hpp"
#include "heightfield/solver.hpp"
#include "parallel/partition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <string>
#include <vector>

using namespace weir;

namespace {

struct Problem {
    std::string name, scene;
};

std::vector<Problem> problems(int cells) {
    const std::string head = fmt::format(
        "solver = \"heightfield\"\ndim = 3\ngrid = {{ cells = [{}, 1, {}], size = [10.0, 2.0, 10.0], origin = [0.0, -1.0, 0.0] }}\n"
        "time = {{ end = 1000.0 }}\neffects = {{ gravity = {{ g = [0.0, -9.81, 0.0] }} }}\n"
        "initial.surface = \"0.1*exp(-((x-5)^2 + (z-5)^2))\"\n",
        cells, cells);
    const std::string flat = "terrain = { kind = \"formula\", height = \"-1\" }\n";
    const std::string islands = "terrain = { kind = \"formula\", height = \"-0.3 + 0.5*sin(2*x)*sin(2*z)\" }\n";
    return {{"shallow_water", head + flat},
            {"shallow_water, islands", head + islands},
            {"columns", head + flat + "scheme.model = \"columns\"\n"},
            {"columns, varied depth", head + "terrain = { kind = \"formula\", height = \"-1 + 0.05*x\" }\nscheme.model = \"columns\"\n"}};
}

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Seconds a step: the median of blocks that take a tenth of a second each.
double seconds_per_step(Solver& solver, const real dt) {
    constexpr int blocks = 9;
    constexpr double long_enough = 0.1;
    for (int i = 0; i < 3; ++i) solver.step(dt);
    const double once = seconds();
    solver.step(dt);
    const int steps = std::max(1, static_cast<int>(long_enough / std::max(1e-9, seconds() - once)));
    std::vector<double> times;
    for (int b = 0; b < blocks; ++b) {
        const double start = seconds();
        for (int i = 0; i < steps; ++i) solver.step(dt);
        times.push_back((seconds() - start) / steps);
    }
    std::nth_element(times.begin(), times.begin() + blocks / 2, times.end());
    return times[blocks / 2];
}

}  // namespace

int main(int argc, char** argv) {
    bool csv = false;
    int cells = 1024, only = 0;
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--csv")) csv = true;
        if (!std::strcmp(argv[i], "--cells") && i + 1 < argc) cells = std::stoi(argv[++i]);
        if (!std::strcmp(argv[i], "--threads") && i + 1 < argc) only = std::stoi(argv[++i]);
    }
    const auto kind = heightfield::kind();
    fmt::print("{}", csv ? "model,cells,threads,ms_a_step,million_columns_a_second,bytes\n" : "");
    for (const Problem& problem : problems(cells))
        for (const int count : only > 0 ? std::vector<int>{only} : std::vector<int>{1, 2}) {
            set_threads(count);
            const auto solver = kind.make(scene::parse(problem.scene, problem.name, {kind.schema}), {});
            const double each = seconds_per_step(*solver, 0.5 * solver->advised_dt());
            const double columns = 1e-6 * cells * static_cast<double>(cells) / each;
            const char* line =
                csv ? "\"{}\",{},{},{:.4f},{:.1f},{}\n" : "{:24} {:5}^2  {} threads {:9.3f} ms a step {:9.1f} M columns/s {:10} bytes\n";
            fmt::print(fmt::runtime(line), problem.name, cells, count, 1e3 * each, columns, solver->bytes());
        }
}
