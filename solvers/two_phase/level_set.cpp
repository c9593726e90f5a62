#include "two_phase/level_set.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

namespace {

constexpr int reach = 2;  // cells

/// Distance from x to the part of a plane within its cell; x is relative to the cell's lower corner, in cells. The foot on the plane is
/// moved to the closest point of the cell.
template <int D>
real distance_to_cut(const Plane<D>& plane, const Vec<D>& h, const Vec<D>& x) {
    Vec<D> n;  // of the plane m·x = alpha in physical space
    for (int d = 0; d < D; ++d) n[d] = plane.m[d] / h[d];
    const real excess = (dot(plane.m, x) - plane.alpha) / dot(n, n);
    Vec<D> apart;
    for (int d = 0; d < D; ++d) {
        const real foot = std::clamp(x[d] - excess * n[d] / h[d], 0.0, 1.0);
        apart[d] = h[d] * (x[d] - foot);
    }
    return norm(apart);
}

/// Distance from the middle of cell I to the faces between full and empty cells along the axes.
template <int D>
real distance_to_faces(const Interface<D>& s, const Index<D>& I) {
    real least = infinity;
    for (int d = 0; d < D; ++d)
        for (const int side : {-1, 1})
            for (int k = 1; k <= reach; ++k) {
                Index<D> J = I, K = I;
                J[d] += side * (k - 1), K[d] += side * k;
                const real f = s.padded(J), g = s.padded(K);
                if ((is_full(f) && is_empty(g)) || (is_empty(f) && is_full(g))) least = std::min(least, s.h[d] * (k - 0.5));
            }
    return least;
}

}  // namespace

template <int D>
void find_distance(const Interface<D>& s, Grid<real, D>& phi) {
    const Strides<D> stride = strides_of(s.padded);
    const real farthest = reach * *std::min_element(s.h.begin(), s.h.end());
    const Vec<D> middle = Vec<D>::constant(0.5);
    for_each_cell(phi.extent(), [&](const Index<D>& I) {
        real least = std::min(farthest, distance_to_faces(s, I));
        for (int code = 0; code < (D == 2 ? 25 : 125); ++code) {
            Index<D> by;
            for (int d = 0, rest = code; d < D; ++d, rest /= 5) by[d] = rest % 5 - reach;
            if (!is_mixed(s.padded(I + by))) continue;
            least = std::min(least, distance_to_cut(plane_at<D>(s.padded.at(I + by), stride), s.h, middle - to_vec(by)));
        }
        const real f = s.padded(I);
        bool inside = f > 0.5;
        if (is_mixed(f)) {
            const Plane<D> own = plane_at<D>(s.padded.at(I), stride);
            inside = dot(own.m, middle) < own.alpha;
        }
        phi(I) = inside ? -least : least;
    });
}

template void find_distance(const Interface<2>&, Grid<real, 2>&);
template void find_distance(const Interface<3>&, Grid<real, 3>&);

}  // namespace weir::two_phase
