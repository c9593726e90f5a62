// Connected sets of frozen particles: union-find over all pairs within reach, found through cells.
#include "particles/heat/ice.hpp"

#include <algorithm>
#include <numeric>

namespace weir::particles {

/// Sorted into cells.
template <int D>
void Ice<D>::list_frozen(const Fluid<D>& fluid) {
    frozen_.clear();
    for (int i = 0; i < fluid.count(); ++i)
        if (heat_.frozen(fluid.enthalpy[static_cast<std::size_t>(i)])) frozen_.push_back(i);
    const auto n = frozen_.size();
    parent_.resize(n), cell_.resize(n), sorted_.resize(n);
    std::iota(parent_.begin(), parent_.end(), 0);
    std::fill(start_.begin(), start_.end(), 0);
    for (std::size_t f = 0; f < n; ++f) {
        const Vec<D> x = fluid.position(frozen_[f]);
        std::size_t cell = 0;
        for (int a = D - 1; a >= 0; --a) {
            const int at =
                std::clamp(static_cast<int>((x[a] - domain_.lo[a]) / (domain_.hi[a] - domain_.lo[a]) * cells_[a]), 0, cells_[a] - 1);
            cell = cell * static_cast<std::size_t>(cells_[a]) + static_cast<std::size_t>(at);
        }
        cell_[f] = static_cast<int>(cell);
        ++start_[cell + 1];
    }
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    for (std::size_t f = n; f-- > 0;)
        sorted_[static_cast<std::size_t>(--start_[static_cast<std::size_t>(cell_[f]) + 1])] = static_cast<int>(f);
    // now start_[c + 1] is the start of cell c
}

template <int D>
int Ice<D>::root(int f) {
    auto at = static_cast<std::size_t>(f);
    while (parent_[at] != static_cast<int>(at)) {
        parent_[at] = parent_[static_cast<std::size_t>(parent_[at])];
        at = static_cast<std::size_t>(parent_[at]);
    }
    return static_cast<int>(at);
}

/// The root of a tree is its first particle: pieces and their order follow the state, independent of the search.
template <int D>
void Ice<D>::join_neighbours(const Fluid<D>& fluid) {
    const auto n = static_cast<int>(frozen_.size());
    const auto begin = [&](int c) { return start_[static_cast<std::size_t>(c) + 1]; };
    const auto end = [&](int c) { return static_cast<std::size_t>(c) + 2 < start_.size() ? start_[static_cast<std::size_t>(c) + 2] : n; };
    for (int f = 0; f < n; ++f) {
        const Vec<D> x = fluid.position(frozen_[static_cast<std::size_t>(f)]);
        Index<D> at{};
        for (int a = 0, rest = cell_[static_cast<std::size_t>(f)]; a < D; ++a, rest /= cells_[a - 1]) at[a] = rest % cells_[a];
        const int layers = D == 3 ? 1 : 0;
        for (int dz = -layers; dz <= layers; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const std::array<int, 3> by{dx, dy, dz};
                    int cell = 0;
                    bool inside = true;
                    for (int a = D - 1; a >= 0; --a) {
                        const int to = at[a] + by[static_cast<std::size_t>(a)];
                        inside = inside && to >= 0 && to < cells_[a];
                        cell = cell * cells_[a] + to;
                    }
                    if (!inside) continue;
                    for (int s = begin(cell); s < end(cell); ++s) {
                        const int g = sorted_[static_cast<std::size_t>(s)];
                        if (g >= f) continue;
                        const Vec<D> apart = fluid.position(frozen_[static_cast<std::size_t>(g)]) - x;
                        if (dot(apart, apart) > reach_ * reach_) continue;
                        const int one = root(f), other = root(g);
                        parent_[static_cast<std::size_t>(std::max(one, other))] = std::min(one, other);
                    }
                }
    }
}

template <int D>
void Ice<D>::gather_pieces(const Fluid<D>& fluid) {
    piece_of_.assign(fluid.id.size(), -1);
    pieces_.clear();
    const auto of = [&](std::size_t f) -> int& { return piece_of_[static_cast<std::size_t>(frozen_[f])]; };
    for (std::size_t f = 0; f < frozen_.size(); ++f) {
        const auto first = static_cast<std::size_t>(root(static_cast<int>(f)));
        if (first == f) pieces_.emplace_back(), of(f) = pieces() - 1;
        of(f) = of(first);
        ++pieces_[static_cast<std::size_t>(of(f))].end;
    }
    for (std::size_t p = 1; p < pieces_.size(); ++p) pieces_[p].end += pieces_[p - 1].end;
    for (Piece& piece : pieces_) piece.begin = piece.end;
    members_.resize(frozen_.size()), rest_.resize(frozen_.size());
    for (std::size_t f = frozen_.size(); f-- > 0;)
        members_[static_cast<std::size_t>(--pieces_[static_cast<std::size_t>(of(f))].begin)] = frozen_[f];
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            if (!domain_.walled(a, end) || !heat_.freezing(a, end)) continue;
            for (const int i : frozen_) {
                const real x = fluid.position(i)[a], height = end ? domain_.hi[a] - x : x - domain_.lo[a];
                if (height < wall_reach_) pieces_[static_cast<std::size_t>(piece_of(i))].fixed = true;
            }
        }
}

#define WEIR_INSTANTIATE(D)                                 \
    template void Ice<D>::list_frozen(const Fluid<D>&);     \
    template void Ice<D>::join_neighbours(const Fluid<D>&); \
    template void Ice<D>::gather_pieces(const Fluid<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::particles
