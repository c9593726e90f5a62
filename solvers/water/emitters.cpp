#include "water/emitters.hpp"

#include <algorithm>
#include <cmath>

namespace weir::water {

namespace {

constexpr int samples = 16;  // along each axis of a cell: an edge of the cross-section is accurate to 1/32 of a cell

/// f(x) for the centres of samples^(D-1) equal parts of a cell's cross-section across `axis`, at the cell's middle along it; for `axis` =
/// -1, of the cell's volume.
template <int D, class F>
void for_each_part(const Frame<D>& frame, const Index<D>& I, int axis, F&& f) {
    Index<D> lo{}, hi = Index<D>::constant(samples), part = lo;
    if (axis >= 0) hi[axis] = 1;
    for (;;) {
        Vec<D> x = frame.centre(I);
        for (int d = 0; d < D; ++d)
            if (d != axis) x[d] += frame.h[d] * ((part[d] + 0.5) / samples - 0.5);
        f(x);
        int d = 0;
        for (; d < D && ++part[d] == hi[d]; ++d) part[d] = lo[d];
        if (d == D) return;
    }
}

/// Fraction of the cross-section of the column through I along `axis` that the shape covers anywhere between the cells lo and hi.
template <int D>
real section(const geometry::Shape<D>& shape, const Frame<D>& frame, Index<D> I, int axis, int lo, int hi) {
    constexpr int along = 4;  // samples of a ray per cell
    int hit = 0, rays = 0;
    for_each_part(frame, I, axis, [&](Vec<D> x) {
        bool inside = false;
        for (int k = along * lo; k < along * hi && !inside; ++k) {
            x[axis] = frame.origin[axis] + frame.h[axis] * (k + 0.5) / along;
            inside = shape.contains(x);
        }
        hit += inside, ++rays;
    });
    return static_cast<real>(hit) / rays;
}

}  // namespace

template <int D>
void Emitter<D>::place(const Frame<D>& frame) {
    lo = frame.cells, hi = {};
    const real diagonal = norm(frame.h);
    for (std::size_t i = 0; i < product(frame.cells); ++i) {
        const Index<D> I = frame.index_of(i);
        const real distance = shape->distance(frame.centre(I));
        if (distance > 2 * diagonal) continue;
        for (int d = 0; d < D; ++d) lo[d] = std::min(lo[d], I[d]), hi[d] = std::max(hi[d], I[d] + 1);
        if (distance > 0.5 * diagonal) continue;
        bool any = false;
        for_each_part(frame, I, -1, [&](const Vec<D>& x) { any = any || shape->contains(x); });
        if (any) cells.push_back(i);
    }
    const auto covers = [&](const Index<D>& I) {
        std::size_t at = 0;
        for (int d = D - 1; d >= 0; --d) at = at * static_cast<std::size_t>(frame.cells[d]) + static_cast<std::size_t>(I[d]);
        return std::binary_search(cells.begin(), cells.end(), at);
    };
    for (int a = 0; a < D; ++a) {
        const Index<D> extent = frame.cells + e<D>(a);
        const auto place_in_memory = [&](const Index<D>& I) {
            std::size_t at = 0;
            for (int d = D - 1; d >= 0; --d) at = at * static_cast<std::size_t>(extent[d]) + static_cast<std::size_t>(I[d]);
            return at;
        };
        for (const std::size_t cell : cells) {
            const Index<D> I = frame.index_of(cell);
            for (const int side : {0, 1}) {
                Index<D> beyond = I;
                const bool inside = frame.step(beyond, a, side == 0 ? -1 : 1), within = inside && covers(beyond);
                if (within && side == 1) continue;  // it is the next cell's lower face
                const bool ahead = velocity[a] * (side == 0 ? -1 : 1) > 0;
                if (ahead && !inside) continue;  // no flow into a wall
                const real moves = (ahead && !within ? section(*shape, frame, I, a, lo[a], hi[a]) : 1) * velocity[a];
                Index<D> face = I;
                face[a] += side;
                faces[static_cast<std::size_t>(a)].push_back({place_in_memory(face), moves, ahead || within ? moves : 0});
            }
        }
    }
}

template struct Emitter<2>;
template struct Emitter<3>;

}  // namespace weir::water
