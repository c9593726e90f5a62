// A wave over deep water by tall cells, single and stacked, and by the uniform grid with the same cells at the surface: milliseconds per
// step and in each pass of it, bytes, and how far the surfaces of tall cells and uniform grid are apart. Solvers are interleaved step by
// step, so that the machine is the same for all.
//   bench_tallcell [--csv] [--steps N] [--threads N] [--surface N] [--depth N] [--layers N] [--only stacked|single|uniform]
#include "core/parallel.hpp"
#include "tallcell/solver.hpp"
#include "water/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <vector>

using namespace weir;

namespace {

struct Size {
    int surface = 128, depth = 256, layers = 32;
};

struct Entry {
    std::string name;
    std::unique_ptr<Solver> solver;
    std::vector<real> step_ms, processor_ms;
    std::map<std::string, std::vector<real>> pass_ms;
    int iterations = 0;
};

/// A tank 4 m wide, seven eighths full, with a wave of the tank's length and a fortieth of that high.
std::unique_ptr<Solver> build(const scene::SolverKind& kind, const Size& size, const std::string& scheme) {
    const real h = 4.0 / size.surface;
    const std::string text = fmt::format(
        "solver = \"{}\"\ndim = 3\ngrid = {{ cells = [{}, {}, {}], size = [4.0, {}, 4.0] }}\ntime = {{ end = 100.0 }}\n"
        "fluid = {{ density = 1000.0 }}\nliquid = [ {{ shape = \"wave\", level = {}, amplitude = 0.1, wavelength = 4.0 }} ]\n"
        "effects = {{ gravity = {{ g = [0.0, -9.81, 0.0] }} }}\nscheme = {{ {}, poisson = {{ tolerance = 1e-6 }} }}\n",
        kind.schema.name, size.surface, size.depth, size.surface, h * size.depth, 0.875 * h * size.depth, scheme);
    return kind.make(scene::parse(text, "tank", {kind.schema}), {});
}

real seconds() { return std::chrono::duration<real>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Of this process: with one thread, what a step takes of a processor, whatever else the machine is doing.
real processor_seconds() { return static_cast<real>(std::clock()) / CLOCKS_PER_SEC; }

real median(std::vector<real> list) {
    std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2), list.end());
    return list[list.size() / 2];
}

/// The height of the surface over each column, in cells.
std::vector<real> surface(const Solver& solver) {
    const FieldSet fields = solver.fields();
    const auto phi = fields.find(level_set_name)->data[0];
    const auto [nx, ny, nz] = fields.grid.cells;
    std::vector<real> height;
    for (int k = 0; k < nz; ++k)
        for (int i = 0; i < nx; ++i)
            for (int j = ny - 2; j >= 0; --j) {
                const auto at = static_cast<std::size_t>(i + nx * (j + ny * k)), above = at + static_cast<std::size_t>(nx);
                if (phi[at] >= 0) continue;
                height.push_back(j + 0.5 + phi[at] / (phi[at] - phi[above]));
                break;
            }
    return height;
}

real rms(const std::vector<real>& a, const std::vector<real>& b) {
    real sum = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<real>(a.size()));
}

void step(Entry& entry, real dt, bool measured) {
    entry.solver->passes().reset();
    const real start = seconds(), processor = processor_seconds();
    const StepReport report = entry.solver->step(dt);
    if (!measured) return;
    entry.step_ms.push_back(1e3 * (seconds() - start));
    entry.processor_ms.push_back(1e3 * (processor_seconds() - processor));
    entry.iterations += report.iterations;
    for (const auto& pass : entry.solver->passes().list()) entry.pass_ms[pass.name].push_back(1e3 * pass.seconds);
}

void run(const Size& size, int steps, bool csv, const std::string& only) {
    std::vector<Entry> entries;
    const auto add = [&](const std::string& name, const scene::SolverKind& kind, const std::string& scheme) {
        if (name.find(only) != std::string::npos) entries.push_back({name, build(kind, size, scheme), {}, {}, {}, 0});
    };
    add("uniform (mac_water, grid)", water::kind(), "transfer = \"grid\"");
    add("tall, stacked", tallcell::kind(), fmt::format("columns = \"stacked\", layers = {}", size.layers));
    add("tall, single", tallcell::kind(), fmt::format("columns = \"single\", layers = {}", size.layers));
    const real dt = entries[0].solver->advised_dt();
    for (int i = 0; i < steps + 1; ++i)
        for (Entry& entry : entries) step(entry, dt, i > 0);  // the first step takes what lists and solves need
    const std::vector<real> first = surface(*entries[0].solver);
    if (csv) fmt::print("solver,threads,pass,median_ms,least_ms\n");
    for (const Entry& entry : entries) {
        const auto row = [&](const std::string& name, const std::vector<real>& ms) {
            const real least = *std::min_element(ms.begin(), ms.end());
            fmt::print(
                fmt::runtime(csv ? "{},{},{},{:.3f},{:.3f}\n" : "{:<26} {:>2} threads  {:<20} median {:9.2f} ms  least {:9.2f} ms\n"),
                entry.name, threads(), name, median(ms), least);
        };
        for (const auto& [name, ms] : entry.pass_ms) row(name, ms);
        row("step", entry.step_ms);
        row("processor, a step", entry.processor_ms);
        if (csv) continue;
        fmt::print(
            "{:<26} {:.1f} iterations a solve, {:.0f} MiB, {:.2f} times the first one's speed ({:.2f} by the processor's time), surface "
            "{:.4f} cells (rms) from its\n\n",
            entry.name, real(entry.iterations) / steps, static_cast<real>(entry.solver->bytes()) / (1 << 20),
            median(entries[0].step_ms) / median(entry.step_ms), median(entries[0].processor_ms) / median(entry.processor_ms),
            rms(surface(*entry.solver), first));
    }
}

}  // namespace

int main(int argc, char** argv) {
    bool csv = false;
    int steps = 5;
    std::string only;  // all of them
    Size size;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const auto value = [&] { return i + 1 < argc ? std::max(1, std::atoi(argv[++i])) : 1; };
        if (argument == "--csv")
            csv = true;
        else if (argument == "--steps")
            steps = value();
        else if (argument == "--threads")
            set_threads(value());
        else if (argument == "--surface")
            size.surface = value();
        else if (argument == "--depth")
            size.depth = value();
        else if (argument == "--layers")
            size.layers = value();
        else if (argument == "--only" && i + 1 < argc)
            only = argv[++i];
        else
            return fmt::print(argument == "--help" ? stdout : stderr,
                              "usage: bench_tallcell [--csv] [--steps N] [--threads N] [--surface N] [--depth N] [--layers N] "
                              "[--only stacked|single|uniform]\n"),
                   argument == "--help" ? 0 : 2;
    }
    run(size, steps, csv, only);
    return 0;
}
