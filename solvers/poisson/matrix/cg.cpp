// cg and cg_jacobi: M = 1 and M = 1/diagonal.
#include "poisson/factories.hpp"
#include "poisson/matrix/conjugate_gradient.hpp"

namespace weir::poisson {

namespace {

struct Identity {
    void prepare(const Matrix&, const Components&) {}
    void apply(const Vector& r, Vector& z) const { z = r; }
    std::size_t bytes() const { return 0; }
};

/// An isolated cell has diagonal 0 and residual 0: its entry of M is arbitrary.
struct Diagonal {
    Vector inverse;
    void prepare(const Matrix& A, const Components&) {
        inverse = A.diagonal;
        for (real& d : inverse) d = d > 0 ? 1 / d : 0;
    }
    void apply(const Vector& r, Vector& z) const {
        for_each_block(r.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) z[i] = inverse[i] * r[i];
        });
    }
    std::size_t bytes() const { return inverse.capacity() * sizeof(real); }
};

}  // namespace

template <int D>
Made<D> make_cg(const Options& options) {
    return std::make_unique<ConjugateGradient<D, Identity>>(options);
}
template <int D>
Made<D> make_cg_jacobi(const Options& options) {
    return std::make_unique<ConjugateGradient<D, Diagonal>>(options);
}

template Made<2> make_cg<2>(const Options&);
template Made<3> make_cg<3>(const Options&);
template Made<2> make_cg_jacobi<2>(const Options&);
template Made<3> make_cg_jacobi<3>(const Options&);

}  // namespace weir::poisson
