// What the particles of PBF and the bodies among them do to each other, summed on the host whatever the backend: positions are float4 of
// sorted particles, as the passes have them, with what the multiplier changes by as their fourth number.
#pragma once
#include "particles/bodies_in_liquid.hpp"

#include <array>
#include <type_traits>
#include <vector>

namespace weir::pbf {

/// Particles whose prediction would be inside a body push it, and x* gets what the body gives way. False where none does.
template <int D>
bool push_ahead(particles::BodiesInLiquid<D>& bodies, particles::Fluid<D>& fluid,
                std::type_identity_t<std::array<std::vector<real>, D>>& x_star, real dt);

/// In one iteration bodies go as far as the multipliers of the particles that they meet push, which change by what they give way (a
/// `give` of their closing). multiplier: the sums over the step, where they are kept; else null.
template <int D>
void carry(particles::BodiesInLiquid<D>& bodies, particles::Domain<D>& domain, float* four, float* multiplier, real give, real dt);

/// Particles `near`, which stood at `before` (D numbers each) and have been put out of bodies, push them on, and give way with them. False
/// where none does.
template <int D>
bool push_on(particles::BodiesInLiquid<D>& bodies, particles::Domain<D>& domain, const std::vector<int>& near, const float* before,
             float* four, real dt);

}  // namespace weir::pbf
