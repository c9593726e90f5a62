// Liquid at rest: the pressure is that of the weight above, p = rho g . (x - x_s) below the surface, whatever the direction of gravity.
#include "validation/harness/fitting.hpp"
#include "validation/harness/reference.hpp"

#include <algorithm>
#include <cmath>

using namespace weir;
using namespace weir::validation;

namespace {

Vec<3> in_3d(const std::vector<double>& list) {
    Vec<3> v{};
    for (std::size_t d = 0; d < std::min<std::size_t>(3, list.size()); ++d) v[d] = list[d];
    return v;
}

/// Largest g . (x - surface) / |g| over the corners of the domain: the depth of the water [m].
real greatest_depth(const scene::Scene& scene, const Vec<3>& down, const Vec<3>& surface) {
    const Vec<3> origin = in_3d(scene.root().numbers("grid.origin")), size = in_3d(scene.root().numbers("grid.size"));
    real depth = 0;
    for (int corner = 0; corner < 8; ++corner) {
        Vec<3> x = origin;
        for (int d = 0; d < 3; ++d)
            if (corner >> d & 1) x[d] += size[d];
        depth = std::max(depth, dot(down, x - surface));
    }
    return depth;
}

}  // namespace

// The liquid is the half space behind a plane whose normal is against gravity.
REFERENCE(hydrostatic) {
    const scene::Table& liquid = scene.root().tables("liquid").at(0);
    const Vec<3> g = in_3d(needed_effect(scene, "gravity").numbers("g")), surface = in_3d(liquid.numbers("point"));
    const real rho = scene.number("fluid.density");
    Reference ref{.source = "hydrostatics (exact)"};
    ref.scalars["pressure"] = [=](const Vec<3>& x, real) { return rho * dot(g, x - surface); };
    ref.covers = [=](const Vec<3>& x, real) { return dot(g, x - surface) > 0; };
    ref.numbers["depth"] = greatest_depth(scene, g / norm(g), surface);
    ref.numbers["gravity"] = norm(g);
    return ref;
}
