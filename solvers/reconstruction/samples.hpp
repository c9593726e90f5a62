// A scalar on a lattice: how far each point lies inside the liquid. Its zero is the surface.
#pragma once
#include "core/types.hpp"

#include <array>
#include <vector>

namespace weir::reconstruction {

struct Samples {
    std::array<int, 3> n{0, 0, 0};  // along each axis, x fastest
    Vec<3> first{};                 // where the first one stands [m]
    std::array<real, 3> spacing{1, 1, 1};
    real unit = 1;             // [m]
    std::vector<float> depth;  // inside the liquid, in units; negative outside, cut at -1 and 1

    std::size_t linear(int i, int j, int k) const {
        return static_cast<std::size_t>(i) +
               static_cast<std::size_t>(n[0]) *
                   (static_cast<std::size_t>(j) + static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(k));
    }
    Vec<3> position(int i, int j, int k) const {
        return {{first[0] + spacing[0] * i, first[1] + spacing[1] * j, first[2] + spacing[2] * k}};
    }
    /// Trilinear; the nearest sample's beyond the outermost.
    real at(const Vec<3>& x) const;
};

}  // namespace weir::reconstruction
