// What the passes over pairs cost over a neighbour list and over cells, for sizes of work groups: lines of the table, rows of the CSV.
#pragma once
#include "benchmarks/gpu_particles/pair_passes.hpp"
#include "particles/opencl/device_fluid.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace weir::bench {

struct Csv {
    std::FILE* file;
    int dim, iterations;
    double particles;
    /// group: work items of a group, 0: as the solver has it.
    void row(const std::string& kernel, double calls, double ms, double bytes = 0, double fraction = 0, std::size_t group = 0) const {
        std::fprintf(file, "%d,%.0f,%d,%s,%.3f,%.5f,%.4g,%.4f,%zu\n", dim, particles, iterations, kernel.c_str(), calls, ms, bytes,
                     fraction, group);
    }
};

/// The passes over pairs with one size of work groups. Throws std::logic_error where list and cells disagree.
template <int D>
PairTimes measure_pairs(PairPasses<D>& pairs, const Csv& csv, std::size_t group) {
    const int it = csv.iterations;
    const auto t = pairs.measure(it, group);
    const auto first = pairs.difference(1, group), last = pairs.difference(it, group);
    // The same terms in the same order: only a device that rounds one text in two ways may differ, by no more than backends do (1e-5).
    if (!(first.apart <= 1e-5)) throw std::logic_error("list and cells disagree by " + std::to_string(first.apart) + " h in one iteration");
    if (!(first.moved > 0)) throw std::logic_error("no particle was moved: nothing was compared");
    std::printf(
        "   groups of %3zu: list %9.3f ms (built %.3f, lambda %.3f, correct %.3f), %d cells %9.3f ms (lambda %.3f, correct %.3f), "
        "%.2f times the list; apart %.1e h of %.1e h moved in one iteration, %.1e of %.1e in %d\n",
        group, t.by_list(it), t.build, t.lambda, t.correct, D == 2 ? 9 : 27, t.by_cells(it), t.lambda_cells, t.correct_cells,
        t.by_cells(it) / t.by_list(it), first.apart, first.moved, last.apart, last.moved, it);
    std::fflush(stdout);
    const struct {
        const char* name;
        double calls, ms;
    } rows[] = {{"list_build", 1, t.build},
                {"list_lambda", 1.0 * it, t.lambda},
                {"list_correct", 1.0 * it, t.correct},
                {"cells_lambda", 1.0 * it, t.lambda_cells},
                {"cells_correct", 1.0 * it, t.correct_cells},
                {"list_total", 1, t.by_list(it)},
                {"cells_total", 1, t.by_cells(it)}};
    for (const auto& row : rows) csv.row(row.name, row.calls, row.calls * row.ms, 0, 0, group);
    return t;
}

/// List against cells, with the solver's work groups and with those asked for. Returns about the seconds that it took.
template <int D>
double compare_pairs(std::vector<std::size_t> groups, const pbf::Options& options, const particles::Fluid<D>& fluid, real dt,
                     const Csv& csv) {
    PairPasses<D> pairs(options, fluid, dt);
    if (groups.empty()) groups = {std::min(particles::device_group, pairs.group_limit())};
    double list = infinity, cells = infinity, seconds = 0;
    std::size_t best_list = 0, best_cells = 0;
    for (const std::size_t group : groups) try {
            if (group < 1 || group > pairs.group_limit())
                throw std::runtime_error("the device takes 1 to " + std::to_string(pairs.group_limit()));
            const auto t = measure_pairs(pairs, csv, group);
            seconds += 5e-3 * (t.by_list(csv.iterations) + t.by_cells(csv.iterations));  // three runs, two comparisons
            if (t.by_list(csv.iterations) < list) list = t.by_list(csv.iterations), best_list = group;
            if (t.by_cells(csv.iterations) < cells) cells = t.by_cells(csv.iterations), best_cells = group;
        } catch (const std::runtime_error& refused) {
            std::printf("   groups of %3zu: %s\n", group, refused.what());
        }
    if (groups.size() > 1) std::printf("   best groups: list %zu (%.3f ms), cells %zu (%.3f ms)\n", best_list, list, best_cells, cells);
    return seconds;
}

}  // namespace weir::bench
