// The coarsest level of the geometric hierarchy: numbered, factored, solved in double precision.
#include "poisson/hierarchy.hpp"

namespace weir::poisson {

template <int D>
void Hierarchy<D>::build_coarsest() {
    const Level<D>& level = levels_.back();
    const Layout<D>& at = level.at;
    std::vector<int> number(level.cells(), -1);
    coarsest_u_.clear();
    coarsest_r_.clear();
    int next = 0;
    const auto natural = [&](int row, int i) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(at.n[0]) + static_cast<std::size_t>(i);
    };
    for (int q = 0; q < at.planes(); ++q)
        for (int j = 0; j < at.rows_in_plane(); ++j)
            for (int i = 0; i < at.n[0]; ++i) {
                const int row = at.row(q, j), s = at.parity(q, j);
                if (level.fluid[natural(row, i)] == 0) continue;
                number[natural(row, i)] = next++;
                const auto colour = static_cast<std::size_t>((i ^ s) & 1);
                coarsest_u_.push_back(level.u[colour] + at.offset(row) + i / 2);
                coarsest_r_.push_back(level.r[colour] + at.offset(row) + i / 2);
            }
    Matrix A;
    std::vector<std::pair<int, real>> entries;
    const auto add = [&](std::size_t cell, float weight) {
        if (number[cell] < 0 || !(weight > 0)) return;
        for (auto& [column, sum] : entries)
            if (column == number[cell]) {
                sum += weight;
                return;
            }
        entries.emplace_back(number[cell], weight);
    };
    for (int q = 0; q < at.planes(); ++q)
        for (int j = 0; j < at.rows_in_plane(); ++j)
            for (int i = 0; i < at.n[0]; ++i) {
                const int row = at.row(q, j);
                const std::size_t here = natural(row, i);
                if (number[here] < 0) continue;
                entries.clear();
                const int n = at.n[0];
                if (i > 0 || at.periodic[0]) add(natural(row, i > 0 ? i - 1 : n - 1), level.face[0][here]);
                if (i + 1 < n || at.periodic[0])
                    add(natural(row, i + 1 < n ? i + 1 : 0), level.face[0][natural(row, i + 1 < n ? i + 1 : 0)]);
                for (int a = 1; a < D; ++a)
                    for (int side = 0; side < 2; ++side) {
                        const int other = at.neighbour(q, j, a, side);
                        if (other >= 0)
                            add(natural(other, i), level.face[static_cast<std::size_t>(a)][side == 0 ? here : natural(other, i)]);
                    }
                std::sort(entries.begin(), entries.end());
                real diagonal = 0;
                for (const auto& [column, weight] : entries) {
                    A.column.push_back(column);
                    A.weight.push_back(weight);
                    diagonal += weight;
                }
                A.start.push_back(static_cast<int>(A.column.size()));
                A.diagonal.push_back(diagonal + level.zero[here]);
            }
    coarsest_components_ = find_components(A);
    coarsest_.factor(A, coarsest_components_);
    x_.assign(A.diagonal.size(), 0);
    b_.assign(A.diagonal.size(), 0);
}

template <int D>
void Hierarchy<D>::solve_coarsest() {
    for (std::size_t i = 0; i < b_.size(); ++i) b_[i] = *coarsest_r_[i];
    coarsest_components_.remove_means(b_);
    coarsest_.solve(b_, x_);
    coarsest_components_.remove_means(x_);
    for (std::size_t i = 0; i < x_.size(); ++i) *coarsest_u_[i] = static_cast<float>(x_[i]);
}

template void Hierarchy<2>::build_coarsest();
template void Hierarchy<3>::build_coarsest();
template void Hierarchy<2>::solve_coarsest();
template void Hierarchy<3>::solve_coarsest();

}  // namespace weir::poisson
