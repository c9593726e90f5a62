#include "smoke/wall_rates.hpp"

#include <algorithm>
#include <cmath>

namespace weir::smoke {

namespace {

template <int D>
real per_square(const MacState<D>& s, const SolidWall<D>& wall) {
    return 1 / (s.u.h[wall.across] * s.u.h[wall.across]);
}

/// In units of 1/h²: m, limited; the whole conductance c is `nearer`.
real bounded(real nearer) { return std::min(nearer, 2.0); }

/// The regular stencil across a wall: (q(N) − q(I))/h².
template <int D>
real across(const MacState<D>& s, const Padded<D>& q, const Index<D>& I, const SolidWall<D>& wall) {
    const std::ptrdiff_t step = wall.way * q.stride(wall.across);
    return (q.at(I)[step] - q(I)) * per_square(s, wall);
}

}  // namespace

template <int D>
void add_wall_rates(const MacState<D>& s, int a, const Padded<D>& q, Grid<real, D>& rate) {
    for (const WallNode<D>& n : s.walls->nodes(a))
        for (const SolidWall<D>& wall : s.walls->walls(a, n)) {
            if (!wall.no_slip) continue;
            rate(n.node) += per_square(s, wall) * bounded(wall.nearer) * (wall.now - q(n.node)) - across(s, q, n.node, wall);
        }
}

template <int D>
void pull_to_walls(const MacState<D>& s, int a, real dt_nu, Grid<real, D>& u) {
    for (const WallNode<D>& n : s.walls->nodes(a)) {
        real pull = 0, to = 0;
        for (const SolidWall<D>& wall : s.walls->walls(a, n)) {
            if (!wall.no_slip) continue;
            const real c = dt_nu * per_square(s, wall) * (wall.nearer - bounded(wall.nearer));
            pull += c, to += c * wall.now;
        }
        u(n.node) = (u(n.node) + to) / (1 + pull);
    }
}

template <int D>
void set_wall_rows(const MacState<D>& s, int a, const WallShares& shares, real dt_nu, const Padded<D>& before, Grid<real, D>& rate,
                   WallRows<D>& rows) {
    rows.node.clear(), rows.extra.clear(), rows.scale.clear();
    real typical = 1;
    for (int b = 0; b < D; ++b) typical += shares.implicit * dt_nu * 2 / (s.u.h[b] * s.u.h[b]);
    for (const WallNode<D>& n : s.walls->nodes(a)) {
        const real u = before(n.node);
        real extra = 0, change = 0;
        for (const SolidWall<D>& wall : s.walls->walls(a, n)) {
            const real unit = per_square(s, wall);
            if (!wall.no_slip) {
                extra += unit * (1 - wall.nearer);
                continue;
            }
            const real early = shares.early * bounded(wall.nearer), late = wall.nearer - early;
            extra += unit * (1 - late / shares.implicit);
            const real driven = late * (wall.now - u) + (shares.has_early ? early * (wall.last - u) : 0);
            change += unit * driven / shares.before - across(s, before, n.node, wall);
        }
        rate(n.node) += change;
        rows.node.push_back(n.node);
        rows.extra.push_back(extra);
        rows.scale.push_back(1 / std::sqrt((typical - shares.implicit * dt_nu * extra) / typical));
    }
}

#define WEIR_INSTANTIATE(D)                                                                  \
    template void add_wall_rates(const MacState<D>&, int, const Padded<D>&, Grid<real, D>&); \
    template void pull_to_walls(const MacState<D>&, int, real, Grid<real, D>&);              \
    template void set_wall_rows(const MacState<D>&, int, const WallShares&, real, const Padded<D>&, Grid<real, D>&, WallRows<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::smoke
