// Vorticity seen from a tank that rolls.
#pragma once
#include "geometry/rotating_frame.hpp"
#include "mac/grid/velocity.hpp"

namespace weir::test {

/// Mean vorticity about the frame's axis, on edges of the inner half: near walls an edge's vorticity depends on how the scheme continues
/// velocities.
template <int D>
real inner_vorticity(const mac::MacVelocity<D>& u, const geometry::RotatingFrame<D>& frame) {
    const int p = frame.p(), q = frame.q();
    real sum = 0;
    int count = 0;
    for (std::size_t at = 0; at < product(u.cells); ++at) {
        const Index<D> I = mac::index_of<D>(u.cells, at);
        bool inner = true;
        for (int a = 0; a < D; ++a) inner = inner && 4 * I[a] >= u.cells[a] && 4 * I[a] <= 3 * u.cells[a];
        if (!inner) continue;
        sum += (u[q](I) - u[q](I - e<D>(p))) / u.h[p] - (u[p](I) - u[p](I - e<D>(q))) / u.h[q];
        ++count;
    }
    return sum / count;
}

}  // namespace weir::test
