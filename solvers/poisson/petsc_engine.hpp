// What weir asks of PETSc, as a class that a library of its own implements: PETSc brings a hundred shared libraries with it, MPI among
// them, and a run that does not name it loads none.
#pragma once
#include "poisson/system.hpp"

#include <functional>
#include <memory>

namespace weir::poisson {

class PetscEngine {
public:
    virtual ~PetscEngine() = default;
    /// Takes its rank's rows of the matrix, as cut_of cuts them, and sets the preconditioner up. `components`: what the matrix maps to
    /// zero; they are to live as long as solves go on.
    virtual void prepare(const Matrix& A, const Components& components) = 0;
    /// Conjugate gradients from x on, until `wants_more`, asked with ‖b − A x‖₂ after each iteration, says no, or PETSc finds nothing to
    /// gain. Over ranks each has improved its rows of x. Throws std::runtime_error with PETSc's words.
    virtual void solve(Vector& x, const Vector& b, const std::function<bool(real)>& wants_more) = 0;
    virtual std::size_t bytes() const = 0;
};

/// The name in the library of a function that makes an engine for "gamg", "boomeramg" or "icc" in `dim` dimensions, for this process alone
/// or for all of `ranks` together.
inline constexpr const char* petsc_entry = "weir_petsc_engine";
using PetscEntry = PetscEngine* (*)(const char* preconditioner, int dim, int ranks);

}  // namespace weir::poisson
