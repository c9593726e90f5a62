#include "poisson/matrix/algebraic_multigrid.hpp"

namespace weir::poisson {

namespace {

constexpr int direct_size = 1500;      // number of unknowns below which a direct solve is faster than further levels
constexpr real slow_coarsening = 0.8;  // a level that keeps more than this part of the unknowns is not used
constexpr real content = 0.25;         // residual reduction after which the K-cycle skips its second direction (Notay 2010)

real row_sum(const Matrix& A, const Vector& x, std::size_t i) {
    real sum = 0;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        sum += A.weight[entry] * x[static_cast<std::size_t>(A.column[entry])];
    }
    return sum;
}

/// One sweep in rising order, from x = 0.
void sweep_up(const Matrix& A, const Vector& b, Vector& x) {
    std::fill(x.begin(), x.end(), 0.0);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = A.diagonal[i] > 0 ? (b[i] + row_sum(A, x, i)) / A.diagonal[i] : 0;
}

/// One sweep in falling order: the transpose of sweep_up, so that the cycle is symmetric.
void sweep_down(const Matrix& A, const Vector& b, Vector& x) {
    for (std::size_t i = x.size(); i-- > 0;)
        if (A.diagonal[i] > 0) x[i] = (b[i] + row_sum(A, x, i)) / A.diagonal[i];
}

}  // namespace

void AlgebraicMultigrid::prepare(const Matrix& A, const Components& components) {
    levels_.clear();
    levels_.emplace_back();
    levels_[0].A = &A;
    while (levels_.back().matrix().size() > direct_size) {
        Level& fine = levels_.back();
        fine.groups = aggregate(fine.matrix());
        if (fine.groups.count > slow_coarsening * fine.matrix().size()) break;
        Level coarse;
        coarse.own = coarsen(fine.matrix(), fine.groups);
        levels_.push_back(std::move(coarse));
    }
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        Level& level = levels_[l];
        const auto n = static_cast<std::size_t>(level.matrix().size());
        for (Vector* v : {&level.r, &level.x, &level.c, &level.v, &level.d, &level.w}) v->assign(n, 0);
    }
    const Matrix& last = levels_.back().matrix();
    if (levels_.size() == 1)
        coarsest_components_ = components;
    else
        ComponentFinder().find(last, coarsest_components_);
    coarsest_ = std::make_unique<SparseCholesky>();
    coarsest_->factor(last, coarsest_components_);
}

void AlgebraicMultigrid::apply(const Vector& r, Vector& z) { cycle(0, r, z); }

/// Smooth, correct from the coarser level, smooth. On the coarsest level: solve.
void AlgebraicMultigrid::cycle(std::size_t l, const Vector& r, Vector& z) {
    if (l + 1 == levels_.size()) {
        Vector& compatible = levels_[l].w;
        compatible = r;
        coarsest_components_.remove_means(compatible);
        coarsest_->solve(compatible, z);
        coarsest_components_.remove_means(z);
        return;
    }
    Level &level = levels_[l], &next = levels_[l + 1];
    const Matrix& A = level.matrix();
    sweep_up(A, r, z);
    residual(A, z, r, level.w);
    std::fill(next.r.begin(), next.r.end(), 0.0);
    for (std::size_t i = 0; i < r.size(); ++i) next.r[static_cast<std::size_t>(level.groups.of[i])] += level.w[i];
    accelerate(l + 1);
    for (std::size_t i = 0; i < r.size(); ++i) z[i] += next.x[static_cast<std::size_t>(level.groups.of[i])];
    sweep_down(A, r, z);
}

/// x ≈ A⁻¹ r on level l by at most two steps of flexible conjugate gradients, each preconditioned by a cycle (Notay 2010, algorithm 3.2).
void AlgebraicMultigrid::accelerate(std::size_t l) {
    Level& level = levels_[l];
    Vector &r = level.r, &x = level.x, &c = level.c, &v = level.v, &d = level.d, &w = level.w;
    const Matrix& A = level.matrix();
    if (l + 1 == levels_.size()) return cycle(l, r, x);
    cycle(l, r, c);
    multiply(A, c, v);
    const real rho1 = dot(c, v), alpha1 = dot(c, r);
    if (!(rho1 > 0)) return std::fill(x.begin(), x.end(), 0.0);
    const real before = dot(r, r);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= alpha1 / rho1 * v[i];
    real first = alpha1 / rho1, second = 0;
    if (dot(r, r) > content * content * before) {
        cycle(l, r, d);
        multiply(A, d, w);
        const real gamma = dot(d, v), beta = dot(d, w), alpha2 = dot(d, r);
        const real rho2 = beta - gamma * gamma / rho1;
        if (rho2 > 0) {
            first -= gamma * alpha2 / (rho1 * rho2);
            second = alpha2 / rho2;
        }
    }
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = first * c[i] + second * d[i];
}

std::size_t AlgebraicMultigrid::bytes() const {
    std::size_t sum = coarsest_ != nullptr ? coarsest_->bytes() : 0;
    for (const Level& level : levels_)
        sum += level.own.bytes() + level.groups.of.capacity() * sizeof(int) + 6 * level.r.capacity() * sizeof(real);
    return sum;
}

}  // namespace weir::poisson
