// Distance to the solids and bodies of a scene, for measurements near them.
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace weir::sim {

class SolidsAround {
public:
    virtual ~SolidsAround() = default;
    /// Moves them to time t [s]; bodies where the fields contain them.
    virtual void place(const FieldSet& fields, real t) = 0;
    /// Signed distance to the nearest of them [m], negative inside.
    virtual real distance(const Vec<3>& x) const = 0;
    /// The same to solids without motion.
    virtual real distance_to_still(const Vec<3>& x) const = 0;
};

/// nullptr where the scene has neither solids nor bodies.
std::unique_ptr<SolidsAround> solids_around(const scene::Scene& scene);

}  // namespace weir::sim
