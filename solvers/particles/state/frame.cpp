#include "particles/state/frame.hpp"

#include <algorithm>

namespace weir::particles {

real Frame::band(std::size_t axis, const Box& particles, real radius) const {
    return radius + std::max<real>(0, std::max(lo[axis] - particles.lo[axis], particles.hi[axis] - lo[axis] - period[axis]));
}

CellGrid Frame::cover(const Box& particles, int count, real radius) const {
    Box all = particles;
    for (std::size_t a = 0; a < 3; ++a) {
        if (period[a] == 0) continue;
        const real width = band(a, particles, radius);
        all.lo[a] = lo[a] - width;
        all.hi[a] = lo[a] + period[a] + width;
    }
    return cover_box(all, count, radius * 1.00001);  // slightly wider than the radius: cells are computed in double, distances in float
}

}  // namespace weir::particles
