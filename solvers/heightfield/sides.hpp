// Boundary conditions of the plane, as ghost columns beyond its sides. Open sides follow the characteristics of the shallow-water equations
// (Stoker 1957, sec. 10.2): outgoing ones are determined by the last column, incoming ones by the scene.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <array>

namespace weir::heightfield {

enum class SideKind { wall, periodic, outflow, inflow, discharge, level };

struct Side {
    SideKind kind = SideKind::wall;
    real value = 0;  // inflow: velocity into the domain [m/s]; discharge: into the domain [m^2/s]; level: of the surface [m]
    real along = 0;  // inflow: velocity along the side [m/s]
};

/// Depth and velocity, normal to the side (outwards) and along it.
struct Beside {
    real h, out, along;
};

/// The ghost column of a side that is neither wall nor periodic, from the inner column: its depth, outward velocity and bed.
Beside beside(const Side& side, const Beside& inside, real bed, real g);

/// side[2 axis + end], axis 0 along x and 1 along z.
struct Sides {
    std::array<Side, 4> side;
    explicit Sides(const scene::Scene& scene);
    const Side& operator()(int axis, int end) const { return side[static_cast<std::size_t>(2 * axis + end)]; }
    bool open(int axis, int end) const {
        return (*this)(axis, end).kind != SideKind::wall && (*this)(axis, end).kind != SideKind::periodic;
    }
    bool any_open() const { return open(0, 0) || open(0, 1) || open(1, 0) || open(1, 1); }
};

}  // namespace weir::heightfield
