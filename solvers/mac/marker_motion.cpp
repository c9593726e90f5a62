#include "mac/marker_motion.hpp"

#include "core/parallel.hpp"

namespace weir::mac {

template <int D>
void mark_near_solids(const geometry::Solids<D>& solids, const Frame<D>& frame, Grid<std::uint8_t, D>& near_solid) {
    for_each_cell(frame.cells, [&](const Index<D>& I) { near_solid(I) = solids.distance(frame.centre(I)) < norm(frame.h); });
}

namespace {

/// The nearest point inside the walls; ends that are open or periodic do not stop anything.
template <int D>
Vec<D> inside_walls(const Frame<D>& frame, const geometry::Sides<D>& sides, Vec<D> x) {
    for (int d = 0; d < D; ++d) {
        const real margin = wall_margin * frame.h[d], lo = frame.origin[d], hi = lo + frame.h[d] * frame.cells[d];
        if (!sides.open(d, 0) && !frame.periodic(d)) x[d] = std::max(x[d], lo + margin);
        if (!sides.open(d, 1) && !frame.periodic(d)) x[d] = std::min(x[d], hi - margin);
    }
    return frame.wrap(x);
}

}  // namespace

template <int D>
void move_markers(Markers<D>& markers, const MacVelocity<D>& u, const Frame<D>& frame, real dt, Trace order,
                  const geometry::Sides<D>& sides, const geometry::Solids<D>& solids, const Grid<std::uint8_t, D>& near_solid) {
    const real eps = 1e-3 * frame.h_min();  // of the finite differences that give a solid's normal
    parallel_for(0, static_cast<int>(markers.count()), [&](int i) {
        const auto p = static_cast<std::size_t>(i);
        Vec<D> x = inside_walls(frame, sides, trace(u, frame, markers.position(p), dt, order));
        if (!near_solid.empty() && near_solid(frame.cell_of(x)))
            x = inside_walls(frame, sides, solids.push_out(x, wall_margin * frame.h_min(), eps));
        markers.set_position(p, x);
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

template void mark_near_solids(const geometry::Solids<2>&, const Frame<2>&, Grid<std::uint8_t, 2>&);
template void mark_near_solids(const geometry::Solids<3>&, const Frame<3>&, Grid<std::uint8_t, 3>&);
template void move_markers(Markers<2>&, const MacVelocity<2>&, const Frame<2>&, real, Trace, const geometry::Sides<2>&,
                           const geometry::Solids<2>&, const Grid<std::uint8_t, 2>&);
template void move_markers(Markers<3>&, const MacVelocity<3>&, const Frame<3>&, real, Trace, const geometry::Sides<3>&,
                           const geometry::Solids<3>&, const Grid<std::uint8_t, 3>&);
template std::size_t remove_departed(Markers<2>&, const Frame<2>&, const geometry::Sides<2>&);
template std::size_t remove_departed(Markers<3>&, const Frame<3>&, const geometry::Sides<3>&);

}  // namespace weir::mac
