// Random divergence-free velocities: the curl of random potentials; differences cancel around each cell up to round-off.
#pragma once
#include "mac/grid/velocity.hpp"

#include <cstdint>

namespace weir::mac {

/// u = ∇ × ψ with ψ (2D: on corners; 3D: on edges) uniform in ± speed h / 2, from `seed`; periodic in all axes, so valid on any sides.
template <int D>
void set_random_flow(MacVelocity<D>& u, real speed, std::uint64_t seed);

}  // namespace weir::mac
