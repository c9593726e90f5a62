// Where a line lies inside a shape: intervals, exact to the last bit. Along a line the signed distance of a convex shape is convex, so its
// least is found by golden sections (Kiefer 1953) however thin the shape is, and both ends by bisection from there. Unions and differences
// are those of intervals. Of other shapes (meshes) the line is walked by the distance itself (Hart 1996), at least by a 4096th of it.
#pragma once
#include "geometry/motion.hpp"
#include "geometry/shape.hpp"

#include <vector>

namespace weir::geometry {

struct Interval {
    real low = 0, high = 0;
};

/// The points with one coordinate from `low` to `high` and the others of x, at a pose of the shape.
template <int D>
struct Line {
    Vec<D> x{};
    int axis = 1;
    real low = 0, high = 0;
    Pose<D> pose{};
    Vec<D> at(real y) const {
        Vec<D> p = x;
        p[axis] = y;
        return pose.to_rest(p);
    }
};

/// What of it is inside, from low to high; intervals that touch are one.
template <int D>
void find_inside(const Shape<D>& shape, const Line<D>& line, std::vector<Interval>& inside);

}  // namespace weir::geometry
