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
    /// Takes the matrix and sets the preconditioner up. `remove_means`, empty where no component is closed, takes from a vector what the
    /// matrix maps to zero.
    virtual void prepare(const Matrix& A, std::function<void(Vector&)> remove_means) = 0;
    /// Conjugate gradients from x on, until `wants_more`, asked with ‖b − A x‖₂ after each iteration, says no, or PETSc finds nothing to
    /// gain. Throws std::runtime_error with PETSc's words.
    virtual void solve(Vector& x, const Vector& b, const std::function<bool(real)>& wants_more) = 0;
    virtual std::size_t bytes() const = 0;
};

/// The name in the library of a function that makes an engine for "gamg", "boomeramg" or "icc" in `dim` dimensions.
inline constexpr const char* petsc_entry = "weir_petsc_engine";
using PetscEntry = PetscEngine* (*)(const char* preconditioner, int dim);

}  // namespace weir::poisson
