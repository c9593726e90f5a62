// The staggered velocity of the marker-and-cell grid (Harlow & Welch 1965) and the loops over its faces.
#pragma once
#include "core/types.hpp"
#include "geometry/sides.hpp"
#include "mac/grid/rows.hpp"
#include "parallel/grid.hpp"

#include <array>

namespace weir::mac {

/// Staggered velocity [m/s]. Component a of cell I lives on the cell's lower face along a, at x = origin + h (I + ½ − ½ eₐ).
/// face[a] has cells + eₐ entries. Along a periodic axis face n is a copy of face 0 (sync_periodic keeps it so).
template <int D>
struct MacVelocity {
    std::array<Grid<real, D>, D> face;
    Vec<D> h{};       // cell size [m]
    Vec<D> origin{};  // lower corner of the domain [m]
    Extent<D> cells{};

    MacVelocity() = default;
    MacVelocity(const Extent<D>& cells_, const Vec<D>& h_, const Vec<D>& origin_) : h(h_), origin(origin_), cells(cells_) {
        for (int a = 0; a < D; ++a) (*this)[a] = Grid<real, D>(cells + e<D>(a));
    }
    Grid<real, D>& operator[](int a) { return face[static_cast<std::size_t>(a)]; }
    const Grid<real, D>& operator[](int a) const { return face[static_cast<std::size_t>(a)]; }

    Vec<D> cell_centre(const Index<D>& I) const {
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = origin[d] + h[d] * (I[d] + 0.5);
        return x;
    }
    Vec<D> face_centre(int a, const Index<D>& I) const {
        Vec<D> x = cell_centre(I);
        x[a] = origin[a] + h[a] * I[a];
        return x;
    }
    real cell_volume() const {
        real v = 1;
        for (int d = 0; d < D; ++d) v *= h[d];
        return v;
    }
    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const auto& component : face) sum += component.bytes();
        return sum;
    }
};

/// (∇·u)(I) = Σₐ (uₐ(I + eₐ) − uₐ(I)) / hₐ     [1/s]
template <int D>
real divergence(const MacVelocity<D>& u, const Index<D>& I) {
    real sum = 0;
    for (int a = 0; a < D; ++a) sum += (u[a](I + e<D>(a)) - u[a](I)) / u.h[a];
    return sum;
}

/// The index of the entry `at`, x fastest.
template <int D>
Index<D> index_of(const Index<D>& extent, std::size_t at) {
    Index<D> I;
    for (int d = 0; d < D; ++d) {
        const auto n = static_cast<std::size_t>(extent[d]);
        I[d] = static_cast<int>(at % n);
        at /= n;
    }
    return I;
}

/// f(I) on every face along `a` with cells on both sides inside the domain.
template <int D, class F>
void for_each_inner_face(const MacVelocity<D>& u, int a, F&& f) {
    for_each_in(e<D>(a), u.cells, f);
}

/// A box of nodes of one kind: [lo, hi) of the faces along `axis`, or of the cells (axis −1).
template <int D>
struct Nodes {
    int axis;
    Index<D> lo;
    Extent<D> hi;
};

/// The faces along `axis` whose velocity is an unknown: inner faces, faces on open sides, and the joined face of a periodic axis.
template <int D>
Nodes<D> free_faces(const MacVelocity<D>& u, const geometry::Sides<D>& sides, int axis) {
    Nodes<D> nodes{axis, {}, u.cells};
    if (!sides.open(axis, 0) && !sides.periodic(axis)) nodes.lo[axis] = 1;
    if (sides.open(axis, 1)) ++nodes.hi[axis];
    return nodes;
}

template <int D>
Nodes<D> all_cells(const Extent<D>& cells) {
    return {-1, {}, cells};
}

/// f(I) on every free face along `a`.
template <int D, class F>
void for_each_free_face(const MacVelocity<D>& u, const geometry::Sides<D>& sides, int a, F&& f) {
    const Nodes<D> faces = free_faces(u, sides, a);
    for_each_in(faces.lo, faces.hi, f);
}

/// Copies face 0 of every periodic axis to its other end; in parallel, fills the faces beyond both subdomain boundaries.
template <int D>
void sync_periodic(MacVelocity<D>& u, const geometry::Sides<D>& sides) {
    refresh(u[D - 1], sides.periodic(D - 1));
    for (int a = 0; a < D; ++a) {
        if (!sides.periodic(a)) continue;
        Index<D> lo{};
        const Extent<D>& hi = u[a].extent();
        lo[a] = u.cells[a];
        for_each_in(lo, hi, [&](Index<D> I) {
            Index<D> first = I;
            first[a] = 0;
            u[a](I) = u[a](first);
        });
    }
}

/// Largest |uₐ| / hₐ over all faces and axes [1/s]; dt times it is the CFL number. NaN if any face is not finite.
template <int D>
real max_rate(const MacVelocity<D>& u) {
    real rate = 0;
    for (int a = 0; a < D; ++a) {
        rate = larger_or_nan(rate, max_magnitude(u[a]) / u.h[a]);
    }
    return rate;
}

}  // namespace weir::mac
