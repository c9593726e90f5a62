// The coordinates of passes in single precision, and images beyond sides that repeat: where they can stand.
#pragma once
#include "particles/cell_sort.hpp"

#include <array>

namespace weir::particles {

/// Where the fast path's coordinates start, and which axes repeat.
struct Frame {
    std::array<real, 3> centre{0, 0, 0};
    std::array<real, 3> lo{0, 0, 0}, period{0, 0, 0};  // period 0: the axis does not repeat

    bool periodic() const { return period[0] > 0 || period[1] > 0 || period[2] > 0; }
    /// Particles closer than this to a side that repeats have an image beyond the other one: the radius, and as far as particles of this
    /// box have gone beyond a side.
    real band(std::size_t axis, const Box& particles, real radius) const;
    /// The cells for particles of this box and their images.
    CellGrid cover(const Box& particles, int count, real radius) const;
};

}  // namespace weir::particles
