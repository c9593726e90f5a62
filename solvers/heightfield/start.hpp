// The state at t = 0: bed from terrain and solids, water from shapes or a formula for its surface, velocity.
#pragma once
#include "geometry/solids.hpp"
#include "heightfield/state.hpp"

#include <functional>
#include <memory>

namespace weir::heightfield {

/// Height of the bed of each column, without solids. In parallel each rank computes the rows that it stores, as all functions below.
Field make_terrain(const scene::Scene& scene, const Plane& plane);
/// Fills depth, discharge and bed.
void start(const scene::Scene& scene, State& state);

/// Solids standing on the bed raise it: where one covers a column, the bed is the solid's top, in part where it covers a part. Moving
/// solids raise and lower the bed.
class RaisedBed {
public:
    virtual ~RaisedBed() = default;
    /// The bed of these rows at time t.
    virtual void at(real t, const Field& terrain, const std::vector<PlaneRange>& rows, Field& bed) = 0;
    virtual bool moves() const = 0;
};
/// nullptr without solids.
std::unique_ptr<RaisedBed> make_raised_bed(const scene::Scene& scene, const Plane& plane);

}  // namespace weir::heightfield
