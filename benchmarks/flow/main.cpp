// What a step of smoke costs: the 64x128x64 plume (MacCormack velocity and smoke, pressure to 1e-8), and the cost per cell from 32^3 to
// 128^3. Prints the median and the fastest of the measured steps, pass by pass; --csv for a table; --threads N (default 1).
#include "core/parallel.hpp"
#include "flow/solver.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

namespace {

using namespace weir;

struct Measured {
    std::string name;
    double cells, median_ms, fastest_ms;
    int iterations;
    std::vector<Pass> passes;
};

std::unique_ptr<Solver> plume(int nx, int ny, int nz) {
    const auto text = fmt::format(
        "solver = \"mac\"\ndim = 3\ngrid = {{ cells = [{0}, {1}, {2}], size = [1.0, {3}, {4}] }}\ntime = {{ end = 1.0 }}\n"
        "scheme = {{ advection = \"maccormack\", poisson = {{ tolerance = 1e-8 }} }}\n"
        "initial = {{ smoke = {{ name = \"ball\", centre = [0.5, 0.4, 0.5], radius = 0.25 }} }}\n"
        "effects = {{ buoyancy = {{ alpha = -10.0 }} }}\n",
        nx, ny, nz, static_cast<double>(ny) / nx, static_cast<double>(nz) / nx);
    const auto kind = flow::kind();
    return kind.make(scene::parse(text, "plume", {kind.schema}));
}

Measured measure(int nx, int ny, int nz) {
    constexpr int warm_up = 5, steps = 11;  // from rest the first steps are long ones; after five the plume rises at CFL 0.5
    const auto solver = plume(nx, ny, nz);
    std::vector<double> ms;
    int iterations = 0;
    for (int i = 0; i < warm_up + steps; ++i) {
        if (i == warm_up) solver->passes().reset();
        const auto start = std::chrono::steady_clock::now();
        iterations = solver->step(std::min(0.05, solver->advised_dt())).iterations;
        const double elapsed = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        if (i >= warm_up) ms.push_back(elapsed);
    }
    std::sort(ms.begin(), ms.end());
    return {fmt::format("{}x{}x{}", nx, ny, nz), 1.0 * nx * ny * nz, ms[ms.size() / 2], ms.front(), iterations, solver->passes().list()};
}

void print(const Measured& m, bool csv, int threads) {
    const double ns = m.median_ms * 1e6 / m.cells;
    if (csv) {
        fmt::print("smoke,{},{},{:.2f},{:.2f},{:.1f},{}\n", m.name, threads, m.median_ms, m.fastest_ms, ns, m.iterations);
        return;
    }
    fmt::print("{:>12}  {:8.1f} ms a step (fastest {:.1f})  {:6.1f} ns a cell  {} pressure iterations\n", m.name, m.median_ms, m.fastest_ms,
               ns, m.iterations);
    for (const auto& pass : m.passes) fmt::print("{:>28}  {:8.2f} ms\n", pass.name, pass.seconds * 1e3 / static_cast<double>(pass.calls));
}

}  // namespace

int main(int argc, char** argv) {
    bool csv = false;
    int threads = 1;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--csv")
            csv = true;
        else if (argument == "--threads" && i + 1 < argc)
            threads = std::max(1, std::atoi(argv[++i]));
        else
            return fmt::print(argument == "--help" ? stdout : stderr, "usage: bench_flow [--csv] [--threads N]\n"),
                   argument == "--help" ? 0 : 2;
    }
    set_threads(threads);
    if (csv) fmt::print("case,cells,threads,median_ms,fastest_ms,ns_per_cell,iterations\n");
    print(measure(64, 128, 64), csv, threads);
    double least = infinity, most = 0;
    for (const int n : {32, 64, 128}) {
        const Measured m = measure(n, n, n);
        print(m, csv, threads);
        least = std::min(least, m.median_ms / m.cells);
        most = std::max(most, m.median_ms / m.cells);
    }
    if (!csv) fmt::print("cost per cell, dearest over cheapest size: {:.2f}\n", most / least);
}
