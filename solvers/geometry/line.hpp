// Intersection of a line with a shape: intervals, exact to the last bit. Along a line the signed distance of a convex shape is convex: its
// minimum is found by golden-section search (Kiefer 1953), for any thickness of the shape, and both ends by bisection from there. Unions
// and differences use interval operations. For other shapes (meshes) the line is sphere-traced (Hart 1996), with steps of at least a 4096th
// of it.
#pragma once
#include "geometry/motion.hpp"
#include "geometry/shape.hpp"

#include <vector>

namespace weir::geometry {

struct Interval {
    real low = 0, high = 0;
};

/// The line through x along one coordinate from `low` to `high`, in a pose of the shape.
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

/// The part inside, from low to high; touching intervals are merged.
template <int D>
void find_inside(const Shape<D>& shape, const Line<D>& line, std::vector<Interval>& inside);

}  // namespace weir::geometry
