// The coarsest level of the geometric hierarchy: factored and solved in double precision. Every cell is an unknown; dry cells have a row of
// their own. So the pattern, and CHOLMOD's analysis, depends on the level but not on the fluid.
#include "poisson/geometric/hierarchy.hpp"

namespace weir::poisson {

namespace {

/// A matrix row with ascending columns; two cells around a periodic axis are neighbours twice, and their weights add.
template <int D>
class RowEntries {
public:
    void add(int column, real weight) {
        std::size_t at = count_;
        while (at > 0 && entry_[at - 1].first > column) --at;
        if (at > 0 && entry_[at - 1].first == column) {
            entry_[at - 1].second += weight;
            return;
        }
        for (std::size_t k = count_++; k > at; --k) entry_[k] = entry_[k - 1];
        entry_[at] = {column, weight};
    }
    /// Appends the row; `zero` is the weight of the cell's coupling to p = 0.
    void append_to(Matrix& A, real zero) const {
        real diagonal = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            A.column.push_back(entry_[k].first);
            A.weight.push_back(entry_[k].second);
            diagonal += entry_[k].second;
        }
        A.start.push_back(static_cast<int>(A.column.size()));
        A.diagonal.push_back(diagonal + zero);
    }

private:
    std::array<std::pair<int, real>, 2 * D> entry_;
    std::size_t count_ = 0;
};

/// f(q, j, i, cell) for every cell of a level, in natural order.
template <int D, class F>
void for_each_cell_of(const Layout<D>& at, F&& f) {
    std::size_t cell = 0;
    for (int q = 0; q < at.planes(); ++q)
        for (int j = 0; j < at.rows_in_plane(); ++j)
            for (int i = 0; i < at.n[0]; ++i) f(q, j, i, cell++);
}

}  // namespace

template <int D>
void Hierarchy<D>::build_coarsest() {
    const Level<D>& level = levels_.back();
    const Layout<D>& at = level.at;
    const int n = at.n[0];
    const auto natural = [&](int row, int i) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(i);
    };
    Matrix& A = coarsest_matrix_;
    A.start.assign(1, 0);
    A.column.clear(), A.weight.clear(), A.diagonal.clear();
    for_each_cell_of(at, [&](int q, int j, int i, std::size_t here) {
        RowEntries<D> row;
        const auto add = [&](std::size_t other, float weight) {
            const bool joined = level.fluid[here] != 0 && level.fluid[other] != 0 && weight > 0;
            row.add(static_cast<int>(other), joined ? weight : 0);
        };
        const int own = at.row(q, j), below = i > 0 ? i - 1 : n - 1, above = i + 1 < n ? i + 1 : 0;
        if (i > 0 || at.periodic[0]) add(natural(own, below), level.face[0][here]);
        if (i + 1 < n || at.periodic[0]) add(natural(own, above), level.face[0][natural(own, above)]);
        for (int a = 1; a < D; ++a)
            for (int side = 0; side < 2; ++side) {
                const int beside = at.neighbour(q, j, a, side);
                if (beside >= 0) add(natural(beside, i), level.face[static_cast<std::size_t>(a)][side == 0 ? here : natural(beside, i)]);
            }
        row.append_to(A, level.fluid[here] != 0 ? level.zero[here] : 1);
    });
    finder_.find(A, coarsest_components_);
    coarsest_.factor(A, coarsest_components_);
    x_.assign(A.diagonal.size(), 0);
    b_.assign(A.diagonal.size(), 0);
}

template <int D>
void Hierarchy<D>::solve_coarsest() {
    Level<D>& level = levels_.back();
    const Layout<D>& at = level.at;
    const auto entry = [&](const Coloured<float>& vector, int q, int j, int i) -> float& {
        return vector[static_cast<std::size_t>((i ^ at.parity(q, j)) & 1)][at.offset(at.row(q, j)) + i / 2];
    };
    for_each_cell_of(at, [&](int q, int j, int i, std::size_t cell) { b_[cell] = level.fluid[cell] != 0 ? entry(level.r, q, j, i) : 0; });
    coarsest_components_.remove_means(b_);
    coarsest_.solve(b_, x_);
    coarsest_components_.remove_means(x_);
    for_each_cell_of(at, [&](int q, int j, int i, std::size_t cell) {
        if (level.fluid[cell] != 0) entry(level.u, q, j, i) = static_cast<float>(x_[cell]);
    });
}

template void Hierarchy<2>::build_coarsest();
template void Hierarchy<3>::build_coarsest();
template void Hierarchy<2>::solve_coarsest();
template void Hierarchy<3>::solve_coarsest();

}  // namespace weir::poisson
