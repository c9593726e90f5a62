// cg_mic0: modified incomplete Cholesky of level zero (Gustafsson 1978; Bridson 2015, figures 5.6 and 5.7).
#include "poisson/factories.hpp"
#include "poisson/matrix/conjugate_gradient.hpp"

namespace weir::poisson {

namespace {

constexpr real tau = 0.97;    // fraction of the dropped fill that is added to the diagonal (Bridson 2015)
constexpr real sigma = 0.25;  // smaller pivots, relative to the diagonal, are replaced (Bridson 2015)

/// L = (strict lower triangle of A) E + E⁻¹ with a diagonal E; solves L q = r, then Lᵀ z = q, row by row.
class Mic0 {
public:
    void prepare(const Matrix& A, const Components&) {
        A_ = &A;
        factor();
    }

    void apply(const Vector& r, Vector& z) const {
        const Matrix& A = *A_;
        const auto n = r.size();
        for (std::size_t i = 0; i < n; ++i) {
            real sum = r[i];
            for (int k = A.start[i]; k < middle_[i]; ++k) sum += weight(k) * E_[column(k)] * z[column(k)];
            z[i] = sum * E_[i];
        }
        for (std::size_t i = n; i-- > 0;) {
            real sum = 0;
            for (int k = middle_[i]; k < A.start[i + 1]; ++k) sum += weight(k) * z[column(k)];
            z[i] = (z[i] + E_[i] * sum) * E_[i];
        }
    }
    std::size_t bytes() const { return E_.capacity() * sizeof(real) + middle_.capacity() * sizeof(int); }

private:
    std::size_t column(int k) const { return static_cast<std::size_t>(A_->column[static_cast<std::size_t>(k)]); }
    real weight(int k) const { return A_->weight[static_cast<std::size_t>(k)]; }

    void factor() {
        const Matrix& A = *A_;
        const auto n = A.diagonal.size();
        E_.assign(n, 0);
        middle_.assign(n, 0);
        Vector upper(n, 0);  // sum of the weights above the diagonal of each row
        for (std::size_t i = 0; i < n; ++i) {
            real pivot = A.diagonal[i];
            int k = A.start[i];
            for (; k < A.start[i + 1] && column(k) < i; ++k) {
                const real e2 = E_[column(k)] * E_[column(k)];
                pivot -= weight(k) * e2 * (weight(k) + tau * (upper[column(k)] - weight(k)));
            }
            middle_[i] = k;
            for (; k < A.start[i + 1]; ++k) upper[i] += weight(k);
            if (pivot < sigma * A.diagonal[i]) pivot = A.diagonal[i];
            E_[i] = pivot > 0 ? 1 / std::sqrt(pivot) : 0;
        }
    }

    const Matrix* A_ = nullptr;
    Vector E_;
    std::vector<int> middle_;  // first entry of each row above the diagonal
};

}  // namespace

template <int D>
Made<D> make_cg_mic0(const Options& options) {
    return std::make_unique<ConjugateGradient<D, Mic0>>(options);
}

template Made<2> make_cg_mic0<2>(const Options&);
template Made<3> make_cg_mic0<3>(const Options&);

}  // namespace weir::poisson
