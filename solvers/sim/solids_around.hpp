// Where the solids and bodies of a scene are, for those who measure beside them.
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace weir::sim {

class SolidsAround {
public:
    virtual ~SolidsAround() = default;
    /// Where they are at time t [s]; bodies where the fields show them.
    virtual void place(const FieldSet& fields, real t) = 0;
    /// To the nearest of them [m], negative inside.
    virtual real distance(const Vec<3>& x) const = 0;
    /// The same to solids that never move.
    virtual real distance_to_still(const Vec<3>& x) const = 0;
};

/// Nothing where the scene has neither solids nor bodies.
std::unique_ptr<SolidsAround> solids_around(const scene::Scene& scene);

}  // namespace weir::sim
