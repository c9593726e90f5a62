// What a step of smoke costs: the 64x128x64 plume (MacCormack velocity and smoke, pressure to 1e-8), and the cost per cell from 32^3 to
// 128^3. Prints the median and the fastest of the measured steps, pass by pass; --csv for a table; --threads N (default 1). --heat: what
// heat adds to a step of smoke, in processor time, at several Fourier numbers k dt/(rho c h^2).
#include "core/parallel.hpp"
#include "smoke/solver.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <ctime>
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

struct Warmth {
    std::string temperature, substance;
};

std::unique_ptr<Solver> plume(int nx, int ny, int nz, const Warmth& warmth = {}) {
    const auto text = fmt::format(
        "solver = \"mac\"\ndim = 3\ngrid = {{ cells = [{0}, {1}, {2}], size = [1.0, {3}, {4}] }}\ntime = {{ end = 1.0 }}\n"
        "scheme = {{ advection = \"maccormack\", poisson = {{ tolerance = 1e-8 }} }}\n"
        "initial = {{ smoke = {{ name = \"ball\", centre = [0.5, 0.4, 0.5], radius = 0.25 }}{5} }}\n"
        "effects = {{ buoyancy = {{ alpha = -10.0 }} }}\n{6}",
        nx, ny, nz, static_cast<double>(ny) / nx, static_cast<double>(nz) / nx, warmth.temperature, warmth.substance);
    const auto kind = smoke::kind();
    return kind.make(scene::parse(text, "plume", {kind.schema}), {});
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

/// Water with a warmer ball, which may stand above ice.
Warmth warm(const char* conduction, double conductivity, bool ice) {
    return {ice ? ", temperature = { name = \"linear\", value = 300.0, gradient = [0.0, 20.0, 0.0], at = [0.0, 0.5, 0.0] }"
                : ", temperature = { name = \"ball\", centre = [0.5, 0.4, 0.5], radius = 0.25, value = 330.0, outside = 310.0 }",
            fmt::format(
                "fluid.density = 1000.0\nheat = {{ conduction = \"{}\", pressure = 1e5 }}\n"
                "[substance]\nname = \"own\"\ntriple = [300.0, 1000.0]\ncritical = [800.0, 5e6]\nfusion = 3.34e5\nvaporisation = 2.2e6\n"
                "solid = {{ density = 1000.0, heat_capacity = 2000.0, conductivity = {:.6f} }}\n"
                "liquid = {{ density = 1000.0, heat_capacity = 4000.0, conductivity = {:.6f} }}\nvapour = {{ heat_capacity = 2000.0 }}\n",
                conduction, conductivity, conductivity)};
}

/// Processor time of a step, each kind of scene in turn, so that what else the machine does falls on all alike.
void print_heat() {
    constexpr int nx = 32, ny = 64, nz = 32, warm_up = 5, steps = 21;
    constexpr double dt = 0.05, rho_c = 4e6, h = 1.0 / nx;
    struct Kind {
        std::string name;
        std::unique_ptr<Solver> solver;
        std::vector<double> ms;
    };
    std::vector<Kind> kinds;
    const auto add = [&](const std::string& name, const Warmth& warmth) { kinds.push_back({name, plume(nx, ny, nz, warmth), {}}); };
    add("smoke alone", {});
    for (const char* conduction : {"explicit", "stages"}) add(fmt::format("water, {}", conduction), warm(conduction, 0.6, false));
    for (const double fourier : {0.1, 1.0, 10.0})
        for (const bool ice : {false, true})
            add(fmt::format("stages, Fourier {:g}{}", fourier, ice ? ", ice" : ""), warm("stages", fourier * rho_c * h * h / dt, ice));
    for (int i = 0; i < warm_up + steps; ++i)
        for (auto& kind : kinds) {
            const auto start = std::clock();
            kind.solver->step(dt);
            if (i >= warm_up) kind.ms.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
        }
    for (auto& kind : kinds) std::sort(kind.ms.begin(), kind.ms.end());
    const auto& alone = kinds.front().ms;
    for (const auto& kind : kinds) {
        const auto more = [&](std::size_t at) { return 100 * (kind.ms[at] / alone[at] - 1); };
        fmt::print("{:>28}  {:8.2f} ms a step  {:+6.1f}%   fastest {:8.2f}  {:+6.1f}%\n", kind.name, kind.ms[steps / 2], more(steps / 2),
                   kind.ms[0], more(0));
        for (const auto& pass : kind.solver->passes().list())
            if (pass.calls > 0) fmt::print("{:>28}  {:8.2f} ms\n", pass.name, pass.seconds * 1e3 / static_cast<double>(pass.calls));
    }
}

}  // namespace

int main(int argc, char** argv) {
    bool csv = false, heat = false;
    int threads = 1;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--csv")
            csv = true;
        else if (argument == "--heat")
            heat = true;
        else if (argument == "--threads" && i + 1 < argc)
            threads = std::max(1, std::atoi(argv[++i]));
        else
            return fmt::print(argument == "--help" ? stdout : stderr, "usage: bench_flow [--csv] [--heat] [--threads N]\n"),
                   argument == "--help" ? 0 : 2;
    }
    set_threads(threads);
    if (heat) return print_heat(), 0;
    if (csv) fmt::print("case,cells,threads,median_ms,fastest_ms,ns_per_cell,iterations\n");
    print(measure(64, 128, 64), csv, threads);
    double least = infinity, most = 0;
    for (const int n : {32, 64, 128}) {
        const Measured m = measure(n, n, n);
        print(m, csv, threads);
        least = std::min(least, m.median_ms / m.cells);
        most = std::max(most, m.median_ms / m.cells);
    }
    if (!csv) fmt::print("cost per cell, most expensive over cheapest size: {:.2f}\n", most / least);
}
