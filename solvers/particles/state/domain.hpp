// The domain of particles, its sides and solids: confinement, removal at open sides, periodicity.
#pragma once
#include "geometry/sides.hpp"
#include "geometry/solids.hpp"
#include "particles/boundaries/walls.hpp"
#include "particles/state/boundary_corrections.hpp"
#include "particles/state/kernels.hpp"
#include "particles/threads/pairs.hpp"
#include "particles/threads/passes.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <memory>
#include <string>

namespace weir::rigid {
template <int D>
class Bodies;
}

namespace weir::particles {

template <int D>
struct Domain {
    Vec<D> lo{}, hi{};
    Vec<D> keep_lo{}, keep_hi{};  // `margin` inside the walls; infinite where there is none
    geometry::Sides<D> sides;
    geometry::Solids<D> solids;
    real spacing = 0;                          // of particles at rest [m]
    real margin = 0;                           // minimum distance of particles from walls and solids [m]
    std::shared_ptr<rigid::Bodies<D>> bodies;  // they follow the solids; nullptr where the scene has none

    Domain() = default;
    /// From "grid" (whose cells must be cubes: their width is the particle spacing), "sides", "solids" and "bodies".
    explicit Domain(const scene::Scene& scene);

    bool walled(int axis, int end) const {
        const auto kind = sides.side(axis, end).kind;
        return kind == geometry::SideKind::wall || kind == geometry::SideKind::moving_wall;
    }
    Vec<D> centre() const { return 0.5 * (lo + hi); }
    /// Index of the first body among the solids.
    std::size_t first_body() const;
    Frame frame() const;
    /// The closest point inside the walls and outside the solids.
    Vec<D> kept(Vec<D> x) const {
        if (!solids.empty()) x = solids.push_out(x, margin, 1e-3 * spacing);
        for (int a = 0; a < D; ++a) x[a] = std::min(std::max(x[a], keep_lo[a]), keep_hi[a]);
        return x;
    }
    /// The same; records the boundary correction.
    Vec<D> kept(const Vec<D>& x, BoundaryCorrections& corrections) const {
        const Vec<D> y = kept(x);
        if (const real by = norm(y - x); by > least_correction * spacing) corrections.add(1, by);
        return y;
    }
    Vec<D> wrapped(Vec<D> x) const;
    /// Returns whether x is beyond an open side (the particle is removed), or, as an error, beyond a wall or inside a solid.
    bool left(const Vec<D>& x) const;
    bool outside(const Vec<D>& x) const;
    /// The walls in the coordinates of the fast path. density and gradient: the kernels that use them.
    template <class Params>
    Params walls(const Kernel<D>& density, const Kernel<D>& gradient) const;
};

/// Rejects unsupported sides and solids: inflow sides (particles enter by emitters), and no-slip walls without viscosity; `instead` is the
/// advice in the message.
template <int D>
void refuse_idle_walls(const scene::Scene& scene, const Domain<D>& domain, bool viscous, const std::string& instead);

}  // namespace weir::particles
