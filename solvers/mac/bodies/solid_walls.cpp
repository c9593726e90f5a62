#include "mac/bodies/solid_walls.hpp"

#include "mac/bodies/solid_faces.hpp"
#include "mac/grid/projection.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac {

namespace {

/// Position of a node in a grid that is periodic along some axes; `inside`: whether it is in the grid.
template <int D>
struct Wrapped {
    Index<D> node;
    bool inside;
    Wrapped(const MacState<D>& s, int a, Index<D> N) : node(N) {
        for (int d = 0; d < D; ++d)
            if (s.sides.periodic(d)) node[d] = ((N[d] % s.u.cells[d]) + s.u.cells[d]) % s.u.cells[d];
        inside = s.u[a].contains(node);
    }
};

/// The tangential part of a wall velocity's gradient: ∂v_b/∂x_a of a rigid motion.
template <int D>
real turn_of(const geometry::Pose<D>& pose, const Vec<D>& x, int a, int b) {
    if (a == b) return 0;
    return pose.velocity_at(x + Vec<D>::unit(a))[b] - pose.velocity_at(x)[b];
}

/// No-slip bodies are handled in no_slip_walls.hpp.
template <int D>
bool is_body(const geometry::Solid<D>& solid) {
    return solid.free && solid.no_slip;
}

/// One wall, from the geometry.
template <int D>
SolidWall<D> wall_between(const MacState<D>& s, const geometry::Solids<D>& solids, int a, const Index<D>& I, const Index<D>& N, int across,
                          int way, const std::vector<geometry::Pose<D>>& last) {
    const Vec<D> x = s.u.face_centre(a, I), beyond = s.u.face_centre(a, N);
    const std::size_t k = solids.nearest(beyond);
    SolidWall<D> wall{across, way, solids[k].no_slip, 0, 0, 0, 0};
    if (!wall.no_slip) {
        const Vec<D> n = solids.normal(beyond, 1e-3 * s.u.h[a]);
        wall.nearer = D * n[a] * n[a];
        return wall;
    }
    const real away = solids.distance(k, x), deep = solids.distance(k, beyond);
    const real theta = deep < 0 ? std::max(away / (away - deep), least_open_fraction) : 1;
    const Vec<D> at = x + (way * theta * s.u.h[across]) * Vec<D>::unit(across);
    const auto& pose = solids.pose(k);
    wall.nearer = 1 / theta;
    wall.now = pose.velocity_at(at)[a];
    wall.last = solids[k].motion.moves() ? last[k].velocity_at(at)[a] : wall.now;
    wall.rotation_rate = turn_of(pose, at, a, across);
    return wall;
}

}  // namespace

template <int D>
bool SolidWalls<D>::found() const {
    return found_;
}

template <int D>
void SolidWalls<D>::find(const MacState<D>& s, const SolidPlacement<D>& placement, real now, real last) {
    const real largest = *std::max_element(s.u.h.begin(), s.u.h.end());
    // bound on the displacement since the placement, unless a solid starts from rest faster than the fluid beside it
    const real margin = now > last ? (0.05 + 1.2 * (now - last) * placement.max_rate(s)) * largest : 0;
    no_slip_ = false;  // the same on all ranks, including those without walls
    for (std::size_t k = 0; k < placement.solids().count(); ++k)
        no_slip_ = no_slip_ || (placement.solids()[k].no_slip && !placement.solids()[k].free);
    last_.resize(placement.solids().count());
    for (std::size_t k = 0; k < last_.size(); ++k)
        if (placement.solids()[k].motion.moves()) last_[k] = placement.solids()[k].motion.pose(last);
    for (int a = 0; a < D; ++a) {
        set_mask(s, placement, a, margin);
        find_nodes(s, placement, a);
    }
    found_ = true;
}

/// Faces whose centre lies in a no-slip solid move with it. Most faces are too far from any solid to need a distance.
template <int D>
void SolidWalls<D>::set_mask(const MacState<D>& s, const SolidPlacement<D>& placement, int a, real margin) {
    const auto at = static_cast<std::size_t>(a);
    const geometry::Solids<D>& solids = placement.solids();
    const auto& open = s.solid.open[at];
    auto& mask = takes_part_[at];
    if (mask.empty()) mask = Padded<D>(open.extent());
    std::vector<std::size_t> all(solids.count());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    const real reach = SolidPlacement<D>::reach(s.u.h, solids.steepest(all)), known = 2 * reach;
    const real near = margin < reach ? reach + margin : infinity;
    const auto is_far = [&](const Index<D>& I) { return std::min(placement.corner_distance(I), known) >= near; };
    for_each_cell(open.extent(), [&](const Index<D>& I) {
        mask(I) = open(I) > 0 ? 1 : 0;
        if (open(I) == 0 || is_far(I)) return;
        const Vec<D> x = s.u.face_centre(a, I);
        const std::size_t k = solids.nearest(x);
        if (solids[k].no_slip && !solids[k].free && solids.distance(k, x) <= 0) mask(I) = 0;
    });
    fill_ghosts(mask, s.boundary[at].homogeneous(), 1);
}

template <int D>
void SolidWalls<D>::find_nodes(const MacState<D>& s, const SolidPlacement<D>& placement, int a) {
    const auto at = static_cast<std::size_t>(a);
    const geometry::Solids<D>& solids = placement.solids();
    const auto& mask = takes_part_[at];
    const auto& open = s.solid.open[at];
    Nodes<D> free = free_faces(s.u, s.sides, a);
    free.lo[D - 1] = s.own().lower(free.lo[D - 1]), free.hi[D - 1] = s.own().upper(free.hi[D - 1]);
    nodes_[at].clear(), walls_[at].clear(), held_[at].clear();
    const auto look = [&](const Index<D>& I) {
        if (mask(I) == 0) return held_[at].push_back({I, solids.velocity(s.u.face_centre(a, I))[a]});
        const std::size_t begin = walls_[at].size();
        for (int b = 0; b < D; ++b)
            for (const int way : {-1, 1}) {
                const Index<D> beyond = way < 0 ? I - e<D>(b) : I + e<D>(b);
                if (mask(beyond) != 0) continue;
                const Wrapped<D> N(s, a, beyond);
                if (N.inside && !is_body(solids[solids.nearest(s.u.face_centre(a, N.node))]))
                    walls_[at].push_back(wall_between(s, solids, a, I, N.node, b, way, last_));
            }
        if (walls_[at].size() > begin) nodes_[at].push_back({I, begin, walls_[at].size()});
    };
    CellBox<D>{free.lo, free.hi}.rows([&](Index<D> I, int count) {
        const real *m = mask.at(I), *w = &open(I);
        for (int i = 0; i < count; ++i, ++I[0]) {
            bool amid = m[i] != 0;  // fluid faces, as most are
            for (int b = 0; b < D; ++b) amid = amid && m[i - mask.stride(b)] != 0 && m[i + mask.stride(b)] != 0;
            if (!amid && w[i] > 0) look(I);
        }
    });
}

template <int D>
void SolidWalls<D>::enforce_no_slip(MacState<D>& s, real factor) const {
    const PressurePush<D> push(s, factor);
    for (int a = 0; a < D; ++a)
        for (const HeldFace<D>& f : held(a)) {
            real u = f.velocity;
            push.add(a, f.face, 1, &u);
            s.u[a](f.face) = u;
        }
    sync_periodic(s.u, s.sides);
}

namespace {

/// Slope of the component from a node towards a neighbour, or towards the wall between them; 0 beyond the sides of the domain.
template <int D>
struct Slopes {
    const MacState<D>& s;
    const SolidWalls<D>& all;
    int a;
    const WallNode<D>& node;

    real of_wall(const SolidWall<D>& wall) const { return wall.nearer * (wall.now - s.u[a](node.node)) / s.u.h[wall.across]; }
    /// Slope away from a wall; the slope at the wall where no other value exists.
    real away_from(const SolidWall<D>& wall) const {
        for (const SolidWall<D>& other : all.walls(a, node))
            if (other.across == wall.across && other.way != wall.way) return other.no_slip ? of_wall(other) : 0;
        const Index<D> next = wall.way < 0 ? node.node + e<D>(wall.across) : node.node - e<D>(wall.across);
        const Wrapped<D> P(s, a, next);
        return P.inside ? (s.u[a](P.node) - s.u[a](node.node)) / s.u.h[wall.across] : -of_wall(wall);
    }
};

/// Torque about the origin of a force along `a` at x.
template <int D>
void add_torque(SolidLoad<D>& load, int a, real force, const Vec<D>& x) {
    if constexpr (D == 2) {
        load.torque[0] += a == 0 ? -x[1] * force : x[0] * force;
    } else {
        const int b = (a + 1) % 3, c = (a + 2) % 3;  // (x × f e_a) along b and c
        load.torque[static_cast<std::size_t>(b)] += x[c] * force;
        load.torque[static_cast<std::size_t>(c)] -= x[b] * force;
    }
}

/// Sums the contribution of each plane, in order.
template <int D, class F>
SolidLoad<D> load_over(const OwnPlanes& own, int planes, F&& of_plane) {
    std::vector<SolidLoad<D>> part(static_cast<std::size_t>(planes));
    for_each_plane(own, 0, planes, [&](int plane) { part[static_cast<std::size_t>(plane)] = of_plane(plane); });
    SolidLoad<D> sum;
    for (int d = 0; d < D; ++d)
        sum.force[d] = plane_sum(own, planes, [&](int plane) { return part[static_cast<std::size_t>(plane)].force[d]; });
    for (std::size_t k = 0; k < sum.torque.size(); ++k)
        sum.torque[k] = plane_sum(own, planes, [&](int plane) { return part[static_cast<std::size_t>(plane)].torque[k]; });
    return sum;
}

}  // namespace

/// The fluid between the wall and the edge of the node's cell has a height of θ + ½ cells instead of one. The difference adds (½ − θ) h
/// ∂²u/∂n² to the slope from wall to node. The remaining stress, (∇u)ᵀ n, is that of the rigid motion.
template <int D>
SolidLoad<D> SolidWalls<D>::friction(const MacState<D>& s) const {
    const auto before = [](const WallNode<D>& n, int plane) { return n.node[D - 1] < plane; };
    return load_over<D>(s.own(), s.u.cells[D - 1] + 1, [&](int plane) {
        SolidLoad<D> load;
        for (int a = 0; a < D; ++a) {
            const auto list = nodes(a);
            for (auto n = std::lower_bound(list.begin(), list.end(), plane, before); n != list.end() && n->node[D - 1] == plane; ++n) {
                const Slopes<D> slopes{s, *this, a, *n};
                for (const SolidWall<D>& wall : walls(a, *n)) {
                    if (!wall.no_slip) continue;
                    const real h = s.u.h[wall.across], g0 = -slopes.of_wall(wall), g1 = slopes.away_from(wall);
                    const real slope = g0 + (0.5 - 1 / wall.nearer) * (g1 - g0) - wall.way * wall.rotation_rate;
                    const real force = s.rho * s.nu * s.u.cell_volume() / h * slope;
                    load.force[a] += force;
                    add_torque(load, a, force, s.u.face_centre(a, n->node) + (wall.way * h / wall.nearer) * Vec<D>::unit(wall.across));
                }
            }
        }
        return load;
    });
}

template <int D>
std::size_t SolidWalls<D>::bytes() const {
    std::size_t total = 0;
    for (std::size_t a = 0; a < D; ++a)
        total += takes_part_[a].bytes() + nodes_[a].capacity() * sizeof(WallNode<D>) + walls_[a].capacity() * sizeof(SolidWall<D>) +
                 held_[a].capacity() * sizeof(HeldFace<D>);
    return total;
}

template <int D>
SolidLoad<D> pressure_load(const MacState<D>& s) {
    if (!s.solid.any()) return {};
    SolidLoad<D> load = load_over<D>(s.own(), s.extent()[D - 1], [&](int plane) {
        SolidLoad<D> part;
        Index<D> lo{}, hi = s.extent();
        lo[D - 1] = plane, hi[D - 1] = plane + 1;
        CellBox<D>{lo, hi}.in_order([&](const Index<D>& I) {
            if (s.cells(I) != poisson::Cell::fluid) return;
            for (int a = 0; a < D; ++a) {
                const auto& open = s.solid.open[static_cast<std::size_t>(a)];
                const real side = open(I) - open(I + e<D>(a));
                if (side != 0) add_torque(part, a, s.u.cell_volume() / s.u.h[a] * s.p(I) * side, s.u.cell_centre(I));
            }
        });
        return part;
    });
    load.force = pressure_force(s);
    return load;
}

template class SolidWalls<2>;
template class SolidWalls<3>;
template SolidLoad<2> pressure_load(const MacState<2>&);
template SolidLoad<3> pressure_load(const MacState<3>&);

}  // namespace weir::mac
