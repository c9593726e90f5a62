// Shared by both models of a height field: depth and bed of each column, and gravity.
#pragma once
#include "core/effects.hpp"
#include "heightfield/plane.hpp"
#include "heightfield/sides.hpp"

namespace weir::heightfield {

/// Depth of the water, its discharge per metre of width (depth times mean velocity) along x and z, height of the bed. In 2D qz is empty.
struct State {
    Plane plane;
    Sides sides;
    real g = 0;             // downwards [m/s^2]
    real rho = 1;           // [kg/m^3]
    real push[2] = {0, 0};  // acceleration along x and z [m/s^2]
    real dry = 0;           // depth below which water is at rest [m]
    Field h, qx, qz, bed;   // [m], [m^2/s], [m^2/s], [m]
    real time = 0;          // at the start of the step [s]
    real net_inflow = 0;    // volume that came in through sides and as rain since the start, minus outflow [m^3]

    explicit State(const scene::Scene& scene, const Partition& partition = {});
    std::size_t bytes() const { return h.bytes() + qx.bytes() + qz.bytes() + bed.bytes(); }
};

}  // namespace weir::heightfield
