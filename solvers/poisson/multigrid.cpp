// multigrid: conjugate gradients preconditioned by the geometric V-cycle where the cells allow it, else by aggregation multigrid.
#include "poisson/algebraic_multigrid.hpp"
#include "poisson/conjugate_gradient.hpp"
#include "poisson/factories.hpp"
#include "poisson/geometric_cg.hpp"

namespace weir::poisson {

namespace {

template <int D>
class Multigrid final : public Solver<D> {
public:
    explicit Multigrid(const Options& options) : options_(options), algebraic_(options) {}

    void setup(const Operator<D>& A) override {
        const Stopwatch watch;
        extent_ = A.cells.extent();
        problem_.build(A);
        geometric_fits_ = geometric_.setup(problem_);
        if (!geometric_fits_) algebraic_.setup(A);
        if (options_.record_history) report_.history.reserve(static_cast<std::size_t>(options_.max_iterations));
        report_.components = problem_.closed();
        report_.bytes = bytes();
        report_.setup_seconds = watch.seconds();
    }

    const Report& solve(Grid<real, D>& p, const Grid<real, D>& b) override {
        if (!geometric_fits_) return algebraic_.solve(p, b);
        const Stopwatch watch;
        check_extents(p.extent() == extent_, "p");
        check_extents(b.extent() == extent_, "b");
        geometric_.solve(problem_, p, b, options_, report_, true);
        report_.solve_seconds = watch.seconds();
        judge(options_, report_);
        return report_;
    }

    std::size_t bytes() const override { return geometric_fits_ ? problem_.bytes() + geometric_.bytes() : algebraic_.bytes(); }

private:
    Options options_;
    Index<D> extent_{};
    Natural<D> problem_;
    GeometricCg<D> geometric_;
    bool geometric_fits_ = false;
    ConjugateGradient<D, AlgebraicMultigrid> algebraic_;
    Report report_;
};

}  // namespace

template <int D>
Made<D> make_multigrid(const Options& options) {
    return std::make_unique<Multigrid<D>>(options);
}

template Made<2> make_multigrid<2>(const Options&);
template Made<3> make_multigrid<3>(const Options&);

}  // namespace weir::poisson
