// The registry of methods: one line per method.
#include "core/error.hpp"
#include "poisson/factories.hpp"

namespace weir::poisson {

const std::vector<Method>& methods() {
    static const std::vector<Method> list = {
        {.name = "multigrid", .doc = "conjugate gradients preconditioned by a multigrid V-cycle: the default"},
        {.name = "cg_mic0", .doc = "conjugate gradients with modified incomplete Cholesky (Bridson 2015)"},
        {.name = "cg_jacobi", .doc = "conjugate gradients preconditioned by the diagonal"},
        {.name = "cg", .doc = "conjugate gradients without a preconditioner"},
        {.name = "eigen_iccg", .doc = "conjugate gradients with Eigen's incomplete Cholesky (Lin & More 1999)"},
        {.name = "cholmod",
         .doc = "sparse Cholesky of SuiteSparse, analysed once, refactored only when flags or weights change",
         .iterative = false},
        {.name = "red_black", .doc = "red-black Gauss-Seidel"},
        {.name = "jacobi", .doc = "damped Jacobi"},
        {.name = "dct", .doc = "cosine transforms (FFTW); whole closed boxes only", .iterative = false, .whole_box_only = true},
        {.name = "petsc_gamg", .doc = "PETSc's conjugate gradients with its smoothed aggregation", .needs_petsc = true},
        {.name = "petsc_boomeramg", .doc = "PETSc's conjugate gradients with hypre's BoomerAMG", .needs_petsc = true},
        {.name = "petsc_icc", .doc = "PETSc's conjugate gradients with its incomplete Cholesky", .needs_petsc = true},
    };
    return list;
}

namespace {

template <int D>
using Maker = Made<D> (*)(const Options&);

template <int D>
constexpr std::array<Maker<D>, 12> makers = {make_multigrid<D>,  make_cg_mic0<D>,    make_cg_jacobi<D>,       make_cg<D>,
                                             make_eigen_iccg<D>, make_cholmod<D>,    make_red_black<D>,       make_jacobi<D>,
                                             make_dct<D>,        make_petsc_gamg<D>, make_petsc_boomeramg<D>, make_petsc_icc<D>};

}  // namespace

template <int D>
std::unique_ptr<Solver<D>> make_solver(std::string_view method, const Options& options) {
    std::string known;
    for (std::size_t i = 0; i < methods().size(); ++i) {
        if (methods()[i].name == method) return makers<D>[i](options);
        known += (i == 0 ? "" : ", ") + methods()[i].name;
    }
    throw BadInput("unknown pressure method \"" + std::string(method) + "\"; known: " + known);
}

template std::unique_ptr<Solver<2>> make_solver<2>(std::string_view, const Options&);
template std::unique_ptr<Solver<3>> make_solver<3>(std::string_view, const Options&);

}  // namespace weir::poisson
