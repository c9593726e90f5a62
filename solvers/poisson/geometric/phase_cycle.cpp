#include "poisson/geometric/phase_cycle.hpp"

#include <algorithm>

namespace weir::poisson {

namespace {

constexpr std::size_t direct_unknowns = 300;  // levels up to this size are solved directly

/// The matrix of weights between unknowns, given pair by pair in any order, and of couplings to p = 0. pairs(f) calls f(i, j, w), each time
/// in the same order; weights of one pair are added.
template <class Pairs>
Matrix assemble(const Vector& zero, const Pairs& pairs) {
    const std::size_t n = zero.size();
    std::vector<int> end(n + 1, 0);
    pairs([&](int i, int j, real) { ++end[static_cast<std::size_t>(i) + 1], ++end[static_cast<std::size_t>(j) + 1]; });
    for (std::size_t i = 0; i < n; ++i) end[i + 1] += end[i];
    std::vector<int> column(static_cast<std::size_t>(end[n]));
    Vector weight(column.size());
    std::vector<int> next(end.begin(), end.end() - 1);
    const auto place = [&](int i, int j, real w) {
        const auto k = static_cast<std::size_t>(next[static_cast<std::size_t>(i)]++);
        column[k] = j, weight[k] = w;
    };
    pairs([&](int i, int j, real w) { place(i, j, w), place(j, i, w); });
    Matrix A;
    A.start.reserve(n + 1), A.diagonal.reserve(n);
    std::vector<int> seen(n, -1);  // entry of a column in the present row
    for (std::size_t i = 0; i < n; ++i) {
        const int begin = A.start.back();
        for (auto k = static_cast<std::size_t>(end[i]); k < static_cast<std::size_t>(end[i + 1]); ++k) {
            int& entry = seen[static_cast<std::size_t>(column[k])];
            if (entry < begin) {
                entry = static_cast<int>(A.column.size());
                A.column.push_back(column[k]), A.weight.push_back(0);
            }
            A.weight[static_cast<std::size_t>(entry)] += weight[k];
        }
        sort_last_row(A);
        real diagonal = 0;
        for (auto k = static_cast<std::size_t>(begin); k < A.column.size(); ++k) diagonal += A.weight[k];
        A.diagonal.push_back(diagonal + zero[i]);
        A.start.push_back(static_cast<int>(A.column.size()));
    }
    return A;
}

/// f(cell, axis, weight, other): each open face of positive weight between fluid cells once; other = −1: a face to p = 0.
template <int D, class F>
void for_each_open_face(const Natural<D>& problem, F&& f) {
    constexpr auto fluid = static_cast<std::uint8_t>(Cell::fluid), air = static_cast<std::uint8_t>(Cell::air);
    const int n = problem.extent()[0];
    for (int q = 0; q < problem.planes(); ++q)
        for (int j = 0; j < problem.rows_in_plane(); ++j)
            for (int a = 0; a < D; ++a)
                for (int side = 0; side < 2; ++side) {
                    const int row = problem.row(q, j), beside = a == 0 ? row : problem.neighbour(q, j, a, side);
                    const auto* c = problem.cells(row);
                    const auto* other = a == 0 ? c + (side == 0 ? -1 : 1) : problem.cells(beside);
                    const bool up = side == 1;
                    const real* w = problem.faces(a, q + (a == D - 1 && up), j + (a > 0 && a != D - 1 && up)) + (a == 0 && up ? 1 : 0);
                    for (int i = 0; i < n; ++i) {
                        if (c[i] != fluid || !(w[i] > 0)) continue;
                        if (other[i] == air) f(row * n + i, a, w[i], -1);
                        if (other[i] != fluid || up) continue;
                        f(row * n + i, a, w[i], a == 0 ? row * n + (i > 0 ? i - 1 : n - 1) : beside * n + i);
                    }
                }
}

real row_sum(const Matrix& A, const Vector& x, std::size_t i) {
    real sum = 0;
    for (auto k = static_cast<std::size_t>(A.start[i]); k < static_cast<std::size_t>(A.start[i + 1]); ++k)
        sum += A.weight[k] * x[static_cast<std::size_t>(A.column[k])];
    return sum;
}

/// One Gauss-Seidel sweep in rising order, and one in falling order, its transpose.
void sweep_up(const Matrix& A, const Vector& inverse, const Vector& b, Vector& x) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = (b[i] + row_sum(A, x, i)) * inverse[i];
}
void sweep_down(const Matrix& A, const Vector& inverse, const Vector& b, Vector& x) {
    for (std::size_t i = x.size(); i-- > 0;) x[i] = (b[i] + row_sum(A, x, i)) * inverse[i];
}

/// The factor of a weight between unknowns of different aggregates: a half, or 1 between boxes along an axis that is not coarsened.
template <int D>
real weight_factor(const PhaseUnknowns<D>& at, const std::array<bool, D>& halved, int i, int j) {
    const int apart = std::abs(at.box[static_cast<std::size_t>(i)] - at.box[static_cast<std::size_t>(j)]);
    int stride = 1;
    for (int a = 0; a < D; ++a) {
        const bool along = apart == stride || (at.boxes[a] > 2 && apart == (at.boxes[a] - 1) * stride);
        if (along && at.boxes[a] > 1 && !halved[static_cast<std::size_t>(a)]) return 1;
        stride *= at.boxes[a];
    }
    return 0.5;
}

int group_of(const Aggregation& groups, int i) { return groups.of[static_cast<std::size_t>(i)]; }

}  // namespace

template <int D>
void PhaseCycle<D>::build_first(const Natural<D>& problem, const LightComponents& light, const Level<D>& finest) {
    CoarseLevel first;
    of_cells_ = join_by_phase<D>(unknown_cells<D>(problem, light), finest.coarsened, light, first.unknowns);
    Vector zero(static_cast<std::size_t>(of_cells_.count), 0);
    const real scale = zero_scale(1);
    for_each_open_face(problem, [&](int cell, int, real w, int other) {
        if (other < 0) zero[static_cast<std::size_t>(group_of(of_cells_, cell))] += scale * w;
    });
    first.A = assemble(zero, [&](const auto& f) {
        for_each_open_face(problem, [&](int cell, int axis, real w, int other) {
            if (other < 0) return;
            const int i = group_of(of_cells_, cell), j = group_of(of_cells_, other);
            if (i != j) f(i, j, finest.coarsened[static_cast<std::size_t>(axis)] ? 0.5 * w : w);
        });
    });
    levels_.push_back(std::move(first));
}

template <int D>
typename PhaseCycle<D>::CoarseLevel PhaseCycle<D>::below(CoarseLevel& fine, const LightComponents& light, const Level<D>& plan) const {
    CoarseLevel coarse;
    fine.groups = join_by_phase<D>(fine.unknowns, plan.coarsened, light, coarse.unknowns);
    const Matrix& A = fine.A;
    Vector zero(static_cast<std::size_t>(fine.groups.count), 0);
    const real scale = zero_scale(fine.unknowns.width);
    for (std::size_t i = 0; i < fine.groups.of.size(); ++i) {
        real weights = 0;  // in the order of the diagonal: the difference is exactly zero without a face to p = 0
        for (auto k = static_cast<std::size_t>(A.start[i]); k < static_cast<std::size_t>(A.start[i + 1]); ++k) weights += A.weight[k];
        zero[static_cast<std::size_t>(fine.groups.of[i])] += scale * (A.diagonal[i] - weights);
    }
    coarse.A = assemble(zero, [&](const auto& f) {
        for (int i = 0; i < A.size(); ++i)
            for (int k = A.start[static_cast<std::size_t>(i)]; k < A.start[static_cast<std::size_t>(i) + 1]; ++k) {
                const int j = A.column[static_cast<std::size_t>(k)];
                const int p = group_of(fine.groups, i), q = group_of(fine.groups, j);
                if (j > i && p != q) f(p, q, weight_factor<D>(fine.unknowns, plan.coarsened, i, j) * A.weight[static_cast<std::size_t>(k)]);
            }
    });
    return coarse;
}

template <int D>
void PhaseCycle<D>::build(const Natural<D>& problem, const LightComponents& light, const std::vector<Level<D>>& plan) {
    levels_.clear();
    build_first(problem, light, plan.front());
    for (std::size_t l = 1; l + 1 < plan.size() && levels_.back().A.diagonal.size() > direct_unknowns; ++l) {
        CoarseLevel next = below(levels_.back(), light, plan[l]);
        levels_.push_back(std::move(next));
    }
    for (CoarseLevel& level : levels_) {
        const auto n = level.A.diagonal.size();
        level.x.assign(n, 0), level.b.assign(n, 0), level.inverse.assign(n, 0);
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

/// x += P (cycle of the next level for the restricted residual).
template <int D>
void PhaseCycle<D>::correct(std::size_t l) {
    CoarseLevel &level = levels_[l], &next = levels_[l + 1];
    const auto group = [&](std::size_t i) { return static_cast<std::size_t>(level.groups.of[i]); };
    std::fill(next.b.begin(), next.b.end(), 0.0);
    for (std::size_t i = 0; i < level.x.size(); ++i)
        next.b[group(i)] += level.b[i] - level.A.diagonal[i] * level.x[i] + row_sum(level.A, level.x, i);
    cycle(l + 1);
    for (std::size_t i = 0; i < level.x.size(); ++i) level.x[i] += next.x[group(i)];
}

/// Two corrections on every level: B A then has no eigenvalue above 1, and the half of the weights at most doubles a correction. With one
/// correction on the level below, B A would reach 2, four times the error would be corrected here, and the cycle be indefinite.
template <int D>
void PhaseCycle<D>::cycle(std::size_t l) {
    if (l + 1 == levels_.size()) return solve_coarsest();
    CoarseLevel& level = levels_[l];
    std::fill(level.x.begin(), level.x.end(), 0.0);
    sweep_up(level.A, level.inverse, level.b, level.x);
    correct(l);
    sweep_down(level.A, level.inverse, level.b, level.x);
    sweep_up(level.A, level.inverse, level.b, level.x);
    correct(l);
    sweep_down(level.A, level.inverse, level.b, level.x);
}

template <int D>
std::size_t PhaseCycle<D>::bytes() const {
    std::size_t sum = of_cells_.of.capacity() * sizeof(int) + coarsest_.bytes() + coarsest_components_.bytes() + finder_.bytes();
    for (const CoarseLevel& level : levels_)
        sum += level.unknowns.bytes() + level.A.bytes() + level.groups.of.capacity() * sizeof(int) +
               (level.inverse.capacity() + level.x.capacity() + level.b.capacity()) * sizeof(real);
    return sum;
}

template class PhaseCycle<2>;
template class PhaseCycle<3>;

}  // namespace weir::poisson
