// What the particles of PBF and the bodies among them do to each other, summed on the host whatever the backend: positions are float4 of
// sorted particles, as the passes have them, with what the multiplier changes by as their fourth number.
#pragma once
#include "particles/bodies_in_liquid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

namespace weir::pbf {

/// Particles whose prediction would be inside a body push it, and x* gets what the body gives way. False where none does.
template <int D>
bool push_ahead(particles::BodiesInLiquid<D>& bodies, particles::Fluid<D>& fluid,
                std::type_identity_t<std::array<std::vector<real>, D>>& x_star, real dt);

/// An iteration of all particles, each an entry.
struct Multipliers {
    float* four = nullptr;           // x, y, z, and what the multiplier changes by
    float* sum = nullptr;            // over the step, where it is kept; else null
    const float* density = nullptr;  // over the rest density; null in a warm start, where it is not known yet
    const float* rest = nullptr;     // density that each is to have, over the rest density; null: 1
};

/// Change of a pushing multiplier λ = −C/(Σ|∇C|² + ε) per change of C. `give`, which a particle beside a wall has, is right within a factor
/// of 2 in a liquid, and iterations that answer a constraint up to twice as strongly as it is still converge. A particle between a body and
/// a wall has few neighbours, and gradients that cancel: λ is many times as stiff, and iterations with `give` throw the body. There it is
/// λ's own. (λ/C is meaningless where C is round-off.)
inline real stiffness(real lambda, real constraint, real give) {
    const real own = std::abs(constraint) > 1e-5 ? -lambda / constraint : give;
    return own > 2 * give ? own : give;
}

/// In one iteration bodies go as far as the multipliers of the particles that they meet push, which change by what they give way (by the
/// stiffness of their closing). give: of a particle beside a wall [m^2].
template <int D>
void carry(particles::BodiesInLiquid<D>& bodies, particles::Domain<D>& domain, const Multipliers& all, real give, real dt);

/// Particles `near`, which stood at `before` (D numbers each) and have been put out of bodies, push them on, and give way with them. False
/// where none does.
template <int D>
bool push_on(particles::BodiesInLiquid<D>& bodies, particles::Domain<D>& domain, const std::vector<int>& near, const float* before,
             float* four, real dt);

}  // namespace weir::pbf
