// Indexing of the liquid's grid: neighbours that stop at walls and wrap along periodic axes, and the two samples and the weight of linear
// interpolation along one axis. All transfers between markers and faces use them, so they are consistent.
#pragma once
#include "core/types.hpp"
#include "geometry/sides.hpp"
#include "mac/grid/velocity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace weir::free_surface {

using namespace mac;  // the grid's words are the solver's own

/// An integer value as an index. What is no number or leaves the range of indices, as in a step that diverges, is an index far outside.
inline int index_from(real value) {
    constexpr real far = 1 << 30;
    return static_cast<int>(std::min(far, std::max(-far, value)));
}

/// The samples lo and lo + step of a row, and the weight of the second one.
struct Interval {
    int lo;
    int step;
    real f;
};

/// Linear interpolation at s [samples] in a row of n: clamped at its ends, or with period `period` (0: not periodic).
inline Interval locate(real s, int n, int period) {
    const real lower = std::floor(s), f = s - lower;
    int i = index_from(lower);
    if (static_cast<unsigned>(i) < static_cast<unsigned>(n - 1)) return {i, 1, f};
    if (period > 0) {
        i = ((i % period) + period) % period;
        return {i, i + 1 < n ? 1 : 1 - n, f};
    }
    return i < 0 ? Interval{0, 0, 0} : Interval{n - 1, 0, 0};
}

template <int D>
struct Frame {
    Extent<D> cells{};  // with the planes of this rank
    Vec<D> h{}, inv_h{}, origin{};
    std::array<int, D> period{};  // cells of a periodic axis; 0: the axis has ends

    Frame() = default;
    Frame(const MacVelocity<D>& u, const geometry::Sides<D>& sides) : cells(u.cells), h(u.h), origin(u.origin) {
        for (int d = 0; d < D; ++d) {
            inv_h[d] = 1 / h[d];
            period[static_cast<std::size_t>(d)] = sides.periodic(d) ? cells[d] : 0;
        }
    }
    const OwnPlanes& own() const { return cells.own; }
    bool periodic(int axis) const { return period[static_cast<std::size_t>(axis)] > 0; }
    /// The smallest cell size [m].
    real h_min() const { return *std::min_element(h.begin(), h.end()); }
    /// The largest [m].
    real h_max() const { return *std::max_element(h.begin(), h.end()); }
    /// Returns whether cells are cubes, up to round-off of their edges.
    bool cubic() const { return h_max() <= h_min() * (1 + 1e-9); }
    /// Width of a cell normal to planes with this normal [m]: that of the ellipsoid whose axes are the cell's edges. The edge length for
    /// cubes.
    real width_along(const Vec<D>& n) const {
        real sum = 0;
        for (int d = 0; d < D; ++d) sum += n[d] * n[d] * h[d] * h[d];
        const real length = norm(n);
        return cubic() || !(length > 0) ? h_min() : std::sqrt(sum) / length;
    }
    real cell_volume() const {
        real volume = 1;
        for (int d = 0; d < D; ++d) volume *= h[d];
        return volume;
    }
    Vec<D> centre(const Index<D>& I) const {
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = origin[d] + h[d] * (I[d] + 0.5);
        return x;
    }
    /// The cell that contains x; points outside belong to the nearest cell.
    Index<D> cell_of(const Vec<D>& x) const {
        Index<D> I;
        for (int d = 0; d < D; ++d) I[d] = std::clamp(index_from(std::floor((x[d] - origin[d]) * inv_h[d])), 0, cells[d] - 1);
        return I;
    }
    /// The cell with this linear index.
    Index<D> index_of(std::size_t linear) const { return mac::index_of<D>(cells, linear); }
    /// A cell's linear index.
    std::size_t linear(const Index<D>& I) const {
        auto at = static_cast<std::size_t>(I[D - 1]);
        for (int d = D - 2; d >= 0; --d) at = at * static_cast<std::size_t>(cells[d]) + static_cast<std::size_t>(I[d]);
        return at;
    }
    /// Moves I by ±1 along an axis, across a periodic boundary; false, with I unchanged, at a side of the domain.
    bool step(Index<D>& I, int axis, int by) const {
        const int i = I[axis] + by;
        if (i >= 0 && i < cells[axis]) {
            I[axis] = i;
            return true;
        }
        if (!periodic(axis)) return false;
        I[axis] = i < 0 ? cells[axis] - 1 : 0;
        return true;
    }
    /// I + by along an axis, wrapped or clamped into the domain.
    Index<D> near(Index<D> I, int axis, int by) const {
        const int i = I[axis] + by, n = cells[axis];
        I[axis] = periodic(axis) ? ((i % n) + n) % n : std::clamp(i, 0, n - 1);
        return I;
    }
    /// x with periodic axes wrapped into the domain.
    Vec<D> wrap(Vec<D> x) const {
        for (int d = 0; d < D; ++d)
            if (periodic(d)) {
                const real length = h[d] * cells[d];
                x[d] -= length * std::floor((x[d] - origin[d]) / length);
            }
        return x;
    }
};

/// Entries [begin, end) of a line; empty where begin is not below end.
struct Segment {
    int begin, end;
    bool empty() const { return begin >= end; }
    void join(const Segment& other) { begin = std::min(begin, other.begin), end = std::max(end, other.end); }
};

/// Halo exchange of `ghost_planes` planes of faces, all components in one message per neighbour. Across a periodic boundary face n is face
/// 0.
template <int D>
void refresh_faces(std::array<Grid<real, D>, D>& u, const Frame<D>& frame, int ghost_planes) {
    if (!frame.own().distributed()) return;
    std::array<Planes, D> all;
    for (std::size_t a = 0; a < D; ++a) {
        u[a].store().open(ghost_planes, frame.periodic(D - 1));
        all[a] = planes_of(u[a]);
    }
    communicator().refresh(frame.own().partition(), all, ghost_planes, frame.periodic(D - 1));
    const int n = frame.cells[D - 1];
    if (!frame.periodic(D - 1) || frame.own().contains(n)) return;
    Grid<real, D>& across = u[D - 1];
    if (!across.store().holds(0) || !across.store().holds(n)) return;
    std::copy_n(across.data(), across.stride(D - 1), across.data() + n * across.stride(D - 1));
}
template <int D>
void refresh_faces(MacVelocity<D>& u, const Frame<D>& frame, int ghost_planes) {
    refresh_faces<D>(u.face, frame, ghost_planes);
}

/// f(I, at) for the first entry I of every line along x of a box, and its linear index; threaded over the slowest axis.
template <int D, class F>
void for_each_line(const Extent<D>& extent, F&& f) {
    Extent<D> columns = extent;
    columns[0] = 1;
    for_each_in(Index<D>{}, columns, [&](const Index<D>& I) {
        std::size_t at = 0;
        for (int d = D - 1; d >= 0; --d) at = at * static_cast<std::size_t>(extent[d]) + static_cast<std::size_t>(I[d]);
        f(I, at);
    });
}

/// inner(face, cell, count) on runs along x of faces along a with a cell on both sides: linear indices of the first face and of the cell
/// above it. outer(I, face) on each of the others, which lie on a side of the domain or on a periodic boundary.
template <int D, class F, class G>
void for_each_face_run(const Extent<D>& cells, int a, F&& inner, G&& outer) {
    const auto n = static_cast<std::size_t>(cells[0]);
    for_each_line(cells + e<D>(a), [&](Index<D> I, std::size_t face) {
        if (a > 0 && (I[a] == 0 || I[a] == cells[a])) {
            for (; I[0] < cells[0]; ++I[0], ++face) outer(I, face);
            return;
        }
        std::size_t row = 0;
        for (int d = D - 1; d > 0; --d) row = row * static_cast<std::size_t>(cells[d]) + static_cast<std::size_t>(I[d]);
        const std::size_t cell = row * n, first = a == 0 ? 1 : 0;
        if (a == 0) outer(I, face);
        inner(face + first, cell + first, static_cast<int>(n - first));
        if (a == 0) I[0] = cells[0], outer(I, face + n);
    });
}

/// Interpolation stencils of faces and centres around one point: the interval along each axis for both kinds of sample.
template <int D>
struct Stencil {
    std::array<Interval, D> face, centre;
    Stencil(const Frame<D>& frame, const Vec<D>& x) {
        for (int d = 0; d < D; ++d) {
            const auto at = static_cast<std::size_t>(d);
            const real s = (x[d] - frame.origin[d]) * frame.inv_h[d];
            face[at] = locate(s, frame.cells[d] + 1, frame.period[at]);
            centre[at] = locate(s - 0.5, frame.cells[d], frame.period[at]);
        }
    }
    /// The interval along d for component a.
    const Interval& of(int a, int d) const { return (a == d ? face : centre)[static_cast<std::size_t>(d)]; }
};

/// f(entry, weight) for the 2^D samples of component a around the stencil's point; n is the extent of that component.
template <int D, class F>
inline void for_each_sample(const Stencil<D>& stencil, int a, const Index<D>& n, F&& f) {
    const Interval &i = stencil.of(a, 0), &j = stencil.of(a, 1);
    const std::ptrdiff_t nx = n[0];
    const auto plane = [&](std::ptrdiff_t base, real w) {
        const std::ptrdiff_t at = base + i.lo + nx * j.lo, sx = i.step, sy = nx * j.step;
        f(at, w * (1 - i.f) * (1 - j.f));
        f(at + sx, w * i.f * (1 - j.f));
        f(at + sy, w * (1 - i.f) * j.f);
        f(at + sx + sy, w * i.f * j.f);
    };
    if constexpr (D == 2) {
        plane(0, 1);
    } else {
        const Interval& k = stencil.of(a, 2);
        const std::ptrdiff_t sz = nx * n[1];
        plane(sz * k.lo, 1 - k.f);
        plane(sz * (k.lo + k.step), k.f);
    }
}

/// Linear interpolation of one component of a staggered field.
template <int D>
inline real sample(const Grid<real, D>& component, int a, const Stencil<D>& stencil) {
    const Index<D>& n = component.extent();
    const real* u = component.data();
    const Interval &i = stencil.of(a, 0), &j = stencil.of(a, 1);
    const std::ptrdiff_t nx = n[0];
    const auto plane = [&](const real* at) {
        const std::ptrdiff_t sx = i.step, sy = nx * j.step;
        const real lower = at[0] + i.f * (at[sx] - at[0]), upper = at[sy] + i.f * (at[sx + sy] - at[sy]);
        return lower + j.f * (upper - lower);
    };
    const real* at = u + i.lo + nx * j.lo;
    if constexpr (D == 2) {
        return plane(at);
    } else {
        const Interval& k = stencil.of(a, 2);
        const std::ptrdiff_t sz = nx * n[1];
        const real below = plane(at + sz * k.lo);
        return below + k.f * (plane(at + sz * (k.lo + k.step)) - below);
    }
}

/// The velocity at the stencil's point [m/s].
template <int D>
inline Vec<D> sample(const MacVelocity<D>& u, const Stencil<D>& stencil) {
    Vec<D> v;
    for (int a = 0; a < D; ++a) v[a] = sample(u[a], a, stencil);
    return v;
}

/// Linear interpolation of a cell field.
template <int D>
inline real sample_cells(const Grid<real, D>& q, const Stencil<D>& stencil) {
    return sample(q, -1, stencil);
}

}  // namespace weir::free_surface
