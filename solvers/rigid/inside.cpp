#include "rigid/inside.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

namespace weir::rigid {

namespace {

constexpr real passed = 0.1;  // depth of the centroid beyond a wall, relative to the radius of its bounding ball

/// A wall of the domain, the end of an axis.
struct Wall {
    int axis, end;
    real at;
    real beyond(real x) const { return end == 0 ? at - x : x - at; }
};

/// Velocity of the deepest contact point out of the domain. Contacts that hold make it negative.
template <int D>
real outward_velocity(const Body<D>& body, const geometry::Pose<D>& pose, const Wall& wall) {
    real deepest = -infinity;
    Vec<D> point = body.at;
    const Vec<D> out = (wall.end == 0 ? -1.0 : 1.0) * Vec<D>::unit(wall.axis);
    for (const ContactSphere<D>& sphere : body.contact_spheres) {
        const Vec<D> x = pose.to_world(sphere.at) + sphere.radius * out;
        if (const real depth = wall.beyond(x[wall.axis]); depth > deepest) deepest = depth, point = x;
    }
    return dot(pose.velocity_at(point), out);
}

template <int D>
[[noreturn]] void refuse(const Body<D>& body, std::size_t number, const Vec<D>& centre, const Wall& wall) {
    std::string at;
    for (int a = 0; a < D; ++a) at += fmt::format("{}{:.4g}", a ? ", " : "", centre[a]);
    const std::string name = body.name == std::to_string(number) ? "" : fmt::format(" (\"{}\")", body.name);
    const char axis = "xyz"[wall.axis];
    throw NumericalFailure("position", fmt::format("bodies[{}]{} is jammed: its centre, [{}] m, is beyond the wall {}_{} at {} = {:.6g} m; "
                                                   "a solid, a body or a joint pushes it against the wall",
                                                   number, name, at, axis, wall.end == 0 ? "min" : "max", axis, wall.at));
}

}  // namespace

template <int D>
void require_inside(const std::vector<Body<D>>& bodies, const Surroundings<D>& around) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const geometry::Pose<D> pose = bodies[b].pose();
        const Vec<D> centre = pose.to_world(bodies[b].moments.centre);
        for (int a = 0; a < D; ++a)
            for (const int end : {0, 1}) {
                const Wall wall{a, end, end == 0 ? around.min[a] : around.max[a]};
                if (!around.wall[static_cast<std::size_t>(2 * a + end)] || !(wall.beyond(centre[a]) > passed * bodies[b].radius)) continue;
                if (outward_velocity(bodies[b], pose, wall) > 0) refuse(bodies[b], b, centre, wall);
            }
    }
}

template void require_inside(const std::vector<Body<2>>&, const Surroundings<2>&);
template void require_inside(const std::vector<Body<3>>&, const Surroundings<3>&);

}  // namespace weir::rigid
