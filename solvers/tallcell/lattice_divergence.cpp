// Divergence of the lattice's velocity in the weak form of TallPressure: the flux into each knot, weighted by its share of the rows.
#include "tallcell/pressure.hpp"

#include <algorithm>

namespace weir::tallcell {

template <int D>
typename TallPressure<D>::Sides TallPressure<D>::sides_of(const MacState<D>& state, const Block& block) const {
    Sides sides{};
    for (int h = 0; h < D - 1; ++h) {
        const int axis = layout_.axes[at(h)];
        const Line lower = line(state.u[axis], block.column);
        Line upper = lower;
        upper.first += static_cast<std::size_t>(state.u[axis].stride(axis));  // walls are at rest: zero flux
        if (layout_.periodic[at(h)]) upper = line(state.u[axis], layout_.upper(block.column, h));
        sides.side[at(2 * h)] = {lower, state.u[axis].data(), frame_.inv_h[axis]};
        sides.side[at(2 * h + 1)] = {upper, state.u[axis].data(), -frame_.inv_h[axis]};
    }
    const int x = block.column % layout_.n[0];
    const bool joint = layout_.periodic[0] && (x == 0 || x + block.count == layout_.n[0]);
    sides.side_by_side = layout_.axes[0] == 0 && !joint && !state.solid.any();
    return sides;
}

/// f(knot, flux into its cell over h) for the knots of a block above all elements, where each is a lattice cell.
template <int D>
template <class F>
void TallPressure<D>::inflow_above_elements(const MacState<D>& state, const Block& block, const Sides& sides, F&& f) const {
    const Line vertical = line(state.u[layout_.up], block.column);
    const real inv_h = frame_.inv_h[layout_.up];
    const real* v = state.u[layout_.up].data();
    std::array<int, block_columns> knot{}, end{};
    int row = layout_.rows;
    for (int i = 0; i < block.count; ++i) {
        knot[at(i)] = knots_.start[at(block.column + i)], end[at(i)] = knots_.start[at(block.column + i) + 1];
        while (knot[at(i)] < end[at(i)] && knots_.row[at(knot[at(i)])] < elements_end_) ++knot[at(i)];
        if (knot[at(i)] < end[at(i)]) row = std::min(row, knots_.row[at(knot[at(i)])]);
    }
    std::array<real, at(block_columns)> inflow{};
    for (bool any = true; any && row < layout_.rows; ++row) {
        const real *below = v + vertical(row), *above = v + vertical(row + 1);
#pragma omp simd
        for (int i = 0; i < block.count; ++i) inflow[at(i)] = (below[i] - above[i]) * inv_h;
        for (int s = 0; s < faces(); ++s) {
            const auto& side = sides.side[at(s)];
            const real* values = side.values + side.line(row);
#pragma omp simd
            for (int i = 0; i < block.count; ++i) inflow[at(i)] += side.into * values[i];
        }
        any = false;
        for (int i = 0; i < block.count; ++i) {
            if (knot[at(i)] == end[at(i)]) continue;
            any = true;
            if (knots_.row[at(knot[at(i)])] == row) f(knot[at(i)]++, inflow[at(i)]);
        }
    }
}

template <int D>
void TallPressure<D>::weak_divergence(const MacState<D>& state, std::vector<real>& b) const {
    largest_of_blocks([&](const Block& block) {
        const Sides sides = sides_of(state, block);
        for (int c = block.column; c < block.column + block.count; ++c)
            weak_divergence(state, c, sides.side_by_side ? elements_end_ : layout_.rows, b);
        if (sides.side_by_side) inflow_above_elements(state, block, sides, [&](int knot, real inflow) { b[at(knot)] = inflow; });
        return 0.0;
    });
}

/// The part of a column below row `end`.
template <int D>
void TallPressure<D>::weak_divergence(const MacState<D>& state, int c, int end, std::vector<real>& b) const {
    const Knots& knots = knots_;
    const Line vertical = line(state.u[layout_.up], c);
    const real inv_h = frame_.inv_h[layout_.up];
    for (int i = knots.start[at(c)]; i < knots.start[at(c) + 1] && knots.row[at(i)] < end; ++i) {
        const int row = knots.row[at(i)], length = knots.length[at(i)], first = knots.start[at(c)];
        const int under = i > first ? knots.length[at(i) - 1] : 0;
        const real below = under > 1 ? mean_[at(i) - 1] : flux(state, layout_.up, vertical(row));
        const real above = length > 1 ? mean_[at(i)] : flux(state, layout_.up, vertical(row + 1));
        b[at(i)] = (below - above) * inv_h;
    }
    for (int f = 0; f < faces(); ++f) {
        const bool own_is_lower = f % 2 == 1;
        const int h = f / 2, axis = layout_.axes[at(h)], owner = own_is_lower ? layout_.upper(c, h) : c;
        if (owner < 0) continue;
        const real into = (own_is_lower ? -1 : 1) * frame_.inv_h[axis];
        int next = run_start_[at(h)][at(owner)];
        visit(
            state, h, owner, end,
            [&](std::size_t face, int, const Row& l, const Row& r) {
                const Row& own = own_is_lower ? l : r;
                if (!own.wet) return;
                const real inflow = into * flux(state, axis, face);
                b[at(own.knot)] += (1 - own.share) * inflow;
                if (own.share > 0) b[at(own.knot) + 1] += own.share * inflow;
            },
            [&](const Run& run) {
                const Pair& w = w_[at(h)][at(next++)];
                const int own = own_is_lower ? run.lower : run.upper;
                const auto add = [&](real y, real u) {
                    const real share = (y - knots.row[at(own)]) / knots.length[at(own)], inflow = 0.5 * run.count * into * u;
                    b[at(own)] += (1 - share) * inflow;
                    b[at(own) + 1] += share * inflow;
                };
                add(run.middle() - run.spread(), w.minus);
                add(run.middle() + run.spread(), w.plus);
            });
    }
}

template <int D>
real TallPressure<D>::max_divergence(const MacState<D>& state) const {
    const real own = largest_of_blocks([&](const Block& block) {
        const Sides sides = sides_of(state, block);
        real largest = 0;
        const auto see = [&](real divergence) {
            if (!(std::abs(divergence) <= largest)) largest = std::abs(divergence);
        };
        for (int c = block.column; c < block.column + block.count; ++c)
            see(largest_divergence(state, c, sides.side_by_side ? elements_end_ : layout_.rows));
        if (sides.side_by_side) inflow_above_elements(state, block, sides, [&](int, real inflow) { see(inflow); });
        return largest;
    });
    return largest_of_ranks(frame_.own(), own);
}

/// The cells of a column that are knots, below row `end`.
template <int D>
real TallPressure<D>::largest_divergence(const MacState<D>& state, int c, int end) const {
    const int up = layout_.up;
    const Line vertical = line(state.u[up], c);
    real largest = 0;
    for (int i = knots_.start[at(c)]; i < knots_.start[at(c) + 1] && knots_.row[at(i)] < end; ++i) {
        const int row = knots_.row[at(i)];
        real sum = (flux(state, up, vertical(row + 1)) - flux(state, up, vertical(row))) * frame_.inv_h[up];
        for (int f = 0; f < faces(); ++f) {
            const int owner = f % 2 == 1 ? layout_.upper(c, f / 2) : c;
            if (owner < 0 || layout_.lower(owner, f / 2) < 0) continue;
            const int axis = layout_.axes[at(f / 2)];
            sum += (f % 2 == 1 ? 1 : -1) * frame_.inv_h[axis] * flux(state, axis, line(state.u[axis], owner)(row));
        }
        if (!(std::abs(sum) <= largest)) largest = std::abs(sum);
        if (std::isnan(largest)) break;
    }
    return largest;
}

#define WEIR_INSTANTIATE(D)                                                                                                 \
    template typename TallPressure<D>::Sides TallPressure<D>::sides_of(const MacState<D>& state, const Block& block) const; \
    template void TallPressure<D>::weak_divergence(const MacState<D>& state, std::vector<real>& b) const;                   \
    template real TallPressure<D>::max_divergence(const MacState<D>& state) const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::tallcell
