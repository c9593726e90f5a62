// dct: on a whole closed box the matrix is diagonal in the cosine basis (DCT-II; Swarztrauber 1977): transform, divide, transform back.
//
//     λ_k = Σ_a w_a 4 sin²(π k_a / (2 n_a)),   k_a = 0 .. n_a − 1
#include "core/error.hpp"
#include "poisson/faces.hpp"
#include "poisson/factories.hpp"
#include "poisson/matrix/list_solver.hpp"

#include <fftw3.h>

#include <limits>

namespace weir::poisson {

namespace {

template <int D>
bool is_whole_closed_box(const Operator<D>& A) {
    for (const Cell c : A.cells.values())
        if (c != Cell::fluid) return false;
    for (const bool wraps : A.periodic)
        if (wraps) return false;
    if (!has_weights(A)) return true;
    for (int a = 0; a < D; ++a) {
        const auto& weight = A.weight[static_cast<std::size_t>(a)];
        const int n = A.cells.extent()[a];
        const real wrong =
            sum_over(replicated<D>(weight.extent()), [&](const Index<D>& I) { return weight(I) != (I[a] > 0 && I[a] < n ? 1.0 : 0.0); });
        if (wrong > 0) return false;
    }
    return true;
}

template <int D>
class Dct final : public Solver<D> {
public:
    explicit Dct(const Options& options) : options_(options) {}
    ~Dct() override { release(); }
    Dct(const Dct&) = delete;
    Dct& operator=(const Dct&) = delete;

    void setup(const Operator<D>& A) override {
        const Stopwatch watch;
        if (!is_whole_closed_box(A))
            throw BadInput(
                "pressure method \"dct\" solves whole closed boxes only: every cell fluid, all weights 1, no side open or periodic");
        A_.cells = Grid<Cell, D>(replicated<D>(A.cells.extent()), Cell::fluid);
        A_.axis_weight = A.axis_weight;
        const Index<D> n = A.cells.extent();
        if (values_.extent() != n) plan(n);
        for (int a = 0; a < D; ++a) {
            auto& lambda = eigenvalue_[static_cast<std::size_t>(a)];
            lambda.resize(static_cast<std::size_t>(n[a]));
            for (int k = 0; k < n[a]; ++k) {
                const real s = std::sin(pi * k / (2.0 * n[a]));
                lambda[static_cast<std::size_t>(k)] = 4 * A.axis_weight[a] * s * s;
            }
        }
        report_.components = 1;
        report_.bytes = bytes();
        report_.setup_seconds = watch.seconds();
    }

    const Report& solve(Grid<real, D>& p, const Grid<real, D>& b) override {
        const Stopwatch watch;
        check_extents(p.extent() == values_.extent(), "p");
        check_extents(b.extent() == values_.extent(), "b");
        const auto& n = values_.extent();
        const real mean = sum_over(n, [&](const Index<D>& I) { return b(I); }) / static_cast<real>(b.size());
        for_each_cell(n, [&](const Index<D>& I) { b_(I) = b(I) - mean; });
        report_.iterations = 0;
        report_.history.clear();
        report_.residual_before = measure(p);
        std::copy(b_.data(), b_.data() + b_.size(), values_.data());
        fftw_execute(forward_);
        divide();
        fftw_execute(backward_);
        std::copy(values_.data(), values_.data() + values_.size(), p.data());
        report_.iterations = 1;
        report_.residual_after = measure(p);
        report_.residual_max = max_over(n, [&](const Index<D>& I) { return std::abs(values_(I)); });
        report_.solve_seconds = watch.seconds();
        Options asked = options_;
        if (report_.residual_after > asked.tolerance) asked.tolerance = std::max(asked.tolerance, round_off(p));
        judge(asked, report_);
        return report_;
    }

    std::size_t bytes() const override { return (values_.size() + b_.size()) * sizeof(real) + A_.cells.size(); }

private:
    /// FFTW_ESTIMATE: measured plans would differ between runs, and so would the last bits of the result.
    void plan(const Index<D>& n) {
        release();
        values_ = Grid<real, D>(replicated(n));
        b_ = Grid<real, D>(replicated(n));
        std::array<int, D> size;
        std::array<fftw_r2r_kind, D> there, back;
        for (int a = 0; a < D; ++a) size[static_cast<std::size_t>(a)] = n[D - 1 - a];
        there.fill(FFTW_REDFT10);
        back.fill(FFTW_REDFT01);
        forward_ = fftw_plan_r2r(D, size.data(), values_.data(), values_.data(), there.data(), FFTW_ESTIMATE);
        backward_ = fftw_plan_r2r(D, size.data(), values_.data(), values_.data(), back.data(), FFTW_ESTIMATE);
    }
    void release() {
        if (forward_ != nullptr) fftw_destroy_plan(forward_);
        if (backward_ != nullptr) fftw_destroy_plan(backward_);
        forward_ = backward_ = nullptr;
    }
    /// Divides by λ and by FFTW's scale; the mean becomes zero.
    void divide() {
        real scale = 1;
        for (int a = 0; a < D; ++a) scale *= 2.0 * values_.extent()[a];
        for_each_cell(values_.extent(), [&](const Index<D>& k) {
            real lambda = 0;
            for (int a = 0; a < D; ++a) lambda += eigenvalue_[static_cast<std::size_t>(a)][static_cast<std::size_t>(k[a])];
            values_(k) = lambda > 0 ? values_(k) / (lambda * scale) : 0;
        });
    }
    /// Stores b − A p in values_ and returns its norm relative to that of b.
    real measure(const Grid<real, D>& p) {
        residual(A_, p, b_, values_);
        const auto square = [&](const Grid<real, D>& g) {
            return sum_over(replicated<D>(g.extent()), [&](const Index<D>& I) { return g(I) * g(I); });
        };
        const real b2 = square(b_);
        return b2 == 0 ? 0 : std::sqrt(square(values_) / b2);
    }

    /// Round-off of the residual of the exact solution, relative to the norm of b. A transform of N values has a relative error of at most
    /// eta = 7 u log2(4 N) (Higham 2002, theorem 24.2, u = epsilon / 2): forward eta |b|, backward eta |A| |p|. The residual itself is a
    /// sum of 2 D + 1 differences, each of at most |A| |p|.
    real round_off(const Grid<real, D>& p) {
        const real epsilon = std::numeric_limits<real>::epsilon(), N = static_cast<real>(p.size());
        const real eta = 3.5 * epsilon * std::log2(4 * N);
        real norm_of_A = 0;
        for (int a = 0; a < D; ++a) norm_of_A += 4 * A_.axis_weight[a];
        const auto square = [&](const Grid<real, D>& g) {
            return sum_over(replicated<D>(g.extent()), [&](const Index<D>& I) { return g(I) * g(I); });
        };
        return eta + (eta + (2 * D + 1) * epsilon) * norm_of_A * std::sqrt(square(p) / square(b_));
    }

    Options options_;
    Operator<D> A_;
    Grid<real, D> values_, b_;
    std::array<Vector, D> eigenvalue_;
    fftw_plan forward_ = nullptr, backward_ = nullptr;
    Report report_;
};

}  // namespace

template <int D>
Made<D> make_dct(const Options& options) {
    return std::make_unique<Dct<D>>(options);
}

template Made<2> make_dct<2>(const Options&);
template Made<3> make_dct<3>(const Options&);

}  // namespace weir::poisson
