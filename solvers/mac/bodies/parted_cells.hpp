// Cells divided by a thin solid: it passes between their corners but covers too little of them to close the faces that it crosses. Between
// other cells a face is open only where one of its corners lies outside solids, and all such corners of a cell are connected by edges that
// no solid crosses. So closing the divided cells makes a wall of any thickness watertight.
#pragma once
#include "core/types.hpp"
#include "geometry/solids.hpp"

#include <array>

namespace weir::mac {

/// Returns whether a solid crosses the line between two points outside solids, given their distances to solids. No solid reaches into the
/// balls of these distances; where they do not cover the line, it is bisected. Crossings shorter than a 256th of the line are not detected.
template <int D, class Distance>
bool is_crossed(const Distance& distance, const Vec<D>& a, const Vec<D>& b, real at_a, real at_b, real steepest, int halvings = 8) {
    if (at_a + at_b >= steepest * norm(b - a)) return false;
    const Vec<D> middle = 0.5 * (a + b);
    const real at = distance(middle);
    if (at <= 0) return true;
    if (halvings == 0) return false;
    return is_crossed<D>(distance, a, middle, at_a, at, steepest, halvings - 1) ||
           is_crossed<D>(distance, middle, b, at, at_b, steepest, halvings - 1);
}

/// Distances at the corners of a cell; bit d of a corner's number is its end along axis d.
template <int D>
using Corners = std::array<real, 1 << D>;

template <int D>
Vec<D> corner_of(const Vec<D>& x, const Vec<D>& h, std::size_t corner) {
    Vec<D> c = x;
    for (int d = 0; d < D; ++d)
        if (corner >> d & 1) c[d] += h[d];
    return c;
}

/// Returns whether the corners outside solids form several components, not connected by edges of the cell. x: the cell's lower corner.
template <int D, class Distance>
bool has_parts(const Distance& distance, const Corners<D>& at, const Vec<D>& x, const Vec<D>& h, real steepest) {
    const real least = geometry::touching * *std::min_element(h.begin(), h.end());
    std::array<std::size_t, 1 << D> part;
    for (std::size_t i = 0; i < at.size(); ++i) part[i] = i;
    for (std::size_t i = 0; i < at.size(); ++i)
        for (int d = 0; d < D; ++d) {
            const std::size_t j = i | (std::size_t{1} << d);
            if (j == i || at[i] <= least || at[j] <= least) continue;
            if (is_crossed<D>(distance, corner_of(x, h, i), corner_of(x, h, j), at[i], at[j], steepest)) continue;
            const std::size_t joined = part[i], from = part[j];
            for (std::size_t& p : part)
                if (p == from) p = joined;
        }
    std::size_t first = at.size();
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (at[i] <= least) continue;
        if (first == at.size()) first = i;
        if (part[i] != part[first]) return true;
    }
    return false;
}

/// Returns whether a thin solid divides a cell. The tip of a thick one does not: it fills the face behind it, and does not divide the cell
/// in front.
template <int D, class Distance>
bool is_parted(const Distance& distance, const Corners<D>& at, const Vec<D>& x, const Vec<D>& h, real steepest) {
    if (!has_parts<D>(distance, at, x, h, steepest)) return false;
    for (int d = 0; d < D; ++d)
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
            bool fills = true;
            for (std::size_t i = 0; i < at.size(); ++i) fills = fills && ((i >> d & 1) != end || at[i] <= 0);
            if (!fills) continue;
            Vec<D> before = x;
            before[d] += end == 0 ? h[d] : -h[d];
            Corners<D> there;
            for (std::size_t i = 0; i < there.size(); ++i) there[i] = distance(corner_of(before, h, i));
            if (!has_parts<D>(distance, there, before, h, steepest)) return false;
        }
    return true;
}

}  // namespace weir::mac
