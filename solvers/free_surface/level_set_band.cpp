// The band of the level set: the cells beside the surface, found by changes of sign of φ, and further layers of neighbours (Adalsteinsson &
// Sethian 1995).
#include "free_surface/level_set.hpp"
#include "free_surface/marker_lanes.hpp"

#include <cstring>

namespace weir::free_surface {

template <int D>
void LevelSet<D>::find_inside() {
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    for_each_line(frame_.cells, [&](const Index<D>&, std::size_t at) {
        const real* from = phi.data() + at;
        std::uint8_t* to = inside_.data() + at;
        std::size_t i = 0;
        for (; i + marker_lanes <= n; i += marker_lanes) {
            const auto below = __builtin_convertvector(simd::load<Lanes>(from + i) < Lanes{}, LaneBytes);
            const LaneBytes flag = below & 1;
            std::memcpy(to + i, &flag, sizeof flag);
        }
        for (; i < n; ++i) to[i] = from[i] < 0;
    });
}

/// In parallel, the planes in which this rank finds the band.
template <int D>
void LevelSet<D>::find_near() {
    if (!frame_.own().distributed() || !near_.empty()) return;
    const bool ring = frame_.periodic(D - 1);
    near_ = planes_near(frame_.own().slab, frame_.cells[D - 1], wide(), ring);
    for (auto* bytes : {&layer_, &inside_, &closed_}) bytes->store().open(wide() + 1, ring);
}

/// Marks layer 1: the cells with a neighbour on the other side of the surface.
template <int D>
void LevelSet<D>::find_surface() {
    find_near();
    find_inside();
    refresh(inside_, frame_.periodic(D - 1), wide() + 1);
    for_each_line(replicated<D>(frame_.cells), [&](const Index<D>& first, std::size_t at) {
        if (is_near(first[D - 1])) mark_changes_of_sign(first, at);
    });
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    for (std::size_t line = 0; line < layer_.size(); line += n) {
        Index<D> I = frame_.index_of(line);
        if (!is_near(I[D - 1])) continue;
        std::uint8_t *mark = layer_.data() + line, *end = mark + n;
        for (auto* at = mark; (at = static_cast<std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)))) != nullptr; ++at) {
            I[0] = static_cast<int>(at - mark);
            if (!(sees_walls(I) ? crosses_on_this_side(I) : crosses_in_liquid(I))) *at = 0;
        }
    }
}

/// Collects its cells, in the order of the grid.
template <int D>
void LevelSet<D>::collect_surface() {
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    band_.clear();
    for (std::size_t line = 0; line < layer_.size(); line += n) {
        Index<D> I = frame_.index_of(line);
        if (!is_near(I[D - 1])) continue;
        const std::uint8_t *mark = layer_.data() + line, *end = mark + n;
        for (auto* at = mark; (at = static_cast<const std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)))) != nullptr;
             ++at) {
            I[0] = static_cast<int>(at - mark);
            band_.push_back(I);
        }
    }
    layer_start_[0] = 0;
    layer_start_[1] = band_.size();
}

/// Marks the cells of the line at `at` that have a neighbour of the other sign.
template <int D>
void LevelSet<D>::mark_changes_of_sign(const Index<D>& first, std::size_t at) {
    const int n = frame_.cells[0];
    const std::uint8_t* line = inside_.data() + at;
    std::uint8_t* mark = layer_.data() + at;
    mark[0] = frame_.periodic(0) ? line[0] ^ line[n - 1] : 0;
    for (int i = 1; i < n; ++i) mark[i] = line[i] ^ line[i - 1];
    for (int i = 0; i + 1 < n; ++i) mark[i] = static_cast<std::uint8_t>(mark[i] | (line[i] ^ line[i + 1]));
    if (frame_.periodic(0)) mark[n - 1] = static_cast<std::uint8_t>(mark[n - 1] | (line[0] ^ line[n - 1]));
    for (int d = 1; d < D; ++d)
        for (const int by : {-1, 1}) {
            Index<D> J = first;
            if (!frame_.step(J, d, by)) continue;
            const std::uint8_t* other = inside_.data() + inside_.linear(J);
            for (int i = 0; i < n; ++i) mark[i] = static_cast<std::uint8_t>(mark[i] | (line[i] ^ other[i]));
        }
}

/// A change of sign between two closed cells is not a surface.
template <int D>
bool LevelSet<D>::crosses_in_liquid(const Index<D>& I) const {
    if (closed_.empty() || !closed_(I)) return true;
    if (walls_.is_between(I)) return false;  // the open cells beside it use the values of their own side
    for (int d = 0; d < D; ++d)
        for (const int by : {-1, 1}) {
            Index<D> J = I;
            if (frame_.step(J, d, by) && !closed_(J) && inside_(J) != inside_(I)) return true;
        }
    return false;
}

/// Beside a thin wall: the surface passes an open cell where φ changes sign towards a neighbour connected by an open face.
template <int D>
bool LevelSet<D>::crosses_on_this_side(const Index<D>& I) const {
    for (int d = 0; d < D; ++d)
        for (const int by : {-1, 1})
            if (Index<D> J = I; walls_.passes(closed_, I, d, by, J) && inside_(J) != inside_(I)) return true;
    return false;
}

/// Returns whether the band grows from cell I to its neighbour: into a thin wall, but not through it.
template <int D>
bool LevelSet<D>::joins(const Index<D>& I, int axis, int by) const {
    if (!walls_.is_near(I)) return true;
    Index<D> J = I;
    const bool passes = walls_.passes(closed_, I, axis, by, J);  // whether J is open, without a closed face between
    return closed_(J) != 0 || (passes && !walls_.is_between(I));
}

/// Layers 2 .. layers_: neighbours of the previous layer.
template <int D>
void LevelSet<D>::join_layers() {
    for (int layer = 2; layer <= layers_; ++layer) {
        const std::size_t from = layer_begin(layer - 1), to = layer_end(layer - 1);
        for (std::size_t i = from; i < to; ++i) {
            for (int d = 0; d < D; ++d)
                for (const int by : {-1, 1}) {
                    Index<D> J = band_[i];
                    if (!frame_.step(J, d, by) || !is_near(J[D - 1]) || layer_(J) != 0 || !joins(band_[i], d, by)) continue;
                    layer_(J) = static_cast<std::uint8_t>(layer);
                    band_.push_back(J);
                }
        }
        layer_start_[static_cast<std::size_t>(layer)] = band_.size();
    }
    find_own();
}

#define WEIR_INSTANTIATE(D)                       \
    template void LevelSet<D>::find_inside();     \
    template void LevelSet<D>::find_near();       \
    template void LevelSet<D>::find_surface();    \
    template void LevelSet<D>::collect_surface(); \
    template void LevelSet<D>::join_layers();
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::free_surface
