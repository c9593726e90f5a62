#include "poisson/geometric/phase_cycle.hpp"

#include <algorithm>

namespace weir::poisson {

namespace {

constexpr std::size_t direct_unknowns = 300;  // levels up to this size are solved directly

}  // namespace

SplitRows::SplitRows(const Matrix& A) : start_(A.start), middle_(A.start.begin(), A.start.end() - 1), column_(A.column) {
    for (std::size_t i = 0; i < middle_.size(); ++i)
        while (middle_[i] < start_[i + 1] && static_cast<std::size_t>(column_[static_cast<std::size_t>(middle_[i])]) < i) ++middle_[i];
    weight_.assign(A.weight.begin(), A.weight.end());
}

template <int D>
void PhaseCycle<D>::build(const Natural<D>& problem, const PhaseCells<D>& cells, const std::vector<Level<D>>& plan) {
    levels_.clear();
    CoarseLevel first;
    of_cells_ = join_clusters<D>(cells.unknowns, plan[0].coarsened, cells.clusters, first.unknowns);
    first.A = matrix_of_cells<D>(problem, of_cells_, plan[0].coarsened);
    levels_.push_back(std::move(first));
    for (std::size_t l = 1; l + 1 < plan.size() && levels_.back().A.diagonal.size() > direct_unknowns; ++l) {
        CoarseLevel& fine = levels_.back();
        real floor_here = 0;
        for (std::size_t a = 0; a < D; ++a)
            floor_here = std::max(floor_here, cells.floor[static_cast<int>(a)] * plan[l].plain_weight[a] / plan[0].plain_weight[a]);
        CoarseLevel next;
        fine.groups = join_clusters<D>(fine.unknowns, plan[l].coarsened, clusters_of(fine.A, fine.unknowns, floor_here), next.unknowns);
        next.A = matrix_of<D>(fine.A, fine.unknowns, fine.groups, plan[l].coarsened);
        levels_.push_back(std::move(next));
    }
    for (CoarseLevel& level : levels_) {
        const auto n = level.A.diagonal.size();
        level.x.assign(n, 0), level.b.assign(n, 0), level.inverse.assign(n, 0), level.later.assign(n, 0);
        level.rows = SplitRows(level.A);
        for (std::size_t i = 0; i < n; ++i) level.inverse[i] = level.A.diagonal[i] > 0 ? 1 / level.A.diagonal[i] : 0;
    }
    finder_.find(levels_.back().A, coarsest_components_);
    coarsest_.factor(levels_.back().A, coarsest_components_);
}

template <int D>
void PhaseCycle<D>::solve_coarsest() {
    CoarseLevel& level = levels_.back();
    coarsest_components_.remove_means(level.b);
    coarsest_.solve(level.b, level.x);
    coarsest_components_.remove_means(level.x);
}

/// x += P (cycle of the next level for the restricted residual). r = Σ w (x − x before the upward sweep) over later unknowns, because the
/// upward sweep has solved each row.
template <int D>
void PhaseCycle<D>::correct(std::size_t l) {
    CoarseLevel &level = levels_[l], &next = levels_[l + 1];
    const auto group = [&](std::size_t i) { return static_cast<std::size_t>(level.groups.of[i]); };
    std::fill(next.b.begin(), next.b.end(), 0.0);
    for (std::size_t i = 0; i < level.x.size(); ++i) next.b[group(i)] += level.rows.later(level.x, i) - level.later[i];
    cycle(l + 1);
    for (std::size_t i = 0; i < level.x.size(); ++i) level.x[i] += next.x[group(i)];
}

/// Two corrections on every level: B A then has no eigenvalue above 1, and the half of the weights at most doubles a correction. With one
/// correction on the level below, B A would reach 2, four times the error would be corrected here, and the cycle be indefinite.
template <int D>
void PhaseCycle<D>::cycle(std::size_t l) {
    if (l + 1 == levels_.size()) return solve_coarsest();
    CoarseLevel& level = levels_[l];
    std::fill(level.later.begin(), level.later.end(), 0.0);
    level.sweep_up();
    correct(l);
    level.sweep_down();
    level.sweep_up();
    correct(l);
    level.sweep_down();
}

/// One Gauss-Seidel sweep in rising order; `later` holds the sums over later unknowns.
template <int D>
void PhaseCycle<D>::CoarseLevel::sweep_up() {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = (b[i] + later[i] + rows.earlier(x, i)) * inverse[i];
}

/// One in falling order, its transpose. It leaves the sums over later unknowns, which the next upward sweep reads.
template <int D>
void PhaseCycle<D>::CoarseLevel::sweep_down() {
    for (std::size_t i = x.size(); i-- > 0;) {
        later[i] = rows.later(x, i);
        x[i] = (b[i] + later[i] + rows.earlier(x, i)) * inverse[i];
    }
}

template <int D>
std::size_t PhaseCycle<D>::bytes() const {
    std::size_t sum = of_cells_.of.capacity() * sizeof(int) + coarsest_.bytes() + coarsest_components_.bytes() + finder_.bytes();
    for (const CoarseLevel& level : levels_)
        sum += level.unknowns.bytes() + level.A.bytes() + level.groups.of.capacity() * sizeof(int) + level.rows.bytes() +
               (level.inverse.capacity() + level.x.capacity() + level.b.capacity() + level.later.capacity()) * sizeof(real);
    return sum;
}

template class PhaseCycle<2>;
template class PhaseCycle<3>;

}  // namespace weir::poisson
