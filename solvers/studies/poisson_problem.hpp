// Solver "poisson": one manufactured pressure problem, ∇²p = f with f sampled at cell centres, solved in one step. Its discrete errors are
// known to all digits, so it tests matrix, boundary conditions and solver together.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "mac/grid/projection.hpp"
#include "mac/grid/velocity.hpp"
#include "poisson/poisson.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace weir::studies {

using namespace mac;  // the grid's words are the solver's own

/// A right-hand side on the unit square or cube, by name.
struct ManufacturedProblem {
    const char* name;
    int dim;
    bool dirichlet;  // p = 0 on all sides; otherwise zero flux
    real (*f)(const real* x);
};
const std::vector<ManufacturedProblem>& manufactured_problems();

template <int D>
class PoissonProblemSolver final : public Solver {
public:
    explicit PoissonProblemSolver(const scene::Scene& scene);
    /// Solves from p = 0; dt is ignored.
    StepReport step(real dt) override;
    real advised_dt() const override { return infinity; }
    FieldSet fields() const override;
    std::vector<Integral> integrals() const override { return {}; }
    real time() const override { return time_; }
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override { return solver_->bytes() + (p_.size() + rhs_.size()) * sizeof(real); }

private:
    MacVelocity<D> lattice_;
    poisson::Operator<D> matrix_;
    std::unique_ptr<poisson::Solver<D>> solver_;
    Grid<real, D> p_, rhs_;
    real time_ = 0;
    Passes passes_;
};

}  // namespace weir::studies
