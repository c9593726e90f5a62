// petsc_gamg, petsc_boomeramg, petsc_icc: PETSc's conjugate gradients, from a library that is loaded when one of them is named.
#include "poisson/petsc_engine.hpp"

#include "core/error.hpp"
#include "core/library.hpp"
#include "poisson/factories.hpp"
#include "poisson/list_solver.hpp"

namespace weir::poisson {

namespace {

PetscEntry entry() {
    static const auto loaded = reinterpret_cast<PetscEntry>(entry_of_library("libweir_petsc.so", WEIR_PETSC_LIBRARY, petsc_entry));
    return loaded;
}

template <int D>
class Petsc final : public ListSolver<D> {
public:
    Petsc(const std::string& preconditioner, const Options& options)
        : ListSolver<D>(options), engine_(entry()(preconditioner.c_str(), D)) {}

private:
    using ListSolver<D>::system_, ListSolver<D>::x_, ListSolver<D>::b_, ListSolver<D>::b_norm_;

    void prepare() override {
        guarded([&] {
            engine_->prepare(system_.A, system_.components.closed == 0 ? nullptr : std::function<void(Vector&)>([this](Vector& x) {
                                 system_.components.remove_means(x);
                             }));
        });
    }
    void iterate(Progress& progress) override {
        guarded([&] {
            engine_->solve(x_, b_, [&](real residual) {
                progress.count(residual / b_norm_);
                return progress.wants_more(residual / b_norm_);
            });
        });
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

    std::unique_ptr<PetscEngine> engine_;
};

template <int D>
Made<D> make(const char* preconditioner, const Options& options) {
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
