// Velocity of solids on the grid: values on closed faces, extrapolation of free-slip flow and of fields into solids, fastest motion.
#include "core/parallel.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "mac/grid/rows.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac {

using poisson::Cell;

namespace {

/// Returns whether this rank stores a plane and its neighbours.
template <int D>
bool is_amid(const Grid<real, D>& q, int plane) {
    bool all = true;
    for (int k = std::max(plane - 1, 0); k <= std::min(plane + 1, q.extent()[D - 1] - 1); ++k) all = all && q.store().holds(k);
    return all;
}

/// Component b at a face along a: its own value, or the mean of the four surrounding faces.
template <int D>
real component_at(const PaddedVelocity<D>& u, int b, int a, const Index<D>& I) {
    if (b == a) return u[a](I);
    const Index<D> below = I - e<D>(a);
    return 0.25 * ((u[b](I) + u[b](below)) + (u[b](I + e<D>(b)) + u[b](below + e<D>(b))));
}

}  // namespace

template <int D>
void SolidPlacement<D>::set_faces(MacState<D>& s) const {
    if (!any()) return;
    for (int a = 0; a < D; ++a) {
        const auto &open = s.solid.open[static_cast<std::size_t>(a)], &velocity = s.solid.velocity[static_cast<std::size_t>(a)];
        for_each_free_face(s.u, s.sides, a, [&](const Index<D>& I) {
            if (open(I) == 0) s.u[a](I) = velocity(I);
        });
    }
}

/// Closed faces of free-slip solids with an open neighbour along the grid, and the solid's normal there.
template <int D>
void SolidPlacement<D>::find_extended(const MacState<D>& s) {
    extends_ = true;
    extended_.clear();
    for (int a = 0; a < D; ++a) {
        const auto& open = s.solid.open[static_cast<std::size_t>(a)];
        const auto is_open = [&](const Index<D>& N) { return open.contains(N) && open(N) > 0; };
        const auto beside_open = [&](const Index<D>& I) {
            for (int b = 0; b < D; ++b)
                if (is_open(I - e<D>(b)) || is_open(I + e<D>(b))) return true;
            return false;
        };
        const std::size_t plane = open.size() / static_cast<std::size_t>(open.extent()[D - 1]);
        for (std::size_t at = 0; at < open.size(); ++at) {
            if (at % plane == 0 && !is_amid(open, static_cast<int>(at / plane))) {
                at += plane - 1;
                continue;
            }
            if (open[at] > 0) continue;
            const Index<D> I = index_of<D>(open.extent(), at);
            const bool joined = a < D - 1 && s.sides.periodic(a) && I[a] == 0;  // face 0 equals the last one
            if ((I[a] == 0 && !joined) || I[a] == s.u.cells[a] || !beside_open(I)) continue;
            const Vec<D> x = s.u.face_centre(a, I);
            if (solids_[solids_.nearest(x)].no_slip) continue;
            extended_.push_back({a, I, solids_.normal(x, 1e-3 * s.u.h[a]), solids_.velocity(x), 0});
        }
    }
}

template <int D>
void SolidPlacement<D>::see_velocities(const MacState<D>& s) {
    for (Extended& f : extended_)
        if (extends_) f.velocity = solids_.velocity(s.u.face_centre(f.axis, f.face));
}

/// Extrapolates free-slip velocities: the mean of the open neighbours, minus the flow through the solid: u ← u − ((u − u_solid)·n) n. With
/// the normal part the flow beside the solid would grow unstably.
template <int D>
void SolidPlacement<D>::extend_velocity(MacState<D>& s) {
    if (any() && !extends_) find_extended(s);
    if (extended_.empty()) return;
    const int count = static_cast<int>(extended_.size());
    // in parallel: ghost planes must be filled
    const auto skips = [&](const Extended& f) { return !s.before[0].holds(f.face[D - 1] - 1) || !s.before[0].holds(f.face[D - 1] + 1); };
    parallel_for(0, count, [&](int i) {
        const Extended& f = extended_[static_cast<std::size_t>(i)];
        if (skips(f)) return;
        const auto& open = s.solid.open[static_cast<std::size_t>(f.axis)];
        real sum = 0;
        int known = 0;
        for (int b = 0; b < D; ++b) {
            real pair = 0;  // the two neighbours along an axis are added first: mirror symmetry is bitwise
            for (const Index<D>& N : {f.face - e<D>(b), f.face + e<D>(b)})
                if (open.contains(N) && open(N) > 0) pair += s.before[f.axis](N), ++known;  // open: before this extrapolation
            sum += pair;
        }
        s.before[f.axis](f.face) = sum / known;
    });
    parallel_for(0, count, [&](int i) {
        Extended& f = extended_[static_cast<std::size_t>(i)];
        if (skips(f)) return;
        real through = 0;
        for (int b = 0; b < D; ++b) through += (component_at(s.before, b, f.axis, f.face) - f.velocity[b]) * f.normal[b];
        f.value = s.before[f.axis](f.face) - through * f.normal[f.axis];
    });
    parallel_for(0, count, [&](int i) {
        const Extended& f = extended_[static_cast<std::size_t>(i)];
        if (skips(f)) return;
        s.before[f.axis](f.face) = f.value;
        if (f.face[f.axis] > 0) return;
        Index<D> last = f.face;
        last[f.axis] = s.u.cells[f.axis];
        s.before[f.axis](last) = f.value;
    });
}

template <int D>
void SolidPlacement<D>::extend_field(const MacState<D>& s, Padded<D>& before, int beyond) const {
    if (!any()) return;
    for_each_cell(s.extent().wider(beyond), [&](const Index<D>& I) {
        if (s.cells(I) != Cell::solid) return;
        real sum = 0;
        int count = 0;
        for (int b = 0; b < D; ++b) {
            real pair = 0;
            for (const Index<D>& N : {I - e<D>(b), I + e<D>(b)})
                if (s.cells.contains(N) && s.cells(N) != Cell::solid) pair += before(N), ++count;
            sum += pair;
        }
        if (count > 0) before(I) = sum / count;
    });
}

template <int D>
real SolidPlacement<D>::max_rate(const MacState<D>& s) const {
    return rate_ ? *rate_ : find_rate(s);
}

/// In parallel, each rank reads its own planes.
template <int D>
real SolidPlacement<D>::find_rate(const MacState<D>& s) const {
    bool told = false;
    for (std::size_t i = 0; i < solids_.count(); ++i) told = told || solids_[i].motion.moves();
    if (!told) return 0;
    real rate = 0;
    for (int a = 0; a < D; ++a) {
        const auto& velocity = s.solid.velocity[static_cast<std::size_t>(a)];
        real fastest = 0;  // of moving solids: all others are at rest
        for (const CellBox<D>& box : changed_)
            box.faces(a).rows([&](const Index<D>& I, int count) {
                if (!s.own().contains(I[D - 1])) return;
                const real* v = &velocity(I);
                real most = 0, poison = 0;  // x - x is 0, or NaN where x is not finite
                for (int i = 0; i < count; ++i) most = std::max(most, std::abs(v[i])), poison += v[i] - v[i];
                fastest = larger_or_nan(fastest, most + poison);
            });
        if (s.own().distributed())
            for (const real of_rank : of_ranks(fastest)) fastest = larger_or_nan(fastest, of_rank);
        rate = std::max(rate, fastest / s.u.h[a]);
    }
    return rate;
}

#define WEIR_INSTANTIATE(D)                                                                                   \
    template void SolidPlacement<D>::set_faces(MacState<D>& s) const;                                         \
    template void SolidPlacement<D>::see_velocities(const MacState<D>& s);                                    \
    template void SolidPlacement<D>::extend_velocity(MacState<D>& s);                                         \
    template void SolidPlacement<D>::extend_field(const MacState<D>& s, Padded<D>& before, int beyond) const; \
    template real SolidPlacement<D>::max_rate(const MacState<D>& s) const;                                    \
    template real SolidPlacement<D>::find_rate(const MacState<D>& s) const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac
