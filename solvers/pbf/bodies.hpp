// Coupling of PBF particles and bodies, summed on the host for every backend. Positions are float4 of sorted particles, in the layout of
// the passes, with the multiplier's change as fourth number.
#pragma once
#include "particles/boundaries/bodies_in_liquid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

namespace weir::pbf {

/// Particles whose predicted position is inside a body push it, and x* gets the body's response. Returns false where there are none.
template <int D>
bool push_ahead(particles::BodiesInLiquid<D>& bodies, particles::Fluid<D>& fluid,
                std::type_identity_t<std::array<std::vector<real>, D>>& x_star, real dt);

/// The data of an iteration, one entry per particle.
struct Multipliers {
    float* four = nullptr;           // x, y, z, and the change of the multiplier
    float* sum = nullptr;            // over the step, where it is stored; otherwise nullptr
    const float* density = nullptr;  // relative to the rest density; nullptr in a warm start, where it is not yet known
    const float* rest = nullptr;     // rest densities over rho0; nullptr: 1
};

/// Derivative of a pushing multiplier λ = −C/(Σ|∇C|² + ε) with respect to C. `give`, that of a particle beside a wall, is correct within a
/// factor of 2 in a liquid, and iterations with up to twice the exact response converge. A particle between a body and a wall has few
/// neighbours and gradients that cancel: its λ is many times as stiff, and iterations with `give` would eject the body. There λ's own value
/// is used. (λ/C is meaningless where C is round-off.)
inline real stiffness(real lambda, real constraint, real give) {
    const real own = std::abs(constraint) > 1e-5 ? -lambda / constraint : give;
    return own > 2 * give ? own : give;
}

/// One iteration: bodies move by the multipliers of the particles in contact, which are reduced by the bodies' motion (in proportion to
/// their approach). give: of a particle beside a wall [m^2].
template <int D>
void carry(particles::BodiesInLiquid<D>& bodies, particles::Domain<D>& domain, const Multipliers& all, real give, real dt);

/// The particles `near`, moved out of bodies from their positions `before` (D numbers each), push the bodies and move with their response.
/// Returns false where there are none.
template <int D>
bool push_on(particles::BodiesInLiquid<D>& bodies, particles::Domain<D>& domain, const std::vector<int>& near, const float* before,
             float* four, real dt);

}  // namespace weir::pbf
