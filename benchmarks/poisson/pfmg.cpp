#include "pfmg.hpp"

#include "core/programs.hpp"
#include "poisson/faces.hpp"
#include "problems.hpp"

#include <HYPRE_krylov.h>
#include <HYPRE_struct_ls.h>
#include <malloc.h>
#include <mpi.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace weir::bench {

namespace {

double now_ms() { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double heap_bytes() {
    const auto info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
}

/// This rank's planes of the problem as hypre's structured matrix and vectors. Cells that are not fluid get the equation p = 0.
template <int D>
struct Struct {
    HYPRE_StructGrid grid;
    HYPRE_StructStencil stencil;
    HYPRE_StructMatrix A;
    HYPRE_StructVector b, x;
    Index<D> low{}, high{};
    std::vector<double> zeros;

    Struct(const Problem<D>& problem, int rank, int ranks) {
        const auto n = problem.b.extent();
        for (int a = 0; a < D; ++a) high[a] = n[a] - 1;
        low[D - 1] = n[D - 1] * rank / ranks;
        high[D - 1] = n[D - 1] * (rank + 1) / ranks - 1;
        HYPRE_StructGridCreate(MPI_COMM_WORLD, D, &grid);
        HYPRE_StructGridSetExtents(grid, low.data(), high.data());
        HYPRE_StructGridAssemble(grid);
        HYPRE_StructStencilCreate(D, 2 * D + 1, &stencil);
        for (int k = 0; k <= 2 * D; ++k) {
            Index<D> offset{};
            if (k > 0) offset[(k - 1) / 2] = k % 2 == 1 ? -1 : 1;
            HYPRE_StructStencilSetElement(stencil, k, offset.data());
        }
        fill(problem);
    }

    void fill(const Problem<D>& problem) {
        HYPRE_StructMatrixCreate(MPI_COMM_WORLD, grid, stencil, &A);
        HYPRE_StructMatrixInitialize(A);
        std::vector<double> values, rhs;
        Index<D> end = high;
        for (int a = 0; a < D; ++a) ++end[a];
        Index<D> I = low;
        for (bool more = true; more;) {
            append_row(problem, I, values);
            rhs.push_back(problem.b(I));
            more = false;
            for (int a = 0; a < D; ++a) {
                if (++I[a] < end[a]) {
                    more = true;
                    break;
                }
                I[a] = low[a];
            }
        }
        std::array<int, 2 * D + 1> entries;
        for (int k = 0; k <= 2 * D; ++k) entries[static_cast<std::size_t>(k)] = k;
        HYPRE_StructMatrixSetBoxValues(A, low.data(), high.data(), 2 * D + 1, entries.data(), values.data());
        HYPRE_StructMatrixAssemble(A);
        for (HYPRE_StructVector* v : {&b, &x}) {
            HYPRE_StructVectorCreate(MPI_COMM_WORLD, grid, v);
            HYPRE_StructVectorInitialize(*v);
        }
        zeros.assign(rhs.size(), 0);
        HYPRE_StructVectorSetBoxValues(b, low.data(), high.data(), rhs.data());
        HYPRE_StructVectorAssemble(b);
        clear();
    }

    static void append_row(const Problem<D>& problem, const Index<D>& I, std::vector<double>& values) {
        std::array<double, 2 * D + 1> row{};
        const bool fluid = problem.A.cells(I) == poisson::Cell::fluid;
        row[0] = fluid ? 0 : 1;
        for (int a = 0; fluid && a < D; ++a)
            for (int side = 0; side < 2; ++side) {
                const real w = poisson::face_weight(problem.A, I, a, side);
                const auto next = poisson::neighbour(problem.A, I, a, side);
                row[0] += w;
                if (!next.outside && problem.A.cells(next.cell) == poisson::Cell::fluid)
                    row[static_cast<std::size_t>(1 + 2 * a + side)] = -w;
            }
        if (row[0] == 0) row[0] = 1;  // an isolated cell
        values.insert(values.end(), row.begin(), row.end());
    }

    void clear() {
        HYPRE_StructVectorSetBoxValues(x, low.data(), high.data(), zeros.data());
        HYPRE_StructVectorAssemble(x);
    }
};

template <int D>
int measure(const std::string& name, int n, int repeat, double ratio, int rank, int ranks) {
    const Problem<D> problem = make<D>(name, n, ratio);
    Struct<D> system(problem, rank, ranks);
    const double before = heap_bytes(), start = now_ms();
    HYPRE_StructSolver pcg, pfmg;
    HYPRE_StructPCGCreate(MPI_COMM_WORLD, &pcg);
    HYPRE_StructPCGSetTol(pcg, 1e-8);
    HYPRE_StructPCGSetMaxIter(pcg, 500);
    HYPRE_StructPCGSetTwoNorm(pcg, 1);
    HYPRE_StructPFMGCreate(MPI_COMM_WORLD, &pfmg);
    HYPRE_StructPFMGSetMaxIter(pfmg, 1);
    HYPRE_StructPFMGSetTol(pfmg, 0);
    HYPRE_StructPFMGSetZeroGuess(pfmg);
    HYPRE_StructPFMGSetRAPType(pfmg, 1);
    HYPRE_StructPFMGSetRelaxType(pfmg, 2);  // red-black Gauss-Seidel, symmetric
    HYPRE_StructPFMGSetNumPreRelax(pfmg, 1);
    HYPRE_StructPFMGSetNumPostRelax(pfmg, 1);
    HYPRE_StructPFMGSetSkipRelax(pfmg, 1);
    HYPRE_StructPCGSetPrecond(pcg, HYPRE_StructPFMGSolve, HYPRE_StructPFMGSetup, pfmg);
    HYPRE_StructPCGSetup(pcg, system.A, system.b, system.x);
    const double setup = now_ms() - start;
    double best = 1e300;
    for (int k = 0; k < repeat; ++k) {
        system.clear();
        MPI_Barrier(MPI_COMM_WORLD);
        const double begin = now_ms();
        HYPRE_StructPCGSolve(pcg, system.A, system.b, system.x);
        MPI_Barrier(MPI_COMM_WORLD);
        best = std::min(best, now_ms() - begin);
    }
    int iterations = 0;
    HYPRE_StructPCGGetNumIterations(pcg, &iterations);
    double bytes = heap_bytes() - before, all = 0;
    MPI_Reduce(&bytes, &all, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    std::vector<double> mine(system.zeros.size());
    HYPRE_StructVectorGetBoxValues(system.x, system.low.data(), system.high.data(), mine.data());
    Grid<real, D> p(problem.b.extent()), sum(problem.b.extent());
    std::copy(mine.begin(), mine.end(), p.data() + p.linear(system.low));
    MPI_Reduce(p.data(), sum.data(), static_cast<int>(p.size()), MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0) std::printf("PFMG %.17g %.17g %d %.17g %.17g\n", setup, best, iterations, true_residual(problem, sum), all);
    return 0;
}

}  // namespace

int pfmg_process(const std::string& name, int dim, int n, int repeat, double ratio) {
    MPI_Init(nullptr, nullptr);
    int rank = 0, ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    set_threads(1);
    HYPRE_Init();
    const int code = dim == 2 ? measure<2>(name, n, repeat, ratio, rank, ranks) : measure<3>(name, n, repeat, ratio, rank, ranks);
    HYPRE_Finalize();
    MPI_Finalize();
    return code;
}

PfmgResult run_pfmg(const std::string& program, const std::string& name, int dim, int n, int ranks, int repeat, double ratio) {
    std::vector<std::string> words;
    if (ranks > 1)
        words = {"env", "OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1", "mpirun", "--oversubscribe",
                 "-n",  std::to_string(ranks)};
    words.insert(words.end(), {program, "--pfmg-process", "--case", name, "--dim", std::to_string(dim), "--n", std::to_string(n),
                               "--repeat", std::to_string(repeat), "--ratio", std::to_string(ratio)});
    PfmgResult result;
    result.failure = "no answer from its process";
    std::istringstream lines(output_of_program(words).value_or(""));
    for (std::string line; std::getline(lines, line);)
        if (std::sscanf(line.c_str(), "PFMG %lf %lf %d %lf %lf", &result.setup_ms, &result.solve_ms, &result.iterations, &result.residual,
                        &result.bytes) == 5)
            result.failure.clear();
    return result;
}

}  // namespace weir::bench
