#include "two_phase/level_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace weir::two_phase {

namespace {

constexpr int reach = 2;  // cells

/// Fractions of full and empty cells depart from 1 and 0 by what the pressure's tolerance leaves of the divergence. A cut of this volume is
/// too small to be drawn: it is 1.4e-3 cells wide (2D).
constexpr real invisible = 1e-6;
bool is_bare(real fraction) { return fraction <= invisible; }
bool is_filled(real fraction) { return fraction >= 1 - invisible; }
bool is_cut(real fraction) { return !is_bare(fraction) && !is_filled(fraction); }

/// Distance from x to the part of a plane within its cell; x is relative to the cell's lower corner, in cells. The closest point y of the
/// plane in the cell minimizes Σ h_d² (x_d − y_d)² with m·y = α and 0 ≤ y_d ≤ 1: y_d = clamp(x_d − λ m_d/h_d², 0, 1), and m·y falls with
/// the multiplier λ, linearly between the values at which a component meets an end.
template <int D>
real distance_to_cut(const Plane<D>& plane, const Vec<D>& h, const Vec<D>& x) {
    const auto point = [&](real lambda) {
        Vec<D> y;
        for (int d = 0; d < D; ++d) y[d] = std::clamp(x[d] - lambda * plane.m[d] / (h[d] * h[d]), 0.0, 1.0);
        return y;
    };
    std::array<real, 2 * D> ends{};  // ascending: multipliers at which a component begins or ceases to change
    std::size_t count = 0;
    for (int d = 0; d < D; ++d)
        for (const real end : {0.0, 1.0}) {
            if (plane.m[d] == 0) continue;
            std::size_t i = count++;
            const real lambda = (x[d] - end) * h[d] * h[d] / plane.m[d];
            for (; i > 0 && ends[i - 1] > lambda; --i) ends[i] = ends[i - 1];
            ends[i] = lambda;
        }
    real low = ends[0], above = dot(plane.m, point(low)) - plane.alpha;
    Vec<D> y = point(low);
    for (std::size_t i = 1; i < count && above > 0; ++i) {
        const real high = ends[i], below = dot(plane.m, point(high)) - plane.alpha;
        const real part = below < 0 ? above / (above - below) : 1;
        y = point(low + part * (high - low));
        low = high, above = below;
    }
    Vec<D> apart;
    for (int d = 0; d < D; ++d) apart[d] = h[d] * (x[d] - y[d]);
    return norm(apart);
}

/// Distance from the middle of cell I to the faces between filled and bare cells along the axes.
template <int D>
real distance_to_faces(const Interface<D>& s, const Index<D>& I) {
    real least = infinity;
    for (int d = 0; d < D; ++d)
        for (const int side : {-1, 1})
            for (int k = 1; k <= reach; ++k) {
                Index<D> J = I, K = I;
                J[d] += side * (k - 1), K[d] += side * k;
                const real f = s.padded(J), g = s.padded(K);
                if ((is_filled(f) && is_bare(g)) || (is_bare(f) && is_filled(g))) least = std::min(least, s.h[d] * (k - 0.5));
            }
    return least;
}

template <int D>
bool is_within(const Index<D>& I, const Index<D>& extent) {
    for (int d = 0; d < D; ++d)
        if (I[d] < 0 || I[d] >= extent[d]) return false;
    return true;
}

/// A cut cell and its plane.
template <int D>
struct Cut {
    Index<D> cell;
    Plane<D> plane;
};

/// The cut cells of this rank by their index along the slowest axis, from -reach; ghost cells of that width included.
template <int D>
std::vector<std::vector<Cut<D>>> find_cuts(const Interface<D>& s, const Extent<D>& extent) {
    const Strides<D> stride = strides_of(s.padded);
    std::vector<std::vector<Cut<D>>> cuts(static_cast<std::size_t>(extent[D - 1] + 2 * reach));
    for_each_in(Index<D>::constant(-reach), extent.wider(reach) + Index<D>::constant(reach), [&](const Index<D>& I) {
        if (is_cut(s.padded(I))) cuts[static_cast<std::size_t>(I[D - 1] + reach)].push_back({I, plane_at<D>(s.padded.at(I), stride)});
    });
    return cuts;
}

/// f(I) for the cells of the plane `outer` within `reach` of a cell along the other axes.
template <int D, class F>
void for_each_near(const Index<D>& cell, int outer, const Index<D>& extent, F&& f) {
    constexpr int width = 2 * reach + 1;
    for (int code = 0; code < (D == 2 ? width : width * width); ++code) {
        Index<D> I = cell;
        I[D - 1] = outer;
        for (int d = 0, rest = code; d + 1 < D; ++d, rest /= width) I[d] += rest % width - reach;
        if (is_within(I, extent)) f(I);
    }
}

}  // namespace

template <int D>
void find_distance(const Interface<D>& s, Grid<real, D>& phi) {
    const Extent<D>& extent = phi.extent();
    const real farthest = reach * *std::min_element(s.h.begin(), s.h.end());
    const Vec<D> middle = Vec<D>::constant(0.5);
    for_each_cell(phi.extent(), [&](const Index<D>& I) { phi(I) = std::min(farthest, distance_to_faces(s, I)); });
    const auto cuts = find_cuts(s, extent);
    for_each_plane(phi.extent(), [&](int outer) {  // each plane takes the cuts of its neighbours: no two threads write to one cell
        for (int near = outer; near <= outer + 2 * reach; ++near)
            for (const Cut<D>& cut : cuts[static_cast<std::size_t>(near)])
                for_each_near(cut.cell, outer, extent, [&](const Index<D>& I) {
                    phi(I) = std::min(phi(I), distance_to_cut(cut.plane, s.h, middle - to_vec(cut.cell - I)));
                });
    });
    for_each_cell(phi.extent(), [&](const Index<D>& I) {
        if (is_filled(s.padded(I))) phi(I) = -phi(I);
    });
    for (const auto& plane : cuts)
        for (const Cut<D>& cut : plane)
            if (is_within(cut.cell, extent) && extent.own.contains(cut.cell[D - 1]) && dot(cut.plane.m, middle) < cut.plane.alpha)
                phi(cut.cell) = -phi(cut.cell);
}

template void find_distance(const Interface<2>&, Grid<real, 2>&);
template void find_distance(const Interface<3>&, Grid<real, 3>&);

}  // namespace weir::two_phase
