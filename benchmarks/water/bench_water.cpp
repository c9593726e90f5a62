// Milliseconds per step, and in each of its passes, of whole simulations of water, alone and in air: dam breaks, each after a start-up that
// is not measured.
//   bench_water [--csv] [--steps N] [--threads N] [--dim 2|3] [--only NAME]
#include "core/parallel.hpp"
#include "two_phase/solver.hpp"
#include "water/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <string>
#include <vector>

using namespace weir;

namespace {

struct Problem {
    std::string name;
    int dim, threads;
    real start;  // [s], when the front runs: surface and splash are what costs
    std::string scene;
};

const std::string wide =
    "dim = 2\ngrid = { cells = [512, 256], size = [4.0, 2.0] }\ntime = { end = 10.0 }\n"
    "fluid = { density = 1000.0 }\nliquid = [ { shape = \"box\", min = [0.0, 0.0], max = [1.0, 1.5] } ]\n"
    "effects = { gravity = { g = [0.0, -9.81] } }\n";
const std::string column =
    "dim = 2\ngrid = { cells = [216, 45], size = [0.6858, 0.142875] }\ntime = { end = 10.0 }\n"
    "fluid = { density = 1000.0 }\nliquid = [ { shape = \"box\", min = [0.0, 0.0], max = [0.05715, 0.1143] } ]\n"
    "effects = { gravity = { g = [0.0, -9.81] } }\n";
const std::string block =
    "dim = 3\ngrid = { cells = [96, 64, 48], size = [1.5, 1.0, 0.75] }\ntime = { end = 10.0 }\n"
    "fluid = { density = 1000.0 }\nliquid = [ { shape = \"box\", min = [0.0, 0.0, 0.0], max = [0.4375, 0.296875, 0.75] } ]\n"
    "effects = { gravity = { g = [0.0, -9.81, 0.0] } }\n";

std::string water(const std::string& scene, const std::string& tolerance) {
    return "solver = \"mac_water\"\n" + scene + "scheme = { transfer = \"flip\", poisson = { tolerance = " + tolerance + " } }\n";
}
std::string with_air(const std::string& scene, const std::string& tolerance) {
    return "solver = \"two_phase\"\n" + scene + "gas = { density = 1.0 }\nscheme = { poisson = { tolerance = " + tolerance + " } }\n";
}

/// 96 × 64 × 48 cells with 200,000 FLIP markers on one thread, and 512 × 256 cells on two; the first, and the column of Martin & Moyce,
/// also with air above.
std::vector<Problem> problems() {
    return {{"dam_break_3d_96x64x48", 3, 1, 0.25, water(block, "1e-8")},
            {"dam_break_2d_512x256", 2, 2, 0.25, water(wide, "1e-8")},
            {"dam_break_2d_216x45", 2, 1, 0.1, water(column, "1e-6")},
            {"dam_break_3d_96x64x48_air", 3, 1, 0.25, with_air(block, "1e-6")},
            {"dam_break_2d_216x45_air", 2, 1, 0.1, with_air(column, "1e-6")}};
}

real seconds() { return std::chrono::duration<real>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

real median(std::vector<real> list) {
    std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2), list.end());
    return list[list.size() / 2];
}

void measure(const Problem& problem, int threads, int steps, bool csv) {
    const auto kind = problem.scene.find("two_phase") == std::string::npos ? water::kind() : two_phase::kind();
    const std::vector<scene::SolverSchema> schemas{kind.schema};
    const auto solver = kind.make(scene::parse(problem.scene, problem.name, schemas), {});
    set_threads(threads);
    while (solver->time() < problem.start) solver->step(solver->advised_dt());
    std::vector<real> step_ms;
    std::map<std::string, std::vector<real>> pass_ms;
    int iterations = 0;
    for (int i = 0; i < steps; ++i) {
        solver->passes().reset();
        const real start = seconds();
        iterations += solver->step(solver->advised_dt()).iterations;
        step_ms.push_back(1e3 * (seconds() - start));
        for (const auto& pass : solver->passes().list()) pass_ms[pass.name].push_back(1e3 * pass.seconds);
    }
    real markers = 0;
    for (const auto& value : solver->integrals())
        if (value.name == "markers") markers = value.value;
    const auto row = [&](const std::string& name, const std::vector<real>& ms) {
        const real least = *std::min_element(ms.begin(), ms.end());
        const auto count = static_cast<long>(markers);
        if (csv)
            fmt::print("{},{},{},{},{:.3f},{:.3f}\n", problem.name, threads, count, name, median(ms), least);
        else
            fmt::print("{:<24} {:>2} threads {:>7} markers  {:<20} median {:8.3f} ms  least {:8.3f} ms\n", problem.name, threads, count,
                       name, median(ms), least);
    };
    for (const auto& pass : solver->passes().list()) row(pass.name, pass_ms[pass.name]);
    row("step", step_ms);
    if (!csv)
        fmt::print("{:<24} {:.1f} iterations a solve, {:.1f} steps a second, {:.1f} MiB\n\n", problem.name, real(iterations) / steps,
                   1e3 / median(step_ms), static_cast<real>(solver->bytes()) / (1 << 20));
}

}  // namespace

int main(int argc, char** argv) {
    bool csv = false;
    std::string only;
    int steps = 20, threads = 0, dim = 0;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--csv")
            csv = true;
        else if (argument == "--steps" && i + 1 < argc)
            steps = std::max(1, std::atoi(argv[++i]));
        else if (argument == "--threads" && i + 1 < argc)
            threads = std::max(1, std::atoi(argv[++i]));
        else if (argument == "--dim" && i + 1 < argc)
            dim = std::atoi(argv[++i]);
        else if (argument == "--only" && i + 1 < argc)
            only = argv[++i];
        else
            return fmt::print(argument == "--help" ? stdout : stderr,
                              "usage: bench_water [--csv] [--steps N] [--threads N] [--dim 2|3] [--only NAME]\n"),
                   argument == "--help" ? 0 : 2;
    }
    if (csv) fmt::print("case,threads,markers,pass,median_ms,least_ms\n");
    for (const auto& problem : problems())
        if ((dim == 0 || dim == problem.dim) && (only.empty() || only == problem.name))
            measure(problem, threads > 0 ? threads : problem.threads, steps, csv);
    return 0;
}
