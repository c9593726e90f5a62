#include "rigid/contact_spheres.hpp"

#include "geometry/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace weir::rigid {

namespace {

constexpr int along_edge = 4, around_rim = 16;  // points per edge and per rim
constexpr std::size_t on_mesh = 160;

/// Rounding radius of edges and rims, relative to the smallest extent: exact against a plane, and a corner on another body's edge touches
/// its face.
constexpr real rounded = 0.02;

template <int D>
void edges_of_box(Vec<D> min, Vec<D> max, std::vector<ContactSphere<D>>& list) {
    real r = infinity;
    for (int a = 0; a < D; ++a) r = std::min(r, rounded * (max[a] - min[a]));
    min += Vec<D>::constant(r), max -= Vec<D>::constant(r);
    for (int corner = 0; corner < 1 << D; ++corner) {
        Vec<D> x;
        for (int a = 0; a < D; ++a) x[a] = (corner >> a) & 1 ? max[a] : min[a];
        list.push_back({x, r});
        for (int a = 0; a < D; ++a) {
            if ((corner >> a) & 1) continue;  // each edge once, from its lower end
            for (int i = 1; i < along_edge; ++i) {
                Vec<D> y = x;
                y[a] += (max[a] - min[a]) * i / along_edge;
                list.push_back({y, r});
            }
        }
    }
}

/// Any unit vector perpendicular to u.
Vec<3> across(const Vec<3>& u) {
    const int least =
        std::abs(u[0]) < std::abs(u[1]) ? (std::abs(u[0]) < std::abs(u[2]) ? 0 : 2) : (std::abs(u[1]) < std::abs(u[2]) ? 1 : 2);
    const Vec<3> v = Vec<3>::unit(least) - u[least] * u;
    return v / norm(v);
}

template <int D>
void rims_of_cylinder(Vec<D> from, Vec<D> to, real radius, std::vector<ContactSphere<D>>& list) {
    const Vec<D> u = (to - from) / norm(to - from);
    const real r = rounded * std::min(norm(to - from), 2 * radius);
    from += r * u, to -= r * u, radius -= r;
    for (int i = 0; i <= along_edge; ++i) {
        const Vec<D> x = from + (static_cast<real>(i) / along_edge) * (to - from);
        if constexpr (D == 2) {
            const Vec<2> side{{-u[1], u[0]}};
            list.push_back({x + radius * side, r}), list.push_back({x - radius * side, r});
        } else {
            if (i != 0 && i != along_edge / 2 && i != along_edge) continue;
            const Vec<3> v = across(u), w{{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]}};
            for (int k = 0; k < around_rim; ++k) {
                const real angle = 2 * pi * k / around_rim;
                list.push_back({x + radius * (std::cos(angle) * v + std::sin(angle) * w), r});
            }
        }
    }
}

/// Contact spheres of a mesh: the outermost vertices in 26 directions, on which flat sides rest, then repeatedly the vertex farthest from
/// all selected ones. Each sphere lies inside as far as the distance there allows.
std::vector<ContactSphere<3>> corners_of_mesh(const geometry::Shape<3>& shape) {
    const geometry::PosedMesh& posed = *shape.mesh();
    const auto& points = posed.mesh->triangles().points;
    const Vec<3> size = posed.mesh->max() - posed.mesh->min();
    const real depth = rounded * posed.scale * std::min({size[0], size[1], size[2]});
    std::vector<ContactSphere<3>> list;
    std::vector<real> away(points.size(), infinity);
    const auto take = [&](std::size_t i) {
        if (away[i] == 0) return;
        for (std::size_t k = 0; k < points.size(); ++k) away[k] = std::min(away[k], norm(points[k] - points[i]));
        Vec<3> inwards;
        const Vec<3> x = posed.to_scene(points[i]);
        for (int a = 0; a < 3; ++a) inwards[a] = shape.distance(x - depth * Vec<3>::unit(a)) - shape.distance(x + depth * Vec<3>::unit(a));
        const real length = norm(inwards);
        const Vec<3> middle = length > 0 ? x + (depth / length) * inwards : x;
        list.push_back({middle, std::max(0.0, std::min(depth, -shape.distance(middle)))});
    };
    for (int code = 0; code < 27; ++code) {
        const Vec<3> way{{code % 3 - 1.0, code / 3 % 3 - 1.0, code / 9 - 1.0}};
        const auto less = [&](const Vec<3>& a, const Vec<3>& b) { return dot(way, a) < dot(way, b); };
        if (code != 13) take(static_cast<std::size_t>(std::max_element(points.begin(), points.end(), less) - points.begin()));
    }
    while (list.size() < std::min(on_mesh, points.size())) {
        const auto furthest = std::max_element(away.begin(), away.end());
        if (*furthest == 0) break;
        take(static_cast<std::size_t>(furthest - away.begin()));
    }
    return list;
}

/// Keeps the spheres for which f holds.
template <int D, class F>
void keep(std::vector<ContactSphere<D>>& list, F&& f) {
    list.erase(std::remove_if(list.begin(), list.end(), [&](const ContactSphere<D>& x) { return !f(x); }), list.end());
}

/// Spheres of a union's part inside another part are removed.
template <int D>
std::vector<ContactSphere<D>> of_union(const scene::Table& shape, real rounding) {
    const auto whole = geometry::make_shape<D>(shape);
    std::vector<ContactSphere<D>> list;
    for (const auto& part : shape.tables("of"))
        for (const auto& sphere : contact_spheres_of<D>(part)) list.push_back(sphere);
    keep<D>(list, [&](const ContactSphere<D>& f) { return whole->distance(f.at) + f.radius > -rounding; });
    return list;
}

/// A ball with a hole still collides as a ball; corners that were cut away do not.
template <int D>
std::vector<ContactSphere<D>> of_difference(const scene::Table& shape, real rounding) {
    std::vector<ContactSphere<D>> list = contact_spheres_of<D>(shape.table("from"));
    if (const std::string& kind = shape.text("from.shape"); kind == "sphere" || kind == "capsule") return list;
    const auto whole = geometry::make_shape<D>(shape);
    keep<D>(list, [&](const ContactSphere<D>& f) { return whole->distance(f.at) + f.radius < rounding; });
    return list;
}

}  // namespace

template <int D>
std::vector<ContactSphere<D>> contact_spheres_of(const scene::Table& shape) {
    const std::string& kind = shape.text("shape");
    std::vector<ContactSphere<D>> list;
    if (kind == "box") edges_of_box<D>(shape.vec<D>("min"), shape.vec<D>("max"), list);
    if (kind == "sphere") list.push_back({shape.vec<D>("centre"), shape.number("radius")});
    if (kind == "cylinder") rims_of_cylinder<D>(shape.vec<D>("from"), shape.vec<D>("to"), shape.number("radius"), list);
    if (kind == "capsule")
        for (int i = 0; i <= along_edge; ++i)
            list.push_back({shape.vec<D>("from") + (static_cast<real>(i) / along_edge) * (shape.vec<D>("to") - shape.vec<D>("from")),
                            shape.number("radius")});
    if constexpr (D == 3)
        if (kind == "mesh") return corners_of_mesh(*geometry::make_shape<3>(shape));
    if (kind != "union" && kind != "difference") return list;
    const Bounds<D> box = bounds_of<D>(shape);
    const real rounding = 1e-9 * norm(box.max - box.min);
    return kind == "union" ? of_union<D>(shape, rounding) : of_difference<D>(shape, rounding);
}

template std::vector<ContactSphere<2>> contact_spheres_of<2>(const scene::Table&);
template std::vector<ContactSphere<3>> contact_spheres_of<3>(const scene::Table&);

}  // namespace weir::rigid
