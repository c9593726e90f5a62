// The particle solvers' cost: milliseconds of a step of cases/dam_break_particles from its state at t = 0.25 s, median of 20 steps,
// against particles, iterations, threads and instruction set.
#include "core/parallel.hpp"
#include "particles/threads/isa.hpp"
#include "pbf/solver.hpp"
#include "scene/scene.hpp"
#include "sph/solver.hpp"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>

namespace {

using namespace weir;

struct Job {
    std::string solver, isa, kernel;
    int cells = 32, iterations = 4, threads = 2, steps = 20;
    double start = 0.25;  // [s]
    std::vector<std::string> set;
};

struct Result {
    int particles = 0;
    double ms = 0, fastest = 0, cpu = 0, mean = 0, worst = 0, outside = 0, height = 0, iterations = 0;
    std::vector<Pass> passes;
    double neighbours = 0;
};

scene::Scene scene_of(const Job& job) {
    const int n = job.cells;
    const auto kinds = {pbf::kind(), sph::kind()};
    const auto schemas = scene::schemas_of(kinds);
    std::vector<scene::Override> set{{"solver", "\"" + job.solver + "\""},
                                     {"grid.cells", fmt::format("[{}, {}, {}]", 3 * n, 2 * n, n + 1)},
                                     {"grid.size", fmt::format("[3.0, 2.0, {:.17g}]", 1 + 1.0 / n)},
                                     {"time.dt", fmt::format("{:.17g}", 0.064 / n)}};
    if (job.solver == "pbf") {
        set.push_back({"scheme.iterations", std::to_string(job.iterations)});
    } else {
        set.push_back(
            {"scheme",
             fmt::format("{{ kernel = \"muller\", support = 2.0, density = \"summation\", sound_speed = 12.0, backend = \"threads:{}\" }}",
                         job.isa)});
        set.push_back({"effects", "{ gravity = { g = [0, -9.81, 0] }, artificial_viscosity = { alpha = 0.1 } }"});
    }
    if (job.solver == "pbf")
        set.push_back({"scheme.backend", "\"threads:" + job.isa + "\""}), set.push_back({"scheme.kernel", "\"" + job.kernel + "\""});
    for (const auto& entry : job.set) set.push_back({entry.substr(0, entry.find('=')), entry.substr(entry.find('=') + 1)});
    return scene::read(WEIR_SOURCE_DIR "/cases/dam_break_particles", schemas, set);
}

double integral(const Solver& solver, const std::string& name) {
    for (const auto& i : solver.integrals())
        if (i.name == name) return i.value;
    return not_applicable;
}

Result run(const Job& job) {
    set_threads(job.threads);
    const scene::Scene scene = scene_of(job);
    const std::unique_ptr<Solver> solver = job.solver == "pbf" ? pbf::kind().make(scene, {}) : sph::kind().make(scene, {});
    const double dt = scene.number("time.dt");
    while (solver->time() < job.start - 0.5 * dt) solver->step(dt);
    solver->passes().reset();
    std::vector<double> ms;
    const std::clock_t cpu = std::clock();
    StepReport report;
    for (int s = 0; s < job.steps; ++s) {
        const auto start = std::chrono::steady_clock::now();
        report = solver->step(dt);
        ms.push_back(1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    const double cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC / job.steps;
    std::sort(ms.begin(), ms.end());
    return {static_cast<int>(integral(*solver, "particles")),
            ms[ms.size() / 2],
            ms.front(),
            cpu_ms,
            report.density_error,
            report.max_density_error,
            integral(*solver, "outside"),
            integral(*solver, "mean_height"),
            static_cast<double>(report.iterations),
            solver->passes().list(),
            integral(*solver, "mean_neighbours")};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Milliseconds per step of the particle solvers"};
    std::vector<std::string> solvers{"pbf", "sph"}, isas{"auto"};
    std::vector<int> cells{32, 50}, iterations{4, 8}, threads{2, 1};
    bool csv = false, passes = false;
    int steps = 20;
    double start = 0.25;
    std::string kernel = "cubic";
    std::vector<std::string> overrides;
    app.add_option("--set", overrides, "KEY=VALUE, as in a scene");
    app.add_option("--kernel", kernel, "muller, cubic, wendland");
    app.add_option("--solver", solvers, "pbf, sph");
    app.add_option("--isa", isas, "auto, sse2, avx2, avx512");
    app.add_option("--n", cells, "particles along the side of the block");
    app.add_option("--iterations", iterations, "of PBF");
    app.add_option("--threads", threads, "number of threads");
    app.add_option("--steps", steps, "steps that are measured");
    app.add_option("--start", start, "time at which measuring begins [s]");
    app.add_flag("--csv", csv, "comma-separated values");
    app.add_flag("--passes", passes, "milliseconds of each pass");
    CLI11_PARSE(app, argc, argv);

    if (csv)
        fmt::print(
            "solver,backend,isa,dim,particles,iterations,threads,ms_per_step,mean_compression,max_compression,outside,mean_height\n");
    for (const auto& solver : solvers)
        for (const auto& isa : isas)
            for (const int n : cells)
                for (const int it : solver == "pbf" ? iterations : std::vector<int>{1})
                    for (const int t : threads) {
                        const Result r = run({solver, isa, kernel, n, it, t, steps, start, overrides});
                        const char* name = particles::passes_for(isa).name;
                        if (csv)
                            fmt::print("{},threads,{},3,{},{},{},{:.3f},{:.3e},{:.3e},{:.0f},{:.5f}\n", solver, name, r.particles,
                                       r.iterations, t, r.ms, r.mean, r.worst, r.outside, r.height);
                        else
                            fmt::print(
                                "{:4} {:6} {:8} particles {:2} iterations {} threads: {:8.3f} ms (fastest {:.3f}, processor time {:.3f}), "
                                "compression mean {:.4f} % max {:.2f} %, "
                                "outside {}, mean height {:.4f} m, {:.1f} neighbours\n",
                                solver, name, r.particles, r.iterations, t, r.ms, r.fastest, r.cpu, 100 * r.mean, 100 * r.worst, r.outside,
                                r.height, r.neighbours);
                        if (passes)
                            for (const auto& p : r.passes) fmt::print("    {:12} {:8.3f} ms\n", p.name, 1e3 * p.seconds / steps);
                        std::fflush(stdout);
                    }
}
