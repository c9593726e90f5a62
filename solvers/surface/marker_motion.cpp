#include "surface/marker_motion.hpp"

#include "core/parallel.hpp"
#include "surface/marker_lanes.hpp"

namespace weir::surface {

/// Marks the cells near solids in an updated box. A corner is half a diagonal from the centre, so a corner farther than twice the reach
/// excludes the cell.
template <int D>
static void mark_near_solids(const SolidPlacement<D>& placement, const Frame<D>& frame, std::size_t box,
                             Grid<std::uint8_t, D>& near_solid) {
    const auto near = placement.near(box);
    const real reach = SolidPlacement<D>::reach(frame.h, placement.solids().steepest(near));
    const std::uint8_t mark = near.size() == 1 && near.front() + 2 < 256 ? static_cast<std::uint8_t>(near.front() + 2) : 1;
    for_each_held(near_solid, placement.changed()[box].lo, placement.changed()[box].hi, [&](const Index<D>& I) {
        const real corner = placement.corner_distance(I);
        const bool is_near = corner < 0 || (corner < 2 * reach && placement.solids().distance(frame.centre(I), near, reach) < reach);
        near_solid(I) = is_near ? mark : 0;
    });
}

template <int D>
void mark_near_solids(const SolidPlacement<D>& placement, const Frame<D>& frame, Grid<std::uint8_t, D>& near_solid) {
    for (std::size_t box = 0; box < placement.changed().size(); ++box) mark_near_solids(placement, frame, box, near_solid);
}

namespace {

/// The box of walls, reduced by a margin; open and periodic ends do not limit.
template <int D>
struct Walls {
    Vec<D> lo = Vec<D>::constant(-infinity), hi = Vec<D>::constant(infinity);
    bool wraps = false;
    Walls(const Frame<D>& frame, const geometry::Sides<D>& sides) {
        for (int d = 0; d < D; ++d) {
            const real margin = wall_margin * frame.h[d], first = frame.origin[d];
            wraps = wraps || frame.periodic(d);
            if (!sides.open(d, 0) && !frame.periodic(d)) lo[d] = first + margin;
            if (!sides.open(d, 1) && !frame.periodic(d)) hi[d] = first + frame.h[d] * frame.cells[d] - margin;
        }
    }
    WEIR_INLINE LaneVec<D> keep_inside(const LaneVec<D>& x) const {
        LaneVec<D> inside;
        for (int d = 0; d < D; ++d) {
            const auto at = static_cast<std::size_t>(d);
            inside[at] = x[at] < lo[d] ? Lanes{} + lo[d] : x[at];
            inside[at] = inside[at] > hi[d] ? Lanes{} + hi[d] : inside[at];
        }
        return inside;
    }
    Vec<D> keep_inside(const Frame<D>& frame, Vec<D> x) const {
        for (int d = 0; d < D; ++d) x[d] = std::clamp(x[d], lo[d], hi[d]);
        return wraps ? frame.wrap(x) : x;
    }
};

/// The points after dt by RK2, if their midpoints lie within half a cell of them, which the stencil of their cell covers.
template <int D>
WEIR_INLINE bool trace_midpoint(const CellFaces<D>& faces, const Frame<D>& frame, const Index<D>& I, real dt, LaneVec<D>& x) {
    auto d = from_centre(frame, I, x);
    const auto k1 = faces.template velocity<false>(d);
    bool near = true;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const Lanes half = k1[at] * (0.5 * dt * frame.inv_h[a]);
        near = near & simd::all_within(half, 0.5);
        d[at] += half;
    }
    if (!near) return false;
    const auto k2 = faces.template velocity<true>(d);
    for (std::size_t a = 0; a < D; ++a) x[a] += dt * k2[a];
    return true;
}

}  // namespace

template <int D>
void move_markers(Markers<D>& markers, const MacVelocity<D>& u, const Frame<D>& frame, real dt, Trace order,
                  const geometry::Sides<D>& sides, const geometry::Solids<D>& solids, const Grid<std::uint8_t, D>& near_solid) {
    const Walls<D> walls(frame, sides);
    const real eps = 1e-3 * frame.h_min();  // for the finite differences of a solid's normal
    const auto place = [&](std::size_t p, const Vec<D>& reached) {
        Vec<D> x = walls.keep_inside(frame, reached);
        const std::uint8_t near = near_solid.empty() ? std::uint8_t{0} : near_solid(frame.cell_of(x));
        const std::size_t only = near - 2u;
        if (near == 1) x = walls.keep_inside(frame, solids.push_out(x, wall_margin * frame.h_min(), eps));
        if (near > 1) x = walls.keep_inside(frame, solids.push_out(x, wall_margin * frame.h_min(), eps, {&only, 1}));
        markers.set_position(p, x);
    };
    markers.for_each_occupied_cell(frame, [&](const Index<D>& I, std::size_t begin, std::size_t end) {
        const CellFaces<D> faces(u, frame, I);
        for (std::size_t p = begin; p < end; p += marker_lanes) {
            const int count = static_cast<int>(std::min<std::size_t>(marker_lanes, end - p));
            auto x = load_positions(markers, p, count);
            const bool together = order == Trace::rk2 && trace_midpoint(faces, frame, I, dt, x);
            if (together) {
                x = walls.keep_inside(x);
                for (std::size_t a = 0; a < D; ++a) simd::store_first(markers.x[a].data() + p, x[a], count);
                if (!walls.wraps && near_solid.empty()) continue;
            }
            for (std::size_t marker = p; marker < p + static_cast<std::size_t>(count); ++marker) {
                const Vec<D> reached = markers.position(marker);
                place(marker, together ? reached : trace(u, frame, reached, dt, order));
            }
        }
    });
}

template <int D>
std::size_t remove_departed(Markers<D>& markers, const Frame<D>& frame, const geometry::Sides<D>& sides) {
    bool any_open = false;
    for (int d = 0; d < D; ++d) any_open |= sides.open(d, 0) || sides.open(d, 1);
    if (!any_open) return 0;
    const std::size_t before = markers.count();
    markers.retain([&](std::size_t p) {
        const Vec<D> x = markers.position(p);
        for (int d = 0; d < D; ++d)
            if (x[d] < frame.origin[d] || x[d] >= frame.origin[d] + frame.h[d] * frame.cells[d]) return false;
        return true;
    });
    return before - markers.count();
}

template void mark_near_solids(const SolidPlacement<2>&, const Frame<2>&, Grid<std::uint8_t, 2>&);
template void mark_near_solids(const SolidPlacement<3>&, const Frame<3>&, Grid<std::uint8_t, 3>&);
template void move_markers(Markers<2>&, const MacVelocity<2>&, const Frame<2>&, real, Trace, const geometry::Sides<2>&,
                           const geometry::Solids<2>&, const Grid<std::uint8_t, 2>&);
template void move_markers(Markers<3>&, const MacVelocity<3>&, const Frame<3>&, real, Trace, const geometry::Sides<3>&,
                           const geometry::Solids<3>&, const Grid<std::uint8_t, 3>&);
template std::size_t remove_departed(Markers<2>&, const Frame<2>&, const geometry::Sides<2>&);
template std::size_t remove_departed(Markers<3>&, const Frame<3>&, const geometry::Sides<3>&);

}  // namespace weir::surface
