#include "water/mixing.hpp"

#include <algorithm>
#include <cmath>

namespace weir::water {

using poisson::Cell;

template <int D>
AndersonMixing<D>::AndersonMixing(const Extent<D>& cells) : last_p_(cells), last_residual_(cells) {
    for (Change& change : changes_) change = {Grid<real, D>(cells), Grid<real, D>(cells)};
}

/// Coefficients of the changes that minimize the residual: normal equations by Cholesky's method. A change that is nearly a combination of
/// newer ones gets the coefficient 0.
template <int D>
auto AndersonMixing<D>::weights(const Grid<real, D>& residual, const Grid<Cell, D>& cells) const -> Weights {
    constexpr real dependent = 1e-10;
    const int n = std::min(count_, depth);
    const auto change = [&](int i) -> const Grid<real, D>& {
        return changes_[static_cast<std::size_t>((count_ - 1 - i) % depth)].residual;
    };
    const auto product = [&](const Grid<real, D>& p, const Grid<real, D>& q) {
        return sum_over(cells.extent(), [&](const Index<D>& I) { return cells(I) == Cell::fluid ? p(I) * q(I) : 0; });
    };
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(i * depth + j); };
    std::array<real, depth * depth> L{};
    Weights x{};
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j <= i; ++j) {
            real sum = product(change(i), change(j));
            const real whole = sum;
            for (int k = 0; k < j; ++k) sum -= L[at(i, k)] * L[at(j, k)];
            if (i == j)
                L[at(i, i)] = sum > dependent * whole ? std::sqrt(sum) : 0;
            else
                L[at(i, j)] = L[at(j, j)] > 0 ? sum / L[at(j, j)] : 0;
        }
        real sum = product(change(i), residual);
        for (int k = 0; k < i; ++k) sum -= L[at(i, k)] * x[static_cast<std::size_t>(k)];
        x[static_cast<std::size_t>(i)] = L[at(i, i)] > 0 ? sum / L[at(i, i)] : 0;
    }
    for (int i = n - 1; i >= 0; --i) {
        real& xi = x[static_cast<std::size_t>(i)];
        for (int k = i + 1; k < n; ++k) xi -= L[at(k, i)] * x[static_cast<std::size_t>(k)];
        xi = L[at(i, i)] > 0 ? xi / L[at(i, i)] : 0;
    }
    return x;
}

template <int D>
void AndersonMixing<D>::next(Grid<real, D>& p, const Grid<real, D>& residual, const Grid<Cell, D>& cells) {
    if (any_) {
        Change& newest = changes_[static_cast<std::size_t>(count_ % depth)];
        for_each_cell(cells.extent(), [&](const Index<D>& I) {
            newest.p(I) = p(I) - last_p_(I);
            newest.residual(I) = residual(I) - last_residual_(I);
        });
        ++count_;
    }
    any_ = true;
    const Weights x = weights(residual, cells);
    for_each_cell(cells.extent(), [&](const Index<D>& I) {
        last_p_(I) = p(I), last_residual_(I) = residual(I);
        if (cells(I) != Cell::fluid) return;
        p(I) += residual(I);
        for (int i = 0; i < std::min(count_, depth); ++i) {
            const Change& change = changes_[static_cast<std::size_t>((count_ - 1 - i) % depth)];
            p(I) -= x[static_cast<std::size_t>(i)] * (change.p(I) + change.residual(I));
        }
    });
}

template <int D>
std::size_t AndersonMixing<D>::bytes() const {
    std::size_t total = last_p_.bytes() + last_residual_.bytes();
    for (const Change& change : changes_) total += change.p.bytes() + change.residual.bytes();
    return total;
}

template class AndersonMixing<2>;
template class AndersonMixing<3>;

}  // namespace weir::water
