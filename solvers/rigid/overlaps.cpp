#include "rigid/overlaps.hpp"

#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::rigid {

namespace {

/// Relative to a body's radius: the depth at which contacts leave bodies at rest (contacts.cpp).
constexpr real touching = 1e-3;

constexpr const char* advice = "place bodies so that they do not overlap walls, solids or each other";

template <int D>
std::string label(const scene::Scene& scene, std::size_t b) {
    const scene::Table& table = scene.root().tables("bodies")[b];
    const std::string path = fmt::format("bodies[{}]", b);
    return table.has("name") ? path + " (" + scene::quote(table.text("name")) + ")" : path;
}

/// Radius of the largest ball inside both: sampled on a lattice over a box, then refined from its best point with decreasing steps. Where
/// one distance is limiting, a fraction of the other guides the search.
template <int D>
real common_radius(const geometry::Shape<D>& body, const geometry::Shape<D>& other, const Bounds<D>& box) {
    constexpr int points = D == 2 ? 24 : 12;
    constexpr real part = 0.05;
    const auto inside = [&](const Vec<D>& x, real lead) {
        const real a = body.distance(x), b = other.distance(x);
        return -std::max(a, b) - lead * (a + b);
    };
    std::size_t count = 1;
    for (int a = 0; a < D; ++a) count *= points;
    Vec<D> best{}, step = (1.0 / points) * (box.max - box.min);
    real most = -infinity;
    for (std::size_t i = 0; i < count; ++i) {
        Vec<D> x;
        std::size_t rest = i;
        for (int a = 0; a < D; ++a, rest /= points) x[a] = box.min[a] + (static_cast<real>(rest % points) + 0.5) * step[a];
        if (const real r = inside(x, part); r > most) most = r, best = x;
    }
    for (int halving = 0; halving < 12; step = 0.5 * step, ++halving)
        for (int a = 0; a < D; ++a)
            for (const real way : {-0.5, 0.5}) {
                const Vec<D> x = best + way * step[a] * Vec<D>::unit(a);
                if (const real r = inside(x, part); r > most) most = r, best = x;
            }
    return std::max(0.0, inside(best, 0));
}

/// The solids of a scene at t = 0.
template <int D>
struct Posed final : geometry::Shape<D> {
    geometry::ShapePtr<D> shape;
    geometry::Pose<D> pose;
    real distance(const Vec<D>& x) const override { return shape->distance(pose.to_rest(x)); }
    real steepest() const override { return shape->steepest(); }
    Vec<D> centre() const override { return pose.to_world(shape->centre()); }
    std::string code() const override { return {}; }
};

template <int D>
bool held(const Body<D>& body) {
    return std::all_of(body.held.begin(), body.held.end(), [](bool h) { return h; });
}

template <int D>
void refuse_in_walls(const scene::Scene& scene, const std::vector<Body<D>>& bodies, const Surroundings<D>& around, std::size_t b) {
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            if (!around.wall[static_cast<std::size_t>(2 * a + end)]) continue;
            real depth = 0;
            for (const ContactSphere<D>& sphere : bodies[b].contact_spheres)
                depth = std::max(depth, sphere.radius + (end == 0 ? around.min[a] - sphere.at[a] : sphere.at[a] - around.max[a]));
            if (depth > touching * bodies[b].radius)
                scene.refuse(fmt::format("bodies[{}]", b),
                             fmt::format("{} overlaps the wall {}_{} at {} = {:.6g} m by {:.4g} m", label<D>(scene, b), "xyz"[a],
                                         end == 0 ? "min" : "max", "xyz"[a], end == 0 ? around.min[a] : around.max[a], depth),
                             advice);
        }
}

}  // namespace

template <int D>
real depth_in(const Body<D>& body, const Bounds<D>& box, const geometry::Shape<D>& other) {
    if (other.distance(body.centre) >= other.steepest() * body.radius) return 0;
    real depth = 0;
    for (const ContactSphere<D>& sphere : body.contact_spheres) depth = std::max(depth, sphere.radius - other.distance(sphere.at));
    return depth > touching * body.radius ? depth : 2 * common_radius<D>(*body.shape, other, box);
}

template <int D>
void refuse_overlaps(const scene::Scene& scene, const std::vector<Body<D>>& bodies, const Joints<D>& joints,
                     const Surroundings<D>& around) {
    const auto& tables = scene.root().tables("bodies");
    const geometry::Solids<D> solids(scene);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Bounds<D> box = bounds_of<D>(tables[b]);
        if (!held(bodies[b])) refuse_in_walls(scene, bodies, around, b);
        for (std::size_t s = 0; s < solids.count() && !held(bodies[b]); ++s) {
            Posed<D> solid;
            solid.shape = solids[s].shape, solid.pose = solids.pose(s);
            if (const real depth = depth_in(bodies[b], box, solid); depth > touching * bodies[b].radius)
                scene.refuse(fmt::format("bodies[{}]", b),
                             fmt::format("{} overlaps solids[{}] by {:.4g} m", label<D>(scene, b), solids.in_list(s), depth), advice);
        }
        for (std::size_t o = 0; o < b; ++o) {
            if (joints.tie(b, o) || norm(bodies[b].centre - bodies[o].centre) >= bodies[b].radius + bodies[o].radius) continue;
            const real deepest =
                std::max(depth_in(bodies[b], box, *bodies[o].shape), depth_in(bodies[o], bounds_of<D>(tables[o]), *bodies[b].shape));
            if (deepest > touching * std::min(bodies[b].radius, bodies[o].radius))
                scene.refuse(fmt::format("bodies[{}]", b),
                             fmt::format("{} and {} overlap by {:.4g} m", label<D>(scene, o), label<D>(scene, b), deepest), advice);
        }
    }
}

#define WEIR_INSTANTIATE(D)                                                              \
    template real depth_in(const Body<D>&, const Bounds<D>&, const geometry::Shape<D>&); \
    template void refuse_overlaps(const scene::Scene&, const std::vector<Body<D>>&, const Joints<D>&, const Surroundings<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::rigid
