#include "staggered/ghosts.hpp"

#include "staggered/inflow.hpp"

namespace weir::staggered {

namespace {

using geometry::SideKind;
using Kind = EndRule::Kind;

/// Nodes of a side across `axis`: the extents of a component with that axis flattened.
template <int D>
Index<D> side_extent(Index<D> extent, int axis) {
    extent[axis] = 1;
    return extent;
}

/// Tangential values that an inflow with a profile imposes, one a node of the side.
template <int D>
std::vector<real> inflow_values(const geometry::Sides<D>& sides, const MacVelocity<D>& u, int component, int axis, int end, real nu) {
    const Index<D> nodes = side_extent(u[component].extent(), axis);
    Grid<real, D> values(nodes);
    for_each_cell(nodes, [&](const Index<D>& I) {
        Vec<D> x = u.face_centre(component, I);
        x[axis] = u.origin[axis] + (end == 0 ? 0 : u.h[axis] * u.cells[axis]);
        values(I) = inflow_velocity(sides, axis, end, u, x, nu)[component];
    });
    return {values.values().begin(), values.values().end()};
}

template <int D>
EndRule velocity_rule(const geometry::Sides<D>& sides, const MacVelocity<D>& u, int component, int axis, int end, real nu) {
    const auto& side = sides.side(axis, end);
    if (side.kind == SideKind::periodic) return {Kind::periodic, 0, {}};
    if (axis == component) return {side.kind == SideKind::outflow ? Kind::constant_beyond_node : Kind::odd_about_node, 0, {}};
    if (side.kind == SideKind::outflow || (side.kind == SideKind::wall && !side.no_slip)) return {Kind::neumann, 0, {}};
    if (side.kind == SideKind::inflow && side.profile != "uniform")
        return {Kind::dirichlet, 0, inflow_values(sides, u, component, axis, end, nu)};
    return {Kind::dirichlet, side.velocity[component], {}};
}

/// Fills the layers beyond one end of one axis, for one line of nodes along it: `q` is the first inner node, n their number.
inline void fill_end(real* q, std::ptrdiff_t stride, int n, int end, const EndRule& rule, std::size_t side_node) {
    const std::ptrdiff_t s = end == 0 ? stride : -stride;
    real* edge = end == 0 ? q : q + (n - 1) * stride;  // the inner node next to the side, or on it
    for (int k = 1; k <= ghost_layers; ++k) {
        real& outer = edge[-k * s];
        switch (rule.kind) {
            case Kind::dirichlet:
                outer = 2 * rule.value_at(side_node) - edge[std::min(k - 1, n - 1) * s];
                break;
            case Kind::neumann:
                outer = edge[std::min(k - 1, n - 1) * s];
                break;
            case Kind::odd_about_node:
                outer = 2 * edge[0] - edge[std::min(k, n - 1) * s];
                break;
            case Kind::constant_beyond_node:
                outer = edge[0];
                break;
            case Kind::periodic:
                break;
        }
    }
}

/// Periodic axis of n cells: node m is node m + n, also where the grid stores n + 1 nodes.
inline void wrap(real* q, std::ptrdiff_t stride, int nodes, int n) {
    for (int k = 1; k <= ghost_layers; ++k) q[-k * stride] = q[((n - k) % n + n) % n * stride];
    for (int m = n; m < nodes + ghost_layers; ++m) q[m * stride] = q[m % n * stride];
}

template <int D>
void fill_axis(Padded<D>& q, int axis, const Boundary<D>& boundary, int periodic_cells) {
    Index<D> lo{}, hi = q.extent();
    for (int b = 0; b < axis; ++b) lo[b] = -ghost_layers, hi[b] += ghost_layers;
    lo[axis] = 0;
    hi[axis] = 1;
    const Index<D> nodes = side_extent(q.extent(), axis);
    const auto& ends = boundary.end[static_cast<std::size_t>(axis)];
    const int n = q.extent()[axis];
    for_each_in(lo, hi, [&](const Index<D>& I) {
        real* first = q.at(I);
        if (ends[0].kind == Kind::periodic) return wrap(first, q.stride(axis), n, periodic_cells);
        std::size_t side_node = 0;
        for (int d = D - 1; d >= 0; --d)
            side_node = side_node * static_cast<std::size_t>(nodes[d]) + static_cast<std::size_t>(std::clamp(I[d], 0, nodes[d] - 1));
        for (int end = 0; end < 2; ++end) fill_end(first, q.stride(axis), n, end, ends[static_cast<std::size_t>(end)], side_node);
    });
}

}  // namespace

template <int D>
Boundary<D> Boundary<D>::homogeneous() const {
    Boundary<D> zero = *this;
    for (auto& axis : zero.end)
        for (auto& rule : axis) rule.value = 0, rule.profile.clear();
    return zero;
}

template <int D>
Boundary<D> velocity_boundary(const geometry::Sides<D>& sides, const MacVelocity<D>& u, int component, real nu) {
    Boundary<D> boundary;
    boundary.node_axis = component;
    for (int axis = 0; axis < D; ++axis)
        for (int end = 0; end < 2; ++end)
            boundary.end[static_cast<std::size_t>(axis)][static_cast<std::size_t>(end)] = velocity_rule(sides, u, component, axis, end, nu);
    return boundary;
}

template <int D>
Boundary<D> field_boundary(const geometry::Sides<D>& sides, const std::string& field) {
    Boundary<D> boundary;
    for (int axis = 0; axis < D; ++axis) {
        for (int end = 0; end < 2; ++end) {
            const auto& side = sides.side(axis, end);
            auto& rule = boundary.end[static_cast<std::size_t>(axis)][static_cast<std::size_t>(end)];
            const auto value = field == "temperature" ? side.temperature : field == "smoke" ? side.smoke : std::optional<real>{};
            if (side.kind == SideKind::periodic)
                rule.kind = Kind::periodic;
            else if (value)
                rule = {Kind::dirichlet, *value, {}};
        }
    }
    return boundary;
}

template <int D>
void fill(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary) {
    Index<D> rows = from.extent();
    const int n = rows[0];
    rows[0] = 1;
    for_each_cell(rows, [&](const Index<D>& I) { std::copy_n(from.data() + from.linear(I), n, to.at(I)); });
    fill_ghosts(to, boundary);
}

template <int D>
void fill_ghosts(Padded<D>& q, const Boundary<D>& boundary) {
    for (int axis = 0; axis < D; ++axis) fill_axis(q, axis, boundary, q.extent()[axis] - (axis == boundary.node_axis ? 1 : 0));
}

template struct Boundary<2>;
template struct Boundary<3>;
template Boundary<2> velocity_boundary(const geometry::Sides<2>&, const MacVelocity<2>&, int, real);
template Boundary<3> velocity_boundary(const geometry::Sides<3>&, const MacVelocity<3>&, int, real);
template Boundary<2> field_boundary(const geometry::Sides<2>&, const std::string&);
template Boundary<3> field_boundary(const geometry::Sides<3>&, const std::string&);
template void fill(Padded<2>&, const Grid<real, 2>&, const Boundary<2>&);
template void fill(Padded<3>&, const Grid<real, 3>&, const Boundary<3>&);
template void fill_ghosts(Padded<2>&, const Boundary<2>&);
template void fill_ghosts(Padded<3>&, const Boundary<3>&);

}  // namespace weir::staggered
