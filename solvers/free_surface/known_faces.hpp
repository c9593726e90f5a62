// Faces whose velocity is known after a pressure solve: those beside liquid cells and those prescribed by sides; and the fastest of them.
#pragma once
#include "free_surface/extrapolate.hpp"
#include "mac/grid/state.hpp"

#include <algorithm>
#include <cmath>

namespace weir::free_surface {

/// Marks 1 on the faces updated by the pressure, as far as solids leave them open, and on those prescribed by walls and inflows.
/// for_faces(a, between, on_side) calls between(face, cell, count) and on_side(I, face) as for_each_face_run() does, at least for all faces
/// beside liquid.
template <int D, class ForFaces>
void mark_faces_of_liquid(const MacState<D>& state, const Frame<D>& frame, FaceMarks<D>& known, ForFaces&& for_faces) {
    using poisson::Cell;
    for (int a = 0; a < D; ++a) {
        std::uint8_t* marks = known[static_cast<std::size_t>(a)].data();
        const auto stride = state.cells.stride(a);
        const auto between = [&](std::size_t face, std::size_t cell, int count) {
            const Cell *above = state.cells.data() + cell, *below = above - stride;
            std::uint8_t* mark = marks + face;
#pragma omp simd
            for (int i = 0; i < count; ++i) mark[i] = (above[i] == Cell::fluid) | (below[i] == Cell::fluid);
        };
        const auto on_side = [&](const Index<D>& I, std::size_t face) {
            const bool liquid = state.cells(frame.near(I, a, -1)) == Cell::fluid || state.cells(frame.near(I, a, 0)) == Cell::fluid;
            marks[face] = liquid || (!frame.periodic(a) && !state.sides.open(a, I[a] == 0 ? 0 : 1));
        };
        for_faces(a, between, on_side);
    }
}

/// Largest |u| of `count` faces that have mark 1, in a row; NaN where one of them is not finite.
inline real fastest_of_row(const real* u, const std::uint8_t* mark, std::size_t count) {
    real most = 0, poison = 0;  // x − x is 0, or NaN where x is not finite
#pragma omp simd reduction(max : most) reduction(+ : poison)
    for (std::size_t i = 0; i < count; ++i) {
        const real speed = mark[i] == 1 ? std::abs(u[i]) : 0;
        most = std::max(most, speed);
        poison += speed - speed;
    }
    return std::isnan(poison) ? poison : most;
}

}  // namespace weir::free_surface
