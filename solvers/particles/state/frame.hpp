// The coordinates of single-precision passes, and the possible positions of periodic images.
#pragma once
#include "particles/threads/cell_sort.hpp"

#include <array>

namespace weir::particles {

/// The origin of the fast path's coordinates, and the periodic axes.
struct Frame {
    std::array<real, 3> centre{0, 0, 0};
    std::array<real, 3> lo{0, 0, 0}, period{0, 0, 0};  // period 0: the axis is not periodic

    bool periodic() const { return period[0] > 0 || period[1] > 0 || period[2] > 0; }
    /// Particles closer than this to a periodic side have an image beyond the opposite one: the radius, plus the distance that particles of
    /// this box have moved beyond a side.
    real band(std::size_t axis, const Box& particles, real radius) const;
    /// The cells for particles of this box and their images.
    CellGrid cover(const Box& particles, int count, real radius) const;
};

}  // namespace weir::particles
