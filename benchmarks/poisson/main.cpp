// bench_poisson: our pressure methods against hypre's PFMG-CG, PETSc's, CHOLMOD, Eigen's ICCG and FFTW's DCT on the same numbers.
//
//     bench_poisson [--case NAME]... [--dim 2|3] [--n N] [--threads T]... [--solver NAME]... [--repeat K] [--quick] [--obstacles]
//     [--two-phase] [--ratio R] [--csv]
//
// --csv: comma-separated values in place of the table, and after a # what is skipped. Times are the least of K runs, of PETSc,
// CHOLMOD and Eigen of two at most; a peer that would take minutes or more memory than there is says "skipped" and why. Without --solver
// PETSc's methods are asked on one thread, of which they make use. Started by mpirun it shares `multigrid`, or PETSc's methods, between the
// ranks; the others are then left out.
#include "core/error.hpp"
#include "parallel/communicator.hpp"
#include "parallel/load_balance.hpp"
#include "parallel/mpi/ranks.hpp"
#include "pfmg.hpp"
#include "problems.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>

using namespace weir;

namespace {

struct Choice {
    std::vector<std::string> cases, solvers;
    std::vector<int> dims, threads;
    int n = 0, repeat = 5;
    real ratio = 1000;  // of densities
    bool quick = false, obstacles = false, pfmg_process = false;
    bool csv = false;
};

struct Row {
    std::string name, solver;
    int dim = 0, n = 0, threads = 0;
    std::int64_t unknowns = 0;
    double setup_ms = 0, solve_ms = 0, residual = 0, bytes = 0;
    int iterations = 0;
    std::string skipped;
};

constexpr const char* usage =
    "usage: bench_poisson [--case NAME]... [--dim 2|3] [--n N] [--threads T]... [--solver NAME]... [--repeat K] [--quick] [--obstacles] "
    "[--two-phase] [--ratio R] [--csv]";

Choice read_options(int argc, char** argv) {
    Choice c;
    for (int i = 1; i < argc; ++i) {
        const std::string key = argv[i];
        const auto value = [&]() -> std::string {
            if (i + 1 == argc) throw BadInput(key + " needs a value");
            return argv[++i];
        };
        if (key == "--help") {
            std::puts(usage);
            std::exit(0);
        } else if (key == "--case")
            c.cases.push_back(value());
        else if (key == "--solver")
            c.solvers.push_back(value());
        else if (key == "--dim")
            c.dims.push_back(std::stoi(value()));
        else if (key == "--threads")
            c.threads.push_back(std::stoi(value()));
        else if (key == "--n")
            c.n = std::stoi(value());
        else if (key == "--repeat")
            c.repeat = std::stoi(value());
        else if (key == "--ratio")
            c.ratio = std::stod(value());
        else if (key == "--csv")
            c.csv = true;
        else if (key == "--quick")
            c.quick = true;
        else if (key == "--obstacles")
            c.obstacles = true;
        else if (key == "--two-phase")
            c.cases = {
                "uniform",           "wave",      "bubble",       "drop", "dam", "drops", "bubbles", "film", "gas_film", "inclined_film",
                "gas_inclined_film", "ring_film", "gas_ring_film"};
        else if (key == "--pfmg-process")
            c.pfmg_process = true;
        else
            throw BadInput("unknown option " + key + "\n" + usage);
    }
    if (c.cases.empty()) c.cases = {"box", "wavy", "box_weights", "wavy_weights"};
    if (c.obstacles) c.cases = {"rooms", "slits", "blocks", "fractions", "magnitudes", "bands"};
    if (c.dims.empty()) c.dims = {2, 3};
    if (c.threads.empty()) c.threads = {1, 2};
    return c;
}

bool is_obstacle(const std::string& name) { return name.find("box") == std::string::npos && name.find("wavy") == std::string::npos; }

/// Why a solver is not run on a problem, or nothing.
std::optional<std::string> reason_to_skip(const std::string& solver, const std::string& name, int dim, std::int64_t unknowns, bool quick) {
    const bool slow = solver == "cholmod" || solver == "eigen_iccg" || solver == "petsc_icc";
    if (solver == "dct" && name != "box") return "whole boxes only";
    if (quick && slow && unknowns > 100000) return "takes seconds (--quick)";
    if (solver == "cholmod" && dim == 3 && unknowns > 300000) return "its factor would take more than 8 GB and minutes";
    return std::nullopt;
}

/// What a sweep over each plane costs: blocks of a row's cells that hold fluid, as the kernels take them.
template <int D>
std::vector<std::int64_t> blocks_in_planes(const Grid<poisson::Cell, D>& cells) {
    constexpr std::size_t block = 32;  // 16 of either colour
    const auto row = static_cast<std::size_t>(cells.extent()[0]), plane = static_cast<std::size_t>(cells.stride(D - 1));
    std::vector<std::int64_t> list(cells.size() / plane);
    for (std::size_t begin = 0; begin < cells.size(); begin += row)
        for (std::size_t i = begin; i < begin + row; i += block)
            list[begin / plane] +=
                std::any_of(&cells[i], &cells[begin] + std::min(row, i - begin + block), [](auto c) { return c == poisson::Cell::fluid; });
    return list;
}

/// The same problem with planes that the ranks of a partition share; every rank stores all of it.
template <class T, int D>
Grid<T, D> shared(const Grid<T, D>& q, const OwnPlanes& own) {
    Grid<T, D> copy;
    if (q.empty()) return copy;
    copy = Grid<T, D>(Extent<D>(q.extent(), own));
    std::copy(q.values().begin(), q.values().end(), copy.data());
    return copy;
}
template <int D>
bench::Problem<D> shared(const bench::Problem<D>& problem, const OwnPlanes& own) {
    bench::Problem<D> copy = problem;
    copy.A.cells = shared(problem.A.cells, own), copy.b = shared(problem.b, own);
    for (auto& weight : copy.A.weight) weight = shared(weight, own);
    return copy;
}

template <int D>
Row measure(const std::string& solver, const std::string& name, const bench::Problem<D>& problem, int threads, const Choice& choice,
            Grid<real, D>& p) {
    Row row;
    row.name = name, row.solver = solver, row.dim = D, row.n = problem.b.extent()[0], row.threads = threads,
    row.unknowns = problem.unknowns;
    if (const auto reason = reason_to_skip(solver, name, D, problem.unknowns, choice.quick)) {
        row.skipped = *reason;
        return row;
    }
    if (solver == "pfmg_cg") {
        char self[4096] = {};
        std::ifstream("/proc/self/cmdline").getline(self, sizeof self, '\0');
        const auto result = bench::run_pfmg(self, name, D, row.n, threads, choice.repeat, choice.ratio);
        row.skipped = result.failure;
        row.setup_ms = result.setup_ms, row.solve_ms = result.solve_ms, row.residual = result.residual;
        row.iterations = result.iterations, row.bytes = result.bytes;
        if (row.skipped.empty() && !(row.residual <= 1e-7)) row.skipped = "did not converge", row.solve_ms = 0;
        return row;
    }
    set_threads(threads);
    const Partition cut = load_balanced_partition(blocks_in_planes(problem.A.cells), communicator().ranks());
    const OwnPlanes own(slab_of(cut));
    const bench::Problem<D> of_ranks = own.distributed() ? shared(problem, own) : bench::Problem<D>{};
    Grid<real, D> parts = own.distributed() ? shared(p, own) : Grid<real, D>{};
    const bool slow = solver == "cholmod" || solver == "eigen_iccg" || solver == "cg_mic0" || solver.starts_with("petsc");
    const auto method = poisson::make_solver<D>(solver, {.tolerance = 1e-8, .max_iterations = 5000});
    row.setup_ms = row.solve_ms = infinity;
    bool shares = false;
    const auto set_up = [&] {
        if (own.distributed()) method->setup(of_ranks.A), shares = method->shares_planes();
        if (!shares) method->setup(problem.A);
    };
    for (int k = 0; k < (slow ? std::min(2, choice.repeat) : choice.repeat); ++k) {
        if (!(slow && k > 0)) set_up();
        p.fill(0), parts.fill(0);
        communicator().largest(0);  // barrier
        try {
            const auto& report = shares ? method->solve(parts, of_ranks.b) : method->solve(p, problem.b);
            if (shares) gather(parts), std::copy(parts.values().begin(), parts.values().end(), p.data());
            row.setup_ms = std::min(row.setup_ms, 1e3 * report.setup_seconds);
            row.solve_ms = std::min(row.solve_ms, 1e3 * report.solve_seconds);
            row.iterations = report.iterations;
        } catch (const NumericalFailure& failure) {
            row.skipped = std::string("failed: ") + failure.what();
            return row;
        }
    }
    row.bytes = static_cast<double>(method->bytes());
    row.residual = bench::true_residual(problem, p);
    return row;
}

void print_head() {
    std::printf("%-13s %3s %5s %2s %-15s %10s %10s %5s %9s %9s %8s %8s\n", "case", "dim", "n", "t", "solver", "setup ms", "solve ms",
                "iter", "residual", "ns/unk", "B/unk", "/PFMG");
}

void print_csv(const Row& r) {
    const auto unknowns = static_cast<double>(r.unknowns);
    if (!r.skipped.empty())
        std::printf("# %s,%d,%d,%d,%s,%s\n", r.name.c_str(), r.dim, r.n, r.threads, r.solver.c_str(), r.skipped.c_str());
    else
        std::printf("%s,%d,%d,%d,%s,%g,%g,%d,%g,%g,%g\n", r.name.c_str(), r.dim, r.n, r.threads, r.solver.c_str(), r.setup_ms, r.solve_ms,
                    r.iterations, r.residual, 1e6 * r.solve_ms / unknowns, r.bytes / unknowns);
    std::fflush(stdout);
}

void print(const Row& r, double pfmg_ms) {
    std::printf("%-13s %3d %5d %2d %-15s ", r.name.c_str(), r.dim, r.n, r.threads, r.solver.c_str());
    if (!r.skipped.empty()) {
        std::printf("skipped: %s\n", r.skipped.c_str());
    } else {
        const auto unknowns = static_cast<double>(r.unknowns);
        std::printf("%10.2f %10.2f %5d %9.1e %9.1f %8.1f ", r.setup_ms, r.solve_ms, r.iterations, r.residual, 1e6 * r.solve_ms / unknowns,
                    r.bytes / unknowns);
        pfmg_ms > 0 ? std::printf("%8.3f\n", r.solve_ms / pfmg_ms) : std::printf("%8s\n", "-");
    }
    std::fflush(stdout);
}

/// PFMG-CG first, so that every other line can be compared with it; CHOLMOD's answer, where there is one, against the others'.
template <int D>
void run_case(const std::string& name, int n, int threads, const Choice& choice) {
    std::vector<std::string> solvers = choice.solvers;
    if (communicator().several()) {
        const auto shared = [](const std::string& solver) { return solver == "multigrid" || solver.starts_with("petsc"); };
        if (!std::all_of(solvers.begin(), solvers.end(), shared)) throw BadInput("in parallel: multigrid and PETSc's methods alone");
        if (solvers.empty()) solvers = {"multigrid"};
    }
    if (solvers.empty()) {
        solvers = {"pfmg_cg", "multigrid", "cholmod"};
        if (is_obstacle(name)) solvers.push_back("cg_mic0");
        if (name == "box" || name == "wavy") solvers.insert(solvers.end(), {"eigen_iccg", "dct"});
        if (poisson::has_petsc() && threads == 1) solvers.insert(solvers.end(), {"petsc_gamg", "petsc_boomeramg", "petsc_icc"});
    }
    const auto problem = bench::make<D>(name, n, choice.ratio);
    double pfmg_ms = 0;
    std::map<std::string, Grid<real, D>> answers;
    std::map<std::string, double> milliseconds;
    for (const auto& solver : solvers) {
        Grid<real, D> p(problem.b.extent());
        const Row row = measure<D>(solver, name, problem, threads, choice, p);
        if (solver == "pfmg_cg") pfmg_ms = row.solve_ms;
        choice.csv ? print_csv(row) : print(row, pfmg_ms);
        if (row.skipped.empty()) milliseconds[solver] = row.solve_ms;
        if (row.skipped.empty() && solver != "pfmg_cg") answers.emplace(solver, std::move(p));
    }
    if (!choice.csv && milliseconds.contains("multigrid"))
        for (const auto& [solver, ms] : milliseconds)
            if (solver.starts_with("petsc"))
                std::printf("    %s takes %.1f times multigrid's time\n", solver.c_str(), ms / milliseconds.at("multigrid"));
    if (choice.csv || !answers.contains("cholmod")) return;
    const auto& exact = answers.at("cholmod");
    const real scale = max_over<D>(exact.extent(), [&](const Index<D>& I) { return std::abs(exact(I)); });
    for (const auto& [solver, p] : answers)
        if (solver != "cholmod")
            std::printf("    %s: largest difference from CHOLMOD's answer %.1e of the largest pressure\n", solver.c_str(),
                        max_over<D>(p.extent(), [&, &q = p](const Index<D>& I) { return std::abs(q(I) - exact(I)); }) / scale);
}

int run(const Choice& choice) {
    if (choice.csv)
        std::puts("case,dim,n,threads,solver,setup_ms,solve_ms,iterations,true_residual,ns_per_unknown,bytes_per_unknown");
    else
        print_head();
    for (const auto& name : choice.cases)
        for (const int dim : choice.dims)
            for (const int t : choice.threads) {
                const bool obstacle = is_obstacle(name);
                const int full = dim == 2 ? (obstacle ? 512 : 1024) : (obstacle ? 96 : 128);
                const int n = choice.n > 0 ? choice.n : choice.quick ? full / 2 : full;
                dim == 2 ? run_case<2>(name, n, t, choice) : run_case<3>(name, n, t, choice);
            }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const Choice choice = read_options(argc, argv);
        if (choice.pfmg_process) return bench::pfmg_process(choice.cases[0], choice.dims[0], choice.n, choice.repeat, choice.ratio);
        distributed::join();
        return distributed::leave(run(choice), "");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_poisson: %s\n", error.what());
        return distributed::leave(exit_bad_input, error.what());
    }
}
