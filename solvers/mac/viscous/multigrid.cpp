#include "mac/viscous/multigrid.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac::viscous {

namespace {

constexpr std::size_t most_direct = 300;  // unknowns of a coarsest level solved directly: 90,000 entries of a dense factor
constexpr real single_round_off = 1e-6;   // of sums of a few terms in single precision
constexpr int fewest_cells = 2;           // along a halved axis of the coarsest level

/// Roots of the Chebyshev polynomial of degree 2 on [1/8, 1]. Modes that coarse grids do not resolve have eigenvalues of at least 1/12 to
/// 1/8 of the largest; the polynomial is at most 0.43 on the interval.
constexpr real smallest = 0.125;
const std::array<float, 2> omega = [] {
    const real middle = 0.5 * (1 + smallest), half = 0.5 * (1 - smallest) * std::sqrt(0.5);
    return std::array<float, 2>{static_cast<float>(1 / (middle + half)), static_cast<float>(1 / (middle - half))};
}();

/// Axes to halve: those with the smallest cells, up to a factor of 1.5, and enough of them.
template <int D>
std::array<bool, D> axes_to_halve(const Level<D>& level) {
    const auto can_halve = [&](int d) {
        const int n = level.cells[d];
        return n > fewest_cells && (n % 2 == 0 || !level.is_periodic(d));
    };
    real least = infinity;
    for (int d = 0; d < D; ++d)
        if (can_halve(d)) least = std::min(least, level.h[d]);
    std::array<bool, D> halved{};
    for (int d = 0; d < D; ++d) halved[static_cast<std::size_t>(d)] = can_halve(d) && level.h[d] < 1.5 * least;
    return halved;
}

}  // namespace

template <int D>
Multigrid<D>::Multigrid(const Index<D>& cells, const Vec<D>& h, const std::array<Boundary<D>, D>& boundary) {
    levels_.emplace_back(cells, h, boundary);
    for (;;) {
        Level<D>& fine = levels_.back();
        fine.halved = axes_to_halve(fine);
        Index<D> coarse = fine.cells;
        Vec<D> wider = fine.h;
        bool any = false;
        for (int d = 0; d < D; ++d) {
            if (!fine.halved[static_cast<std::size_t>(d)]) continue;
            coarse[d] = (coarse[d] + 1) / 2, wider[d] *= 2, any = true;
        }
        if (!any) break;
        levels_.emplace_back(coarse, wider, boundary);
    }
    const std::size_t n = levels_.back().unknowns();
    if (n > most_direct) return;
    factor_.resize(n * (n + 1) / 2);
    solution_.resize(n);
}

template <int D>
void Multigrid<D>::build() {
    Level<D>& fine = finest();
    fill_ghosts(fine, fine.mass, Ghosts::even);
    for (auto& mu : fine.mu.component) fill_ghosts(fine, mu, {});
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a) {
            const OnNodes<D> on_nodes = across<D>(a, b);
            fill_ghosts(fine, fine.edge(a, b), on_nodes);
        }
    find_inverse(fine);
    find_stiff_edges(fine);
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l) coarsen(levels_[l], levels_[l + 1]);
    if (!factor_.empty()) factor();
}

/// Pre-relaxation starts from zero; the result is in `other`, with its ghosts.
template <int D>
void Multigrid<D>::relax_twice(Level<D>& level, bool from_zero) {
    if (from_zero)
        start(level, omega[0], level.x);
    else
        relax(level, omega[1], level.other, level.x);
    fill_ghosts(level, level.x, Ghosts::velocity);
    relax(level, from_zero ? omega[1] : omega[0], level.x, level.other);
    fill_ghosts(level, level.other, Ghosts::velocity);
}

template <int D>
void Multigrid<D>::cycle(std::size_t l) {
    Level<D>& fine = levels_[l];
    if (l + 1 == levels_.size()) {
        if (!factor_.empty()) return solve_coarsest();
        for (int k = 0; k < 4; ++k) relax_twice(fine, k == 0);
        return;
    }
    relax_twice(fine, true);
    residual(fine, fine.other, fine.x);
    fill_ghosts(fine, fine.x, Ghosts::transpose);
    restrict_faces(fine, fine.x, levels_[l + 1], levels_[l + 1].b);
    cycle(l + 1);
    add_prolonged(levels_[l + 1], levels_[l + 1].other, fine, fine.other);
    fill_ghosts(fine, fine.other, Ghosts::velocity);
    relax_twice(fine, false);
}

/// f(number, a, I) for the unknowns of the coarsest level, in order.
template <int D>
template <class F>
void Multigrid<D>::for_each_coarsest(F&& f) {
    const Level<D>& level = levels_.back();
    std::size_t number = 0;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const Index<D> extent = level.hi[at] - level.lo[at];
        for (std::size_t k = 0; k < product(extent); ++k, ++number) f(number, a, level.lo[at] + index_of<D>(extent, k));
    }
}

/// Cholesky factor of the coarsest matrix, whose columns are its products with unit vectors.
template <int D>
void Multigrid<D>::factor() {
    Level<D>& level = levels_.back();
    const auto entry = [&](std::size_t i, std::size_t j) -> real& { return factor_[i * (i + 1) / 2 + j]; };
    for_each_coarsest([&](std::size_t, int a, const Index<D>& I) { level.x[a](I) = 0; });
    for_each_coarsest([&](std::size_t j, int a, const Index<D>& I) {
        level.x[a](I) = 1;
        fill_ghosts(level, level.x, Ghosts::velocity);
        for_each_coarsest([&](std::size_t i, int b, const Index<D>& J) {
            if (i < j) return;
            float product = 0;
            multiply_row(level, level.x, b, J, 1, &product);
            const bool is_unknown = level.inverse[a](I) != 0 && level.inverse[b](J) != 0;
            entry(i, j) = is_unknown ? product : i == j ? 1 : 0;
        });
        level.x[a](I) = 0;
    });
    for (std::size_t j = 0; j < solution_.size(); ++j) {
        // round-off may leave nothing of a translation of the whole fluid, whose mass is small beside the viscosity
        const real least = single_round_off * entry(j, j);
        for (std::size_t k = 0; k < j; ++k) entry(j, j) -= entry(j, k) * entry(j, k);
        entry(j, j) = std::sqrt(std::max(entry(j, j), least));
        for (std::size_t i = j + 1; i < solution_.size(); ++i) {
            for (std::size_t k = 0; k < j; ++k) entry(i, j) -= entry(i, k) * entry(j, k);
            entry(i, j) /= entry(j, j);
        }
    }
}

template <int D>
void Multigrid<D>::solve_coarsest() {
    Level<D>& level = levels_.back();
    const auto entry = [&](std::size_t i, std::size_t j) { return factor_[i * (i + 1) / 2 + j]; };
    for_each_coarsest([&](std::size_t i, int a, const Index<D>& I) { solution_[i] = level.inverse[a](I) == 0 ? 0 : level.b[a](I); });
    for (std::size_t i = 0; i < solution_.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) solution_[i] -= entry(i, k) * solution_[k];
        solution_[i] /= entry(i, i);
    }
    for (std::size_t i = solution_.size(); i-- > 0;) {
        solution_[i] /= entry(i, i);
        for (std::size_t k = 0; k < i; ++k) solution_[k] -= entry(i, k) * solution_[i];
    }
    for_each_coarsest([&](std::size_t i, int a, const Index<D>& I) {
        level.other[a](I) = level.inverse[a](I) == 0 ? 0 : static_cast<float>(solution_[i]);
    });
    fill_ghosts(level, level.other, Ghosts::velocity);
}

template <int D>
std::size_t Multigrid<D>::bytes() const {
    std::size_t total = (factor_.capacity() + solution_.capacity()) * sizeof(real) + levels_.capacity() * sizeof(Level<D>);
    for (const Level<D>& level : levels_) total += level.bytes();
    return total;
}

template class Multigrid<2>;
template class Multigrid<3>;

}  // namespace weir::mac::viscous
