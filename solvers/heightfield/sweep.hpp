// Columns of water as real-time graphics moves them (Kass & Miller 1990; Mueller 2008): each column is accelerated by the height
// differences to its neighbours,
//     dw/dt = sum over neighbours of k (s_neighbour - s),   ds/dt = w,   k = g D / dx^2,
// s the height of its surface, w the speed at which that rises, D the still depth at the face between both: the linear wave equation, with
// c = sqrt(g D). Symplectic Euler: w first, then s by the new w; stable while dt^2 times the sum of k over a column's faces is at most 2.
#pragma once
#include "heightfield/plane.hpp"

#include <vector>

namespace weir::heightfield {

/// k of the faces on the lower sides of columns [1/s^2]: along x nx + 1 a row, along z nz + 1 rows; 0 where nothing passes. The first and
/// the last of a periodic axis are the same face.
struct Stiffness {
    Field x, z;
    bool uniform = false;  // the same k at all inner faces of an axis, none at the ends
    real along_x = 0, along_z = 0;
    std::size_t bytes() const { return x.bytes() + z.bytes(); }
};

/// One step of all columns in one sweep over memory; rows that a thread's neighbour overwrites are kept before.
class Sweep {
public:
    Sweep(const Plane& plane, bool periodic_x, bool periodic_z);
    void step(Field& surface, Field& rate, const Stiffness& k, real dt);
    std::size_t bytes() const;

private:
    /// The rows of this rank, all in one process, in parts of so many.
    struct OwnRows {
        int begin, end;
        explicit OwnRows(const Plane& plane) : begin(detail::own_share.lower(0)), end(detail::own_share.upper(plane.nz)) {}
        int parts() const;
        int part_begin(int p) const;
        int part_end(int p) const;
        bool has(int row) const { return row >= begin && row < end; }
    };
    void part(const OwnRows& own, int p, Field& surface, Field& rate, const Stiffness& k, real dt, real* scratch);
    Plane plane_;
    bool periodic_x_, periodic_z_;
    std::vector<std::vector<real>> scratch_;  // one a thread: two rows
    std::vector<real> edges_;                 // the first and the last row of each part, as they were
};

/// The same, one column after the other.
void reference_sweep(const Plane& plane, bool periodic_x, bool periodic_z, Field& surface, Field& rate, const Stiffness& k, real dt);

}  // namespace weir::heightfield
