// One stage of the shallow-water scheme, row by row: reconstruction along x and z, fluxes through both, new depth and discharge. A row's
// intermediate values stay in the cache nearest to the thread that has it; every face is computed alike whoever computes it, so that the
// result does not depend on the number of threads.
//
//   h_t + div q = 0,   q_t + div(q q/h) + grad(g h^2/2) = -g h grad b
//
// Audusse, Bouchut, Bristeau, Klein & Perthame 2004: depth h, surface h + b and velocity are reconstructed to the faces with a limiter
// (second order), the depths there are taken over the higher of both beds, h* = max(0, h + b - max(b_left, b_right)), and what differs,
// g (h^2 - h*^2)/2, goes into the momentum of each side: water at rest stays at rest, and no depth becomes negative while dt times the sum
// over the axes of (|u| + c)/dx is at most 1/2. HLLC fluxes (Toro 2001) with the speeds of Einfeldt and, at a dry edge, of Ritter.
#pragma once
#include "heightfield/state.hpp"

#include <string>

namespace weir::heightfield {

enum class Limiter { none, minmod, van_leer, mc };
Limiter limiter_named(const std::string& name);

/// Depth and discharges of all columns, as one stage reads or writes them.
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

/// What a stage says of each row.
struct RowReport {
    real volume = 0;   // [m^2]: sum of depths times dx
    real rate = 0;     // max (|u| + c)/dx + (|w| + c)/dz [1/s]; of second stages
    real lowest = 0;   // depth before it is raised to 0 [m]
    real through = 0;  // volume that came in through the ends of the row, and of the first and last row through their sides [m^3]
};

/// Scratch of the threads, and the stages.
class Rows {
public:
    Rows(const Plane& plane, Limiter limiter);
    /// One report a row.
    void stage(const StageOf& stage, std::vector<RowReport>& reports);
    std::size_t bytes() const;

private:
    Plane plane_;
    Limiter limiter_;
    std::vector<std::vector<real>> scratch_;  // one a thread
};

}  // namespace weir::heightfield
