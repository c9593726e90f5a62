// libweir_petsc: PETSc's conjugate gradients (KSPCG) with its algebraic multigrid (GAMG), hypre's (BoomerAMG; Henson & Yang 2002) or
// incomplete Cholesky. It uses none of weir's arithmetic: an independent reference. Balay et al., PETSc/TAO Users Manual, 3.18.
#include "poisson/matrix/petsc_engine.hpp"

#include "parallel/partition.hpp"

#include <petscksp.h>

#include <malloc.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace weir::poisson {

namespace {

void check(PetscErrorCode code) {
    if (code == 0) return;
    const char* text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw std::runtime_error(std::string("PETSc: ") + (text ? text : "unknown error"));
}

/// Once per process, for this process alone. Signal handlers stay weir's, and no user file or environment variable changes the solver.
void start_petsc() {
    static const bool started = [] {
        PETSC_COMM_WORLD = MPI_COMM_SELF;
        int has_mpi = 0;
        MPI_Initialized(&has_mpi);
        if (!has_mpi) MPI_Init(nullptr, nullptr);
        check(PetscOptionsSetValue(nullptr, "-no_signal_handler", "true"));
        check(PetscOptionsSetValue(nullptr, "-skip_petscrc", "true"));
        check(PetscInitializeNoArguments());
        check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));
        check(PetscOptionsSetValue(nullptr, "-weir_blocks_sub_pc_type", "icc"));
        check(PetscOptionsSetValue(nullptr, "-weir_blocks_sub_pc_factor_shift_type", "positive_definite"));
        // recommended by hypre's manual in 3D; with 0.25, the value for 2D, the hierarchy fills in
        check(PetscOptionsSetValue(nullptr, "-weir_3d_pc_hypre_boomeramg_strong_threshold", "0.5"));
        if (!has_mpi)
            std::atexit([] {
                PetscFinalize();
                MPI_Finalize();
            });
        return true;
    }();
    static_cast<void>(started);
}

/// Bytes of heap in use: hypre does not report its own memory.
std::size_t heap() {
    const auto info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

class Engine final : public PetscEngine {
public:
    Engine(const std::string& preconditioner, int dim, int ranks)
        : preconditioner_(preconditioner), dim_(dim), ranks_(ranks), together_(ranks > 1 ? MPI_COMM_WORLD : MPI_COMM_SELF) {
        start_petsc();
    }
    ~Engine() override { clear(); }

    void prepare(const Matrix& A, const Components& components) override {
        clear();
        if (A.size() == 0) return;
        const std::size_t before = heap();
        components_ = &components;
        take(A);
        check(KSPCreate(together_, &solver_));
        check(KSPSetType(solver_, KSPCG));
        check(KSPSetNormType(solver_, KSP_NORM_UNPRECONDITIONED));
        check(KSPSetInitialGuessNonzero(solver_, PETSC_TRUE));
        check(KSPSetTolerances(solver_, 0, 0, PETSC_DEFAULT, 1 << 30));
        check(KSPSetConvergenceTest(solver_, &Engine::ask, this, nullptr));
        check(KSPSetOperators(solver_, matrix_, matrix_));
        choose_preconditioner();
        check(KSPSetUp(solver_));
        bytes_ = heap() - std::min(before, heap());
    }

    void solve(Vector& x, const Vector& b, const std::function<bool(real)>& wants_more) override {
        if (!solver_) return;
        wants_more_ = &wants_more;
        check(VecPlaceArray(x_, x.data() + first_));
        check(VecPlaceArray(b_, b.data() + first_));
        const PetscErrorCode code = KSPSolve(solver_, b_, x_);
        check(VecResetArray(x_));
        check(VecResetArray(b_));
        check(code);
    }

    std::size_t bytes() const override { return bytes_; }

private:
    /// Takes this rank's rows with their diagonal in PETSc's format; for a single rank these arrays are used in place.
    void take(const Matrix& A) {
        first_ = 0, end_ = static_cast<std::size_t>(A.size());
        if (const Partition cut = equal_partition(A.size(), ranks_); !cut.empty()) {
            int rank = 0;
            MPI_Comm_rank(together_, &rank);
            first_ = static_cast<std::size_t>(cut.begin(rank)), end_ = static_cast<std::size_t>(cut.end(rank, A.size()));
        }
        start_.assign(1, 0), column_.clear(), value_.clear();
        for (std::size_t row = first_; row < end_; ++row) {
            const auto i = static_cast<PetscInt>(row);
            bool has_diagonal = false;
            const auto diagonal = [&] {
                has_diagonal = true;
                column_.push_back(i), value_.push_back(A.diagonal[row] > 0 ? A.diagonal[row] : 1);
            };
            for (auto k = static_cast<std::size_t>(A.start[row]); k < static_cast<std::size_t>(A.start[row + 1]); ++k) {
                if (!has_diagonal && A.column[k] > i) diagonal();
                column_.push_back(A.column[k]), value_.push_back(-A.weight[k]);
            }
            if (!has_diagonal) diagonal();
            start_.push_back(static_cast<PetscInt>(column_.size()));
        }
        create_matrix(A.size(), static_cast<PetscInt>(end_ - first_));
        if (components_->closed == 0) return;
        MatNullSpace null = nullptr;
        check(MatNullSpaceCreate(together_, PETSC_FALSE, 0, nullptr, &null));
        check(MatNullSpaceSetFunction(null, &Engine::take_means_out, this));
        check(MatSetNullSpace(matrix_, null));
        check(MatNullSpaceDestroy(&null));
    }

    void create_matrix(PetscInt n, PetscInt own) {
        if (ranks_ == 1) {
            check(MatCreateSeqAIJWithArrays(together_, n, n, start_.data(), column_.data(), value_.data(), &matrix_));
            check(VecCreateSeqWithArray(together_, 1, n, nullptr, &x_));
            check(VecCreateSeqWithArray(together_, 1, n, nullptr, &b_));
        } else {
            check(MatCreateMPIAIJWithArrays(together_, own, own, n, n, start_.data(), column_.data(), value_.data(), &matrix_));
            start_ = {}, column_ = {}, value_ = {};
            check(VecCreateMPIWithArray(together_, 1, own, n, nullptr, &x_));
            check(VecCreateMPIWithArray(together_, 1, own, n, nullptr, &b_));
        }
        check(MatSetOption(matrix_, MAT_SYMMETRIC, PETSC_TRUE));
    }

    void choose_preconditioner() {
        PC pc = nullptr;
        check(KSPGetPC(solver_, &pc));
        if (preconditioner_ == "gamg") {
            check(PCSetType(pc, PCGAMG));
        } else if (preconditioner_ == "boomeramg") {
            check(PCSetType(pc, PCHYPRE));
            check(PCHYPRESetType(pc, "boomeramg"));
            check(PCSetOptionsPrefix(pc, dim_ == 3 ? "weir_3d_" : "weir_2d_"));
            check(PCSetFromOptions(pc));
        } else if (ranks_ > 1) {  // each rank factors its own block
            check(PCSetType(pc, PCBJACOBI));
            check(PCSetOptionsPrefix(pc, "weir_blocks_"));
            check(PCSetFromOptions(pc));
        } else {
            check(PCSetType(pc, PCICC));
            // otherwise a closed component's last pivot is round-off
            check(PCFactorSetShiftType(pc, MAT_SHIFT_POSITIVE_DEFINITE));
        }
    }

    /// PETSc's callback after each iteration, and before the first.
    static PetscErrorCode ask(KSP, PetscInt iteration, PetscReal residual, KSPConvergedReason* reason, void* self) {
        const auto& engine = *static_cast<Engine*>(self);
        const bool more = iteration == 0 || (*engine.wants_more_)(residual);
        *reason = more ? KSP_CONVERGED_ITERATING : KSP_CONVERGED_RTOL;
        return 0;
    }

    /// Subtracts from v its mean over each closed component, over all ranks' rows.
    static PetscErrorCode take_means_out(MatNullSpace, ::Vec v, void* self) {
        auto& engine = *static_cast<Engine*>(self);
        PetscScalar* values = nullptr;
        VecGetArray(v, &values);
        const auto closed = static_cast<std::size_t>(engine.components_->closed);
        const int* of = engine.components_->of.data() + engine.first_;
        const std::size_t own = engine.end_ - engine.first_;
        auto& sums = engine.sums_;  // of values, then counts
        sums.assign(2 * closed, 0);
        for (std::size_t i = 0; i < own; ++i)
            if (of[i] >= 0) sums[static_cast<std::size_t>(of[i])] += values[i], sums[closed + static_cast<std::size_t>(of[i])] += 1;
        if (engine.ranks_ > 1)
            MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, engine.together_);
        for (std::size_t c = 0; c < closed; ++c) sums[c] /= sums[closed + c];
        for (std::size_t i = 0; i < own; ++i)
            if (of[i] >= 0) values[i] -= sums[static_cast<std::size_t>(of[i])];
        VecRestoreArray(v, &values);
        return 0;
    }

    void clear() {
        KSPDestroy(&solver_);
        MatDestroy(&matrix_);
        VecDestroy(&x_);
        VecDestroy(&b_);
    }

    std::string preconditioner_;
    int dim_, ranks_;
    MPI_Comm together_;
    std::size_t first_ = 0, end_ = 0;  // this rank's rows
    const Components* components_ = nullptr;
    const std::function<bool(real)>* wants_more_ = nullptr;
    std::vector<PetscInt> start_, column_;
    Vector value_, sums_;
    std::size_t bytes_ = 0;
    KSP solver_ = nullptr;
    Mat matrix_ = nullptr;
    ::Vec x_ = nullptr, b_ = nullptr;
};

}  // namespace

}  // namespace weir::poisson

extern "C" weir::poisson::PetscEngine* weir_petsc_engine(const char* preconditioner, int dim, int ranks) {
    return new weir::poisson::Engine(preconditioner, dim, ranks);
}
