// cholmod: a direct solve, refined until the true residual meets the tolerance (usually one step, to round-off).
#include "poisson/factories.hpp"
#include "poisson/list_solver.hpp"
#include "poisson/sparse_cholesky.hpp"

namespace weir::poisson {

namespace {

template <int D>
class Cholmod final : public ListSolver<D> {
public:
    using ListSolver<D>::ListSolver;

private:
    using ListSolver<D>::system_, ListSolver<D>::x_, ListSolver<D>::b_, ListSolver<D>::r_, ListSolver<D>::b_norm_;

    void prepare() override {
        correction_.assign(x_.size(), 0);
        cholesky_.factor(system_.A, system_.components);
    }
    void iterate(linear::StopTest& stop, real) override {
        cholesky_.solve(r_, correction_);
        for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += correction_[i];
        system_.components.remove_means(x_);
        residual(system_.A, x_, b_, r_);
        stop.count(std::sqrt(dot(r_, r_)) / b_norm_);
    }
    std::size_t own_bytes() const override { return cholesky_.bytes() + correction_.capacity() * sizeof(real); }

    SparseCholesky cholesky_;
    Vector correction_;
};

}  // namespace

template <int D>
Made<D> make_cholmod(const Options& options) {
    return std::make_unique<Cholmod<D>>(options);
}

template Made<2> make_cholmod<2>(const Options&);
template Made<3> make_cholmod<3>(const Options&);

}  // namespace weir::poisson
