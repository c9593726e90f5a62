// red_black and jacobi: the methods of games, for a fixed number of iterations.
#include "poisson/factories.hpp"
#include "poisson/list_solver.hpp"

namespace weir::poisson {

namespace {

/// The sum over the neighbours of unknown i: Σ w x.
real neighbours(const Matrix& A, const Vector& x, int i) {
    real sum = 0;
    for (int k = A.start[static_cast<std::size_t>(i)]; k < A.start[static_cast<std::size_t>(i) + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        sum += A.weight[entry] * x[static_cast<std::size_t>(A.column[entry])];
    }
    return sum;
}

/// Gauss-Seidel, colour by colour: cells of a colour are not neighbours and can be updated in parallel.
template <int D>
class RedBlack final : public ListSolver<D> {
public:
    using ListSolver<D>::ListSolver;

private:
    using ListSolver<D>::system_, ListSolver<D>::x_, ListSolver<D>::b_, ListSolver<D>::r_, ListSolver<D>::b_norm_;

    void prepare() override {
        for (auto& list : of_colour_) list.clear();
        for (std::size_t i = 0; i < system_.colour.size(); ++i) of_colour_[system_.colour[i]].push_back(static_cast<int>(i));
    }
    void iterate(linear::StopTest& stop, real relative) override {
        do {
            for (const auto& list : of_colour_) sweep(list);
            residual(system_.A, x_, b_, r_);
            relative = std::sqrt(dot(r_, r_)) / b_norm_;
            stop.count(relative);
        } while (stop.wants_more(relative));
    }
    void sweep(const std::vector<int>& list) {
        for_each_block(list.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                const auto i = static_cast<std::size_t>(list[m]);
                if (system_.A.diagonal[i] > 0) x_[i] = (b_[i] + neighbours(system_.A, x_, list[m])) / system_.A.diagonal[i];
            }
        });
    }
    std::size_t own_bytes() const override { return x_.size() * sizeof(int); }

    std::array<std::vector<int>, 2 << D> of_colour_;
};

/// x += ω r / diagonal. ω = 0.9: undamped, the checkerboard mode of a closed box never decays. With 0.9 it loses a fifth per iteration, and
/// smooth errors converge only a tenth more slowly.
template <int D>
class Jacobi final : public ListSolver<D> {
public:
    using ListSolver<D>::ListSolver;

private:
    using ListSolver<D>::system_, ListSolver<D>::x_, ListSolver<D>::b_, ListSolver<D>::r_, ListSolver<D>::b_norm_;

    static constexpr real omega = 0.9;

    void prepare() override {}
    void iterate(linear::StopTest& stop, real relative) override {
        do {
            for_each_block(x_.size(), [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    if (system_.A.diagonal[i] > 0) x_[i] += omega * r_[i] / system_.A.diagonal[i];
            });
            residual(system_.A, x_, b_, r_);
            relative = std::sqrt(dot(r_, r_)) / b_norm_;
            stop.count(relative);
        } while (stop.wants_more(relative));
    }
};

}  // namespace

template <int D>
Made<D> make_red_black(const Options& options) {
    return std::make_unique<RedBlack<D>>(options);
}
template <int D>
Made<D> make_jacobi(const Options& options) {
    return std::make_unique<Jacobi<D>>(options);
}

template Made<2> make_red_black<2>(const Options&);
template Made<3> make_red_black<3>(const Options&);
template Made<2> make_jacobi<2>(const Options&);
template Made<3> make_jacobi<3>(const Options&);

}  // namespace weir::poisson
