// eigen_iccg: Eigen's incomplete Cholesky with dual threshold (Lin & More 1999) in weir's conjugate gradients, so that the history and the
// fixed number of iterations are the same for all methods. Eigen allocates in each application.
#include "poisson/factories.hpp"
#include "poisson/matrix/conjugate_gradient.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace weir::poisson {

namespace {

/// The lower triangle. The first diagonal entry of a closed component is raised by a thousandth: with a compatible right-hand side a barely
/// regular factor would suffice, but its last pivot is round-off.
Eigen::SparseMatrix<real> lower_triangle(const Matrix& A, const Components& components) {
    const int n = A.size();
    Eigen::SparseMatrix<real> lower(n, n);
    std::vector<Eigen::Triplet<real>> entries;
    entries.reserve(A.column.size() / 2 + A.diagonal.size());
    std::vector<char> raised(static_cast<std::size_t>(components.closed), 0);
    for (int i = 0; i < n; ++i) {
        const auto row = static_cast<std::size_t>(i);
        real diagonal = A.diagonal[row] > 0 ? A.diagonal[row] : 1;
        const int c = components.closed > 0 ? components.of[row] : -1;
        if (c >= 0 && !raised[static_cast<std::size_t>(c)]) raised[static_cast<std::size_t>(c)] = 1, diagonal *= 1.001;
        entries.emplace_back(i, i, diagonal);
        for (int k = A.start[row]; k < A.start[row + 1]; ++k)
            if (A.column[static_cast<std::size_t>(k)] < i)
                entries.emplace_back(i, A.column[static_cast<std::size_t>(k)], -A.weight[static_cast<std::size_t>(k)]);
    }
    lower.setFromTriplets(entries.begin(), entries.end());
    return lower;
}

class EigenIncompleteCholesky {
public:
    void prepare(const Matrix& A, const Components& components) {
        const auto lower = lower_triangle(A, components);
        nonzeros_ = static_cast<std::size_t>(lower.nonZeros());
        if (A.size() > 0) factor_.compute(lower);
    }
    void apply(const Vector& r, Vector& z) const {
        const auto n = static_cast<Eigen::Index>(r.size());
        Eigen::Map<Eigen::VectorXd>(z.data(), n) = factor_.solve(Eigen::Map<const Eigen::VectorXd>(r.data(), n));
    }
    std::size_t bytes() const { return nonzeros_ * (sizeof(real) + sizeof(int)); }

private:
    Eigen::IncompleteCholesky<real> factor_;
    std::size_t nonzeros_ = 0;
};

}  // namespace

template <int D>
Made<D> make_eigen_iccg(const Options& options) {
    return std::make_unique<ConjugateGradient<D, EigenIncompleteCholesky>>(options);
}

template Made<2> make_eigen_iccg<2>(const Options&);
template Made<3> make_eigen_iccg<3>(const Options&);

}  // namespace weir::poisson
