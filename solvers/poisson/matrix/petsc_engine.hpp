// Interface to PETSc, implemented by a separate library: PETSc depends on a hundred shared libraries, including MPI, and a run that does
// not use it loads none.
#pragma once
#include "poisson/matrix/system.hpp"

#include <functional>
#include <memory>

namespace weir::poisson {

class PetscEngine {
public:
    virtual ~PetscEngine() = default;
    /// Takes this rank's rows of the matrix, as partitioned by equal_partition, and sets up the preconditioner. `components`: the null
    /// space of the matrix; it must outlive all solves.
    virtual void prepare(const Matrix& A, const Components& components) = 0;
    /// Conjugate gradients starting at x, until `wants_more`, called with ‖b − A x‖₂ after each iteration, returns false, or PETSc finds no
    /// further gain. In parallel each rank improves its rows of x. Throws std::runtime_error with PETSc's message.
    virtual void solve(Vector& x, const Vector& b, const std::function<bool(real)>& wants_more) = 0;
    virtual std::size_t bytes() const = 0;
};

/// The name of the library's function that creates an engine for "gamg", "boomeramg" or "icc" in `dim` dimensions, for this process alone
/// or for all of `ranks` together.
inline constexpr const char* petsc_entry = "weir_petsc_engine";
using PetscEntry = PetscEngine* (*)(const char* preconditioner, int dim, int ranks);

}  // namespace weir::poisson
