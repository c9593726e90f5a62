// Columns of water as in real-time graphics (Kass & Miller 1990; Mueller 2008): each column is accelerated by the height differences to its
// neighbours,
//     dw/dt = sum over neighbours of k (s_neighbour - s),   ds/dt = w,   k = g D / dx^2,
// s the height of its surface, w its vertical speed, D the still depth at the face between both: the linear wave equation, with c = sqrt(g
// D). Symplectic Euler: w first, then s with the new w; stable while dt^2 times the sum of k over a column's faces is at most 2.
#pragma once
#include "heightfield/plane.hpp"

#include <vector>

namespace weir::heightfield {

/// k of the faces on the lower sides of columns [1/s^2]: along x nx + 1 per row, along z nz + 1 rows; 0 for closed faces. The first and
/// last face of a periodic axis are the same.
struct Stiffness {
    Field x, z;
    bool uniform = false;  // k is constant on all inner faces of an axis, and zero at the ends
    real along_x = 0, along_z = 0;
    std::size_t bytes() const { return x.bytes() + z.bytes(); }
};

/// One step of all columns in one sweep over memory; rows that a neighbouring thread overwrites are copied first.
class Sweep {
public:
    Sweep(const Plane& plane, bool periodic_x, bool periodic_z);
    void step(Field& surface, Field& rate, const Stiffness& k, real dt);
    std::size_t bytes() const;

private:
    /// This rank's rows (all in one process), in parts of several rows.
    struct OwnRows {
        int begin, end;
        explicit OwnRows(const Plane& plane) : begin(plane.own.lower(0)), end(plane.own.upper(plane.nz)) {}
        int parts() const;
        int part_begin(int p) const;
        int part_end(int p) const;
        bool has(int row) const { return row >= begin && row < end; }
    };
    void part(const OwnRows& own, int p, Field& surface, Field& rate, const Stiffness& k, real dt, real* scratch);
    Plane plane_;
    bool periodic_x_, periodic_z_;
    std::vector<std::vector<real>> scratch_;  // one per thread: two rows
    std::vector<real> edges_;                 // the old first and last row of each part
};

/// The same, column by column.
void reference_sweep(const Plane& plane, bool periodic_x, bool periodic_z, Field& surface, Field& rate, const Stiffness& k, real dt);

}  // namespace weir::heightfield
