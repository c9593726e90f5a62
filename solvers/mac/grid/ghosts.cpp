#include "mac/grid/ghosts.hpp"

#include "mac/grid/inflow.hpp"

namespace weir::mac {

namespace {

using geometry::SideKind;
using Kind = EndRule::Kind;

/// Nodes of a side across `axis`: the extents of a component with that axis flattened.
template <int D>
Index<D> side_extent(Index<D> extent, int axis) {
    extent[axis] = 1;
    return extent;
}

/// Tangential values of an inflow with a profile, one per node of the side.
template <int D>
std::vector<real> inflow_values(const geometry::Sides<D>& sides, const MacVelocity<D>& u, int component, int axis, int end, real nu) {
    const Extent<D> nodes = replicated(side_extent<D>(u[component].extent(), axis));  // sides are small
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

/// Fills the ghost layers beyond one end of an axis, for `count` lines along it that are contiguous in memory. `q` is the first inner node
/// of the first line, n the number of nodes along each, v the Dirichlet value.
template <class Holds>
void fill_end(real* q, std::ptrdiff_t stride, int n, int end, EndRule::Kind kind, real v, int count, Holds&& holds) {
    const std::ptrdiff_t s = end == 0 ? stride : -stride;
    real* edge = end == 0 ? q : q + (n - 1) * stride;  // the inner node next to the side, or on it
    for (int k = 1; k <= ghost_layers; ++k) {
        const int in = std::min(kind == Kind::odd_about_node ? k : k - 1, n - 1);
        if (!holds(end == 0 ? -k : n - 1 + k) || !holds(end == 0 ? in : n - 1 - in)) continue;
        real* outer = edge - k * s;
        const real* inner = edge + in * s;
        switch (kind) {
            case Kind::dirichlet:
#pragma omp simd
                for (int i = 0; i < count; ++i) outer[i] = 2 * v - inner[i];
                break;
            case Kind::neumann:
                std::copy_n(inner, count, outer);
                break;
            case Kind::odd_about_node:
#pragma omp simd
                for (int i = 0; i < count; ++i) outer[i] = 2 * edge[i] - inner[i];
                break;
            case Kind::constant_beyond_node:
                std::copy_n(edge, count, outer);
                break;
            case Kind::periodic:
                break;
        }
    }
}

/// Periodic axis of n cells: node m is node m + n, also where the grid stores n + 1 nodes.
template <class Holds>
void wrap(real* q, std::ptrdiff_t stride, int nodes, int n, int count, Holds&& holds) {
    const auto copy = [&](int from, int to) {
        if (holds(from) && holds(to)) std::copy_n(q + from * stride, count, q + to * stride);
    };
    for (int k = 1; k <= ghost_layers; ++k) copy(((n - k) % n + n) % n, -k);
    for (int m = n; m < nodes + ghost_layers; ++m) copy(m % n, m);
}

/// Fills the layers beyond both ends of `axis` for the lines from I, I + e₀ .. on. In parallel, also for the ghost planes that this rank
/// stores.
template <int D>
void fill_lines(Padded<D>& q, int axis, const Boundary<D>& boundary, const Index<D>& I, int count) {
    const auto& ends = boundary.end[static_cast<std::size_t>(axis)];
    const int n = q.extent()[axis];
    real* first = q.at(I);
    const std::ptrdiff_t stride = q.stride(axis);
    const auto holds = [&](int plane) { return axis != D - 1 || q.holds(plane); };
    if (ends[0].kind == Kind::periodic) return wrap(first, stride, n, n - (axis == boundary.node_axis ? 1 : 0), count, holds);
    const Index<D> nodes = side_extent<D>(q.extent(), axis);
    for (int end = 0; end < 2; ++end) {
        const EndRule& rule = ends[static_cast<std::size_t>(end)];
        if (rule.profile.empty()) {
            fill_end(first, stride, n, end, rule.kind, rule.value, count, holds);
            continue;
        }
        for (int i = 0; i < count; ++i) {
            std::size_t side_node = 0;
            for (int d = D - 1; d >= 0; --d)
                side_node = side_node * static_cast<std::size_t>(nodes[d]) +
                            static_cast<std::size_t>(std::clamp(I[d] + (d == 0 ? i : 0), 0, nodes[d] - 1));
            fill_end(first + i, stride, n, end, rule.kind, rule.value_at(side_node), 1, holds);
        }
    }
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
void fill_plane_ghosts(Padded<D>& q, const Boundary<D>& boundary, int plane) {
    Index<D> I{};
    I[D - 1] = plane;
    for (int j = 0; j < (D == 2 ? 1 : q.extent()[1]); ++j) {
        if constexpr (D == 3) I[1] = j;
        fill_lines(q, 0, boundary, I, 1);
    }
    if constexpr (D == 2) return;
    I[0] = -ghost_layers;
    I[1] = 0;
    fill_lines(q, 1, boundary, I, q.extent()[0] + 2 * ghost_layers);
}

namespace {

template <int D>
bool repeats(const Boundary<D>& boundary) {
    return boundary.end[D - 1][0].kind == Kind::periodic;
}

/// Fills the planes beyond both ends of the last axis.
template <int D>
void fill_ends(Padded<D>& q, const Boundary<D>& boundary) {
    Index<D> rows = q.extent() + Index<D>::constant(2 * ghost_layers);
    parallel_for(0, D == 2 ? 1 : rows[1], [&](int j) {
        Index<D> I = Index<D>::constant(-ghost_layers);
        if constexpr (D == 3) I[1] += j;
        I[D - 1] = 0;
        fill_lines(q, D - 1, boundary, I, rows[0]);
    });
}

}  // namespace

template <int D>
void refresh(Padded<D>& q, const Boundary<D>& boundary, int ghost_planes) {
    if (!q.extent().own.distributed()) return;
    q.open(ghost_planes, repeats(boundary));
    communicator().refresh(q.extent().own.partition(), q.planes(), ghost_planes, repeats(boundary));
}

template <int D>
void refresh(const std::vector<WithBoundary<D>>& list, int ghost_planes) {
    if (list.empty() || !list[0].values->extent().own.distributed()) return;
    thread_local std::vector<Planes> planes;
    planes.clear();
    for (const auto& one : list) {
        one.values->open(ghost_planes, repeats(*one.boundary));
        planes.push_back(one.values->planes());
    }
    communicator().refresh(list[0].values->extent().own.partition(), planes, ghost_planes, repeats(*list[0].boundary));
}

template <int D>
void fill_end_planes(Padded<D>& q, const Boundary<D>& boundary, int ghost_planes) {
    refresh(q, boundary, ghost_planes);
    fill_ends(q, boundary);
}

template <int D>
void fill_end_planes(const std::vector<WithBoundary<D>>& list, int ghost_planes) {
    refresh(list, ghost_planes);
    for (const auto& one : list) fill_ends(*one.values, *one.boundary);
}

template <int D>
void fill_planes(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary) {
    for_each_plane(to.extent(), [&](int plane) {
        fill_plane(to, boundary, plane,
                   [&](const Index<D>& first, int count, real* row) { std::copy_n(from.data() + from.linear(first), count, row); });
    });
}

template <int D>
void fill(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary) {
    fill_planes(to, from, boundary);
    fill_end_planes(to, boundary);
}

template <int D>
real fill_planes_and_measure(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary) {
    return plane_max(to.extent().own, to.extent()[D - 1], [&](int plane) {
        real most = 0;
        fill_plane(to, boundary, plane, [&](const Index<D>& first, int count, real* row) {
            std::copy_n(from.data() + from.linear(first), count, row);
            most = larger_or_nan(most, largest_magnitude(row, static_cast<std::size_t>(count)));
        });
        return most;
    });
}

template <int D>
void fill_ghosts(Padded<D>& q, const Boundary<D>& boundary, int ghost_planes) {
    for_each_plane(q.extent(), [&](int plane) { fill_plane_ghosts(q, boundary, plane); });
    fill_end_planes(q, boundary, ghost_planes);
}

template struct Boundary<2>;
template struct Boundary<3>;
template Boundary<2> velocity_boundary(const geometry::Sides<2>&, const MacVelocity<2>&, int, real);
template Boundary<3> velocity_boundary(const geometry::Sides<3>&, const MacVelocity<3>&, int, real);
template Boundary<2> field_boundary(const geometry::Sides<2>&, const std::string&);
template Boundary<3> field_boundary(const geometry::Sides<3>&, const std::string&);
template void fill(Padded<2>&, const Grid<real, 2>&, const Boundary<2>&);
template void fill(Padded<3>&, const Grid<real, 3>&, const Boundary<3>&);
template real fill_planes_and_measure(Padded<2>&, const Grid<real, 2>&, const Boundary<2>&);
template real fill_planes_and_measure(Padded<3>&, const Grid<real, 3>&, const Boundary<3>&);
template void fill_plane_ghosts(Padded<2>&, const Boundary<2>&, int);
template void fill_plane_ghosts(Padded<3>&, const Boundary<3>&, int);
template void refresh(Padded<2>&, const Boundary<2>&, int);
template void refresh(Padded<3>&, const Boundary<3>&, int);
template void refresh(const std::vector<WithBoundary<2>>&, int);
template void refresh(const std::vector<WithBoundary<3>>&, int);
template void fill_end_planes(const std::vector<WithBoundary<2>>&, int);
template void fill_end_planes(const std::vector<WithBoundary<3>>&, int);
template void fill_planes(Padded<2>&, const Grid<real, 2>&, const Boundary<2>&);
template void fill_planes(Padded<3>&, const Grid<real, 3>&, const Boundary<3>&);
template void fill_end_planes(Padded<2>&, const Boundary<2>&, int);
template void fill_end_planes(Padded<3>&, const Boundary<3>&, int);
template void fill_ghosts(Padded<2>&, const Boundary<2>&, int);
template void fill_ghosts(Padded<3>&, const Boundary<3>&, int);

}  // namespace weir::mac
