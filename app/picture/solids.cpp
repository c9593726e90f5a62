#include "app/picture/solids.hpp"

#include "geometry/mesh/mesh.hpp"

namespace weir::picture {

namespace {

Vec<3> cross_of(const Vec<3>& a, const Vec<3>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// Edges at which the surface turns by more than this are sharp [cosine].
constexpr real sharp = 0.7;

/// At each corner of each triangle: the mean of the triangles around it that lie about as it does, by their areas.
std::vector<Vec<3>> corner_normals(const std::vector<Vec<3>>& points, const std::vector<std::array<int, 3>>& corners) {
    const auto at = [&](int i) -> const Vec<3>& { return points[static_cast<std::size_t>(i)]; };
    std::vector<Vec<3>> flat(corners.size()), normals(3 * corners.size());
    std::vector<std::vector<std::size_t>> around(points.size());
    for (std::size_t t = 0; t < corners.size(); ++t) {
        flat[t] = cross_of(at(corners[t][1]) - at(corners[t][0]), at(corners[t][2]) - at(corners[t][0]));
        for (const int c : corners[t]) around[static_cast<std::size_t>(c)].push_back(t);
    }
    for (std::size_t t = 0; t < corners.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            Vec<3> sum{};
            for (const std::size_t other : around[static_cast<std::size_t>(corners[t][k])])
                if (dot(flat[t], flat[other]) >= sharp * norm(flat[t]) * norm(flat[other])) sum += flat[other];
            normals[3 * t + k] = sum / std::max(norm(sum), 1e-300);
        }
    return normals;
}

}  // namespace

SolidRays::SolidRays(const View& view, const Box& domain)
    : domain_(domain),
      size_(norm(domain.max - domain.min)),
      solids_(rigid::ShownSolids<3>(view.scene).at(view.frame.time, bodies_of(view.frame))),
      bodies_(solids_.count() - view.scene.root().tables("bodies").size()) {
    for (std::size_t i = 0; i < solids_.count(); ++i) {
        const geometry::PosedMesh* mesh = can_trace_meshes() ? solids_[i].shape->mesh() : nullptr;
        if (mesh)
            add_triangles(*mesh, solids_.pose(i), i >= bodies_);
        else
            round_.push_back(i);
    }
    if (!mesh_.corners.empty()) rays_ = std::make_unique<MeshRays>(mesh_);
}

void SolidRays::add_triangles(const geometry::PosedMesh& posed, const geometry::Pose<3>& pose, bool body) {
    const geometry::Triangles& triangles = posed.mesh->triangles();
    std::vector<Vec<3>> points;
    points.reserve(triangles.points.size());
    for (const Vec<3>& y : triangles.points) points.push_back(pose.to_world(posed.to_scene(y)));
    const auto normals = corner_normals(points, triangles.corners);
    mesh_.normals.insert(mesh_.normals.end(), normals.begin(), normals.end());
    for (const auto& t : triangles.corners) {
        const int first = static_cast<int>(mesh_.points.size());
        for (const int c : t) {
            const auto i = static_cast<std::size_t>(c);
            mesh_.points.push_back(points[i]);
            Colour linear{};
            for (int a = 0; a < 3 && !triangles.colours.empty(); ++a) linear[a] = std::pow(triangles.colours[i][a], 2.2);
            colours_.push_back(linear);
        }
        mesh_.corners.push_back({first, first + 1, first + 2});
        coloured_.push_back(!triangles.colours.empty()), of_body_.push_back(body);
    }
}

real SolidRays::round_distance(const Vec<3>& x, std::size_t* which) const {
    real least = infinity;
    for (const std::size_t i : round_)
        if (const real d = solids_.distance(i, x); d < least) {
            least = d;
            if (which) *which = i;
        }
    return least;
}

SolidRays::Hit SolidRays::first(const Ray& ray, real limit) const {
    Hit hit;
    const auto span = domain_.span(ray);  // solids are cut where the domain ends, meshes are not
    if (span && !round_.empty()) {
        const real close = 2e-5 * size_, end = std::min(span->second, limit);
        real s = span->first;
        for (int i = 0; i < 200 && s < end; ++i) {
            const real d = round_distance(ray.at(s));
            if (d < close) {
                hit.distance = s;
                break;
            }
            s += d;
        }
    }
    if (rays_)
        if (const MeshRays::Hit met = rays_->first(ray); met && met.distance < std::min(limit, hit.distance)) {
            const auto t = static_cast<std::size_t>(met.triangle);
            const Vec<3> n = rays_->at(met, mesh_.normals);
            return {met.distance, n / std::max(norm(n), 1e-9), rays_->at(met, colours_), coloured_[t] != 0, of_body_[t] != 0};
        }
    if (!hit) return hit;
    const Vec<3> x = ray.at(hit.distance);
    std::size_t which = 0;
    round_distance(x, &which);
    const real eps = 1e-4 * size_;
    for (int a = 0; a < 3; ++a)
        hit.normal[a] = solids_.distance(which, x + eps * Vec<3>::unit(a)) - solids_.distance(which, x - eps * Vec<3>::unit(a));
    hit.normal = hit.normal / std::max(norm(hit.normal), 1e-300);
    hit.body = which >= bodies_;
    return hit;
}

}  // namespace weir::picture
