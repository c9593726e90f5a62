// The level set beside solids: the open parts of cells, and φ in closed cells, the mean of the open neighbours, layer by layer, so that the
// contact angle at a solid is 90 degrees.
#include "free_surface/level_set.hpp"

#include <cstring>

namespace weir::free_surface {

/// f(I) for open cells with a closed neighbour, in the order of the grid; also for some cells at the ends of lines without one.
template <int D>
template <class F>
void LevelSet<D>::for_each_open_beside_closed(const std::vector<char>& planes, F&& f) const {
    const Grid<std::uint8_t, D>& closed = closed_;
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    const auto has_closed = [&](std::size_t line) { return std::memchr(&closed[line], 1, n) != nullptr; };
    for (std::size_t line = 0; line < closed.size(); line += n) {
        std::array<const std::uint8_t*, 2 * D> beside{};  // lines of cells next to this one, and itself
        std::size_t count = 0;
        Index<D> I = frame_.index_of(line);
        if (!planes.empty() && planes[static_cast<std::size_t>(I[D - 1])] == 0) continue;
        if (has_closed(line)) beside[count++] = &closed[line];
        for (int d = 1; d < D; ++d)
            for (const int by : {-1, 1})
                if (Index<D> J = I; frame_.step(J, d, by) && has_closed(closed.linear(J))) beside[count++] = &closed(J);
        for (std::size_t i = 0; count > 0 && i < n; ++i) {
            if (closed[line + i]) continue;
            bool found = i == 0 || i + 1 == n || closed[line + i - 1] || closed[line + i + 1];
            for (std::size_t k = 0; k < count; ++k) found = found || beside[k][i];
            I[0] = static_cast<int>(i);
            if (found) f(I);
        }
    }
}

/// Depth of the extrapolation into solids [cells]: the width of the interpolation stencil.
static constexpr int skin_layers = 3;

template <int D>
void LevelSet<D>::set_closed(const Grid<std::uint8_t, D>& closed, const std::array<std::vector<Index<D>>, D>* faces) {
    const bool distributed = closed.store().windowed();
    uncover(closed);
    closed_ = closed;
    if (distributed) {
        find_near();
        refresh(closed_, frame_.periodic(D - 1), wide() + 1);
    }
    find_skin(planes_near(frame_.own().slab, frame_.cells[D - 1], skin_layers, frame_.periodic(D - 1)));
    if (communicator().several()) share_skin(distributed);
    walls_.find(frame_, closed_, skin_, faces, wide() + 1);
}

/// Cells uncovered by a thin solid get the mean distance of both its sides: extrapolation from the wet side alone would create liquid.
template <int D>
void LevelSet<D>::uncover(const Grid<std::uint8_t, D>& closed) {
    if (!walls_.any()) return;
    const bool ring = frame_.periodic(D - 1);
    refresh(phi, ring, ThinWalls<D>::thickest + 1);
    std::vector<std::pair<std::size_t, real>> left;
    for (const Index<D>& I : skin_)
        if (frame_.own().contains(I[D - 1]) && closed(I) == 0)
            if (const real both = walls_.on_both_sides(closed_, phi, I); both > phi(I)) left.emplace_back(phi.linear(I), both);
    for (const auto& [cell, both] : left) phi[cell] = both;
    refresh(phi, ring, wide());
}

template <int D>
real open_part_of_cell(const SolidPlacement<D>& solids, const Index<D>& I) {
    real mean = 0, least = infinity;
    Vec<D> slope{};
    for (unsigned corner = 0; corner < 1U << D; ++corner) {
        Index<D> J = I;
        for (int d = 0; d < D; ++d) J[d] += static_cast<int>(corner >> d & 1U);
        const real distance = solids.corner_distance(J);
        least = std::min(least, distance);
        mean += distance / (1 << D);
        for (int d = 0; d < D; ++d) slope[d] += (corner >> d & 1U ? distance : -distance) / (1 << (D - 1));
    }
    return least >= 0 ? 1 : fraction_below_plane<D>(-mean, -1.0 * slope);
}

template <int D>
void LevelSet<D>::set_open_parts(const SolidPlacement<D>& solids) {
    if (open_part_.empty()) open_part_ = Grid<real, D>(frame_.cells, 1);
    const bool ring = frame_.periodic(D - 1), distributed = closed_.store().windowed();
    if (distributed) open_part_.store().open(wide() + 1, ring);
    for (const CellBox<D>& box : solids.changed())
        for_each_held(open_part_, box.lo, box.hi, [&](const Index<D>& I) {
            if (distributed && (!frame_.own().contains(I[D - 1]) || !solids.holds_corners(I[D - 1]))) return;
            open_part_(I) = open_part_of_cell(solids, I);
        });
    if (distributed) refresh(open_part_, ring, wide() + 1);
}

/// Finds skin_: closed cells beside open ones in these planes (empty: all planes), and further layers behind them.
template <int D>
void LevelSet<D>::find_skin(const std::vector<char>& planes) {
    skin_.clear();
    std::size_t first = 0;
    constexpr std::uint8_t mark = 253;
    Grid<std::uint8_t, D>& seen = layer_;  // free for use here: redistance() recomputes it
    const auto add_neighbours = [&](const Index<D>& I) {
        for_each_beside(frame_, I, [&](const Index<D>& J) {
            if (closed_(J) && seen(J) != mark) seen(J) = mark, skin_.push_back(J);
        });
    };
    for_each_open_beside_closed(planes, add_neighbours);
    skin_end_.assign(1, skin_.size());
    for (int layer = 1; layer < skin_layers; ++layer) {
        const std::size_t last = skin_.size();
        for (; first < last; ++first) add_neighbours(Index<D>(skin_[first]));
        skin_end_.push_back(skin_.size());
    }
    for (const Index<D>& J : skin_) seen(J) = 0;
}

/// In parallel all ranks get the whole skin, in the order of one process, from the parts of each rank's planes (with distributed storage,
/// `alone`).
template <int D>
void LevelSet<D>::share_skin(bool distributed) {
    std::vector<std::size_t> rim, near;
    for_each_open_beside_closed(planes_near(frame_.own().slab, frame_.cells[D - 1], 0, false), [&](const Index<D>& I) {
        bool beside = false;
        for_each_beside(frame_, I, [&](const Index<D>& J) { beside = beside || closed_(J); });
        if (beside) rim.push_back(phi.linear(I));
    });
    for (const Index<D>& I : skin_)
        if (frame_.own().contains(I[D - 1])) near.push_back(phi.linear(I));
    std::sort(near.begin(), near.end());
    if (distributed) rim = of_all_ranks(rim), near = of_all_ranks(near);
    skin_of_ranks_.find(frame_, std::move(rim), near, skin_layers, skin_, skin_end_);
}

static constexpr std::uint8_t continued = 254;  // not a layer of the band

/// Layer by layer, each from layers further out: independent of the order of cells.
template <int D>
void LevelSet<D>::continue_into_solids() {
    if (skin_.empty()) return;
    if (frame_.own().distributed()) return skin_of_ranks_.continue_into(phi, skin_);
    for (const Index<D>& I : skin_) layer_(I) = 0;
    std::size_t first = 0;
    for (const std::size_t last : skin_end_) {
        continue_layer(first, last);
        for (; first < last; ++first) layer_(skin_[first]) = continued;
    }
    for (const Index<D>& I : skin_) layer_(I) = 0;
}

/// The mean of the neighbours that are open or in a previous layer.
template <int D>
void LevelSet<D>::continue_layer(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
        real sum = 0;
        int count = 0;
        for (int d = 0; d < D; ++d) {
            real pair = 0;  // the two sides are added first: mirror symmetric
            for (const int by : {-1, 1}) {
                Index<D> J = skin_[i];
                if (!frame_.step(J, d, by) || (closed_(J) && layer_(J) != continued)) continue;
                pair += phi(J);
                ++count;
            }
            sum += pair;
        }
        if (count > 0) phi(skin_[i]) = sum / count;
    }
}

#define WEIR_INSTANTIATE(D)                                                                                                        \
    template void LevelSet<D>::continue_into_solids();                                                                             \
    template void LevelSet<D>::set_closed(const Grid<std::uint8_t, D>& closed, const std::array<std::vector<Index<D>>, D>* faces); \
    template void LevelSet<D>::set_open_parts(const SolidPlacement<D>& solids);                                                    \
    template real open_part_of_cell<D>(const SolidPlacement<D>&, const Index<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::free_surface
