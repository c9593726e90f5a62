// petsc_gamg, petsc_boomeramg, petsc_icc: PETSc's conjugate gradients, from a library that is loaded when a scene names one of them. In
// parallel each rank assembles the whole system and PETSc distributes its rows. Its sums depend on the number of ranks, so results differ
// within the tolerance.
#include "poisson/matrix/petsc_engine.hpp"

#include "core/error.hpp"
#include "core/library.hpp"
#include "parallel/communicator.hpp"
#include "poisson/factories.hpp"
#include "poisson/matrix/list_solver.hpp"

#include <dlfcn.h>

namespace weir::poisson {

namespace {

/// Returns whether the ranks were started by another MPI than PETSc's. Its library cannot be loaded then: parts of it would call the wrong
/// MPI.
bool other_mpi() { return communicator().several() && (dlsym(RTLD_DEFAULT, "ompi_mpi_comm_world") != nullptr) != WEIR_PETSC_OPEN_MPI; }

PetscEntry entry() {
    if (other_mpi()) return nullptr;
    static const auto loaded = reinterpret_cast<PetscEntry>(entry_of_library("libweir_petsc.so", WEIR_PETSC_LIBRARY, petsc_entry));
    return loaded;
}

template <int D>
class Petsc final : public ListSolver<D> {
public:
    Petsc(const std::string& preconditioner, const Options& options)
        : ListSolver<D>(options),
          ranks_(communicator().builds_serial() ? 1 : communicator().ranks()),
          engine_(entry()(preconditioner.c_str(), D, ranks_)) {}

private:
    using ListSolver<D>::system_, ListSolver<D>::x_, ListSolver<D>::b_, ListSolver<D>::b_norm_;

    void prepare() override {
        guarded([&] { engine_->prepare(system_.A, system_.components); });
    }
    void iterate(linear::StopTest& stop, real) override {
        guarded([&] {
            engine_->solve(x_, b_, [&](real residual) {
                stop.count(residual / b_norm_);
                return stop.wants_more(residual / b_norm_);
            });
        });
        const int rows = system_.A.size();
        if (ranks_ > 1) communicator().gather(equal_partition(rows, ranks_), {x_.data(), sizeof(real), rows});
    }
    std::size_t own_bytes() const override { return engine_->bytes(); }

    template <class F>
    static void guarded(F&& work) {
        try {
            work();
        } catch (const std::runtime_error& error) {
            throw NumericalFailure("pressure", error.what());
        }
    }

    int ranks_;
    std::unique_ptr<PetscEngine> engine_;
};

template <int D>
Made<D> make(const char* preconditioner, const Options& options) {
    if (other_mpi())
        throw BadInput(std::string("the pressure method petsc_") + preconditioner +
                       ": the ranks were started by an MPI other than the one that PETSc was built with");
    if (!entry())
        throw BadInput(std::string("the pressure method petsc_") + preconditioner +
                       " needs PETSc, and this weir was built without it: install libpetsc-real-dev and configure again");
    return std::make_unique<Petsc<D>>(preconditioner, options);
}

}  // namespace

bool has_petsc() { return entry() != nullptr; }

template <int D>
Made<D> make_petsc_gamg(const Options& options) {
    return make<D>("gamg", options);
}
template <int D>
Made<D> make_petsc_boomeramg(const Options& options) {
    return make<D>("boomeramg", options);
}
template <int D>
Made<D> make_petsc_icc(const Options& options) {
    return make<D>("icc", options);
}

template Made<2> make_petsc_gamg<2>(const Options&);
template Made<3> make_petsc_gamg<3>(const Options&);
template Made<2> make_petsc_boomeramg<2>(const Options&);
template Made<3> make_petsc_boomeramg<3>(const Options&);
template Made<2> make_petsc_icc<2>(const Options&);
template Made<3> make_petsc_icc<3>(const Options&);

}  // namespace weir::poisson
