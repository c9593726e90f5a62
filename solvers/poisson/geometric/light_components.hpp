// Connected components of the lighter of two phases: bubbles, and the gas above the liquid.
#pragma once
#include "poisson/poisson.hpp"

namespace weir::poisson {

struct LightComponents {
    std::vector<int> of;      // of each cell, −1 outside the lighter phase
    std::vector<int> extent;  // largest side of each component's bounding box [cells]; across a periodic side, the side of the domain
    int count() const { return static_cast<int>(extent.size()); }
    std::size_t bytes() const { return (of.capacity() + extent.capacity()) * sizeof(int); }
};

/// `light`: 1 in fluid cells of the lighter phase, all planes. Neighbours along an axis are connected, whatever the face between them.
template <int D>
void find_light_components(const Grid<std::uint8_t, D>& light, const std::array<bool, D>& periodic, LightComponents& found);

}  // namespace weir::poisson
