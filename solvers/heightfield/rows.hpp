// One stage of the shallow-water scheme, row by row: reconstruction along x and z, fluxes, new depth and discharge. A row's intermediate
// values stay in the thread's nearest cache. Every face is computed in the same way by all threads, so that the result does not depend on
// their number.
//
//   h_t + div q = 0,   q_t + div(q q/h) + grad(g h^2/2) = -g h grad b
//
// Audusse, Bouchut, Bristeau, Klein & Perthame 2004: depth h, surface h + b and velocity are reconstructed at the faces with a limiter
// (second order). The depths there are taken over the higher of both beds, h* = max(0, h + b - max(b_left, b_right)), and the difference, g
// (h^2 - h*^2)/2, is added to the momentum of each side. The scheme is well balanced (water at rest stays at rest), and depths stay
// nonnegative while dt times the sum over the axes of (|u| + c)/dx is at most 1/2. HLLC fluxes (Toro 2001) with the speeds of Einfeldt and,
// at a dry edge, of Ritter.
#pragma once
#include "heightfield/state.hpp"

#include <string>

namespace weir::heightfield {

enum class Limiter { none, minmod, van_leer, mc };
Limiter limiter_named(const std::string& name);

/// Depth and discharges of all columns, input or output of a stage.
struct Water {
    real *h, *qx, *qz;
};

/// to = from + dt L(from), or for the second stage of Heun's method  to = (to + from + dt L(from)) / 2.
struct StageOf {
    const State& state;  // plane, sides, bed, gravity
    Water from, to;
    real dt = 0;
    bool second = false;
};

/// The sums and extrema of a row in a stage.
struct RowReport {
    real volume = 0;   // [m^2]: sum of depths times dx
    real rate = 0;     // max (|u| + c)/dx + (|w| + c)/dz [1/s]; of second stages
    real lowest = 0;   // depth before it is raised to 0 [m]
    real through = 0;  // volume inflow through the ends of the row, and for the first and last row through their sides [m^3]
};

/// Scratch of the threads, and the stages.
class Rows {
public:
    Rows(const Plane& plane, Limiter limiter);
    /// One report per row.
    void stage(const StageOf& stage, std::vector<RowReport>& reports);
    std::size_t bytes() const;

private:
    Plane plane_;
    Limiter limiter_;
    std::vector<std::vector<real>> scratch_;  // one per thread
};

}  // namespace weir::heightfield
