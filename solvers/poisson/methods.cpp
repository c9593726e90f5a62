// The registry of methods: one entry each.
#include "core/error.hpp"
#include "poisson/factories.hpp"

namespace weir::poisson {

#define WEIR_MAKERS(f) .make_2d = f<2>, .make_3d = f<3>

const std::vector<Method>& methods() {
    static const std::vector<Method> list = {
        {.name = "multigrid",
         .doc = "conjugate gradients preconditioned by a multigrid V-cycle: the default",
         WEIR_MAKERS(make_multigrid),
         .distributed_levels = true},
        {.name = "cg_mic0", .doc = "conjugate gradients with modified incomplete Cholesky (Bridson 2015)", WEIR_MAKERS(make_cg_mic0)},
        {.name = "cg_jacobi", .doc = "conjugate gradients preconditioned by the diagonal", WEIR_MAKERS(make_cg_jacobi)},
        {.name = "cg", .doc = "conjugate gradients without a preconditioner", WEIR_MAKERS(make_cg)},
        {.name = "eigen_iccg",
         .doc = "conjugate gradients with Eigen's incomplete Cholesky (Lin & More 1999)",
         WEIR_MAKERS(make_eigen_iccg)},
        {.name = "cholmod",
         .doc = "sparse Cholesky of SuiteSparse, analysed once, refactored only when flags or weights change",
         WEIR_MAKERS(make_cholmod),
         .iterative = false},
        {.name = "red_black", .doc = "red-black Gauss-Seidel", WEIR_MAKERS(make_red_black)},
        {.name = "jacobi", .doc = "damped Jacobi", WEIR_MAKERS(make_jacobi)},
        {.name = "dct",
         .doc = "cosine transforms (FFTW); whole closed boxes only",
         WEIR_MAKERS(make_dct),
         .iterative = false,
         .whole_box_only = true},
        {.name = "petsc_gamg",
         .doc = "PETSc's conjugate gradients with its smoothed aggregation",
         WEIR_MAKERS(make_petsc_gamg),
         .needs_petsc = true},
        {.name = "petsc_boomeramg",
         .doc = "PETSc's conjugate gradients with hypre's BoomerAMG",
         WEIR_MAKERS(make_petsc_boomeramg),
         .needs_petsc = true},
        {.name = "petsc_icc",
         .doc = "PETSc's conjugate gradients with its incomplete Cholesky",
         WEIR_MAKERS(make_petsc_icc),
         .needs_petsc = true},
    };
    return list;
}

#undef WEIR_MAKERS

const Method& method_named(std::string_view name) {
    std::string known;
    for (const Method& method : methods()) {
        if (method.name == name) return method;
        known += (known.empty() ? "" : ", ") + method.name;
    }
    throw BadInput("unknown pressure method \"" + std::string(name) + "\"; known: " + known);
}

template <int D>
std::unique_ptr<Solver<D>> make_solver(std::string_view method, const Options& options) {
    const Method& chosen = method_named(method);
    if constexpr (D == 2)
        return chosen.make_2d(options);
    else
        return chosen.make_3d(options);
}

template std::unique_ptr<Solver<2>> make_solver<2>(std::string_view, const Options&);
template std::unique_ptr<Solver<3>> make_solver<3>(std::string_view, const Options&);

}  // namespace weir::poisson
