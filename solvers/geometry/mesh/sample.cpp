// Distances to a closed surface of triangles on the nodes of a grid (Bridson's level sets of meshes, as in Bridson & Batty's SDFGen 2009).
// Exact at nodes near a triangle, propagated outwards by the nearest triangle of a neighbour (Tsai 2002). The sign is given by the winding
// number along rays in x; rays through an edge or a corner are perturbed by an infinitesimal common to all triangles.
#include "geometry/mesh/sample.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace weir::geometry {

namespace {

/// Squared distance to a triangle (Ericson 2005, section 5.1.5).
real squared_distance(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
    const Vec<3> ab = b - a, ac = c - a, ap = p - a;
    const auto to = [&](const Vec<3>& q) { return dot(p - q, p - q); };
    const real d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return to(a);
    const Vec<3> bp = p - b;
    const real d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return to(b);
    const real vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return to(a + (d1 / (d1 - d3)) * ab);
    const Vec<3> cp = p - c;
    const real d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return to(c);
    const real vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return to(a + (d2 / (d2 - d6)) * ac);
    const real va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return to(b + ((d4 - d3) / (d4 - d3 + d5 - d6)) * (c - b));
    const real sum = va + vb + vc;
    return to(a + (vb / sum) * ab + (vc / sum) * ac);
}

/// The side of the line from (x1, y1) to (x2, y2) on which the origin lies; never zero for distinct points.
int side(real x1, real y1, real x2, real y2) {
    const real area = y1 * x2 - x1 * y2;
    if (area != 0) return area > 0 ? 1 : -1;
    if (y2 != y1) return y2 > y1 ? 1 : -1;
    if (x1 != x2) return x1 > x2 ? 1 : -1;
    return 0;
}

}  // namespace

void MeshSampler::sample(Mesh& mesh, int resolution, const std::string& name) {
    const Vec<3> size = mesh.max_ - mesh.min_;
    mesh.h_ = std::max({size[0], size[1], size[2]}) / resolution;
    for (int a = 0; a < 3; ++a) mesh.nodes_[a] = static_cast<int>(std::ceil(size[a] / mesh.h_)) + 1 + 2 * margin;
    mesh.origin_ = 0.5 * (mesh.min_ + mesh.max_) - 0.5 * mesh.h_ * to_vec(mesh.nodes_ - Index<3>::constant(1));
    MeshSampler sampler(mesh);
    sampler.near_triangles();
    sampler.carry_outwards();
    sampler.find_inside(name);
}

MeshSampler::MeshSampler(Mesh& mesh) : mesh_(mesh), n_(mesh.nodes_), closest_(product(n_), -1), squared_(product(n_), infinity) {}

real MeshSampler::squared_to(std::int32_t triangle, const Vec<3>& x) const {
    const auto& c = mesh_.triangles_.corners[static_cast<std::size_t>(triangle)];
    const auto& p = mesh_.triangles_.points;
    return squared_distance(x, p[static_cast<std::size_t>(c[0])], p[static_cast<std::size_t>(c[1])], p[static_cast<std::size_t>(c[2])]);
}

void MeshSampler::offer(std::int32_t triangle, const Index<3>& I) {
    const std::size_t at = linear(I);
    if (const real d = squared_to(triangle, node(I)); d < squared_[at]) squared_[at] = d, closest_[at] = triangle;
}

void MeshSampler::near_triangles() {
    const auto& mesh = mesh_.triangles_;
    for (std::size_t t = 0; t < mesh.corners.size(); ++t) {
        Index<3> lo, hi;
        for (int a = 0; a < 3; ++a) {
            real least = infinity, most = -infinity;
            for (const int c : mesh.corners[t]) {
                const real x = mesh.points[static_cast<std::size_t>(c)][a];
                least = std::min(least, x), most = std::max(most, x);
            }
            lo[a] = std::max(0, static_cast<int>(std::floor((least - mesh_.origin_[a]) / mesh_.h_)) - exact);
            hi[a] = std::min(n_[a] - 1, static_cast<int>(std::ceil((most - mesh_.origin_[a]) / mesh_.h_)) + exact);
        }
        for (Index<3> I = lo; I[2] <= hi[2]; ++I[2])
            for (I[1] = lo[1]; I[1] <= hi[1]; ++I[1])
                for (I[0] = lo[0]; I[0] <= hi[0]; ++I[0]) offer(static_cast<std::int32_t>(t), I);
    }
}

void MeshSampler::carry_outwards() {
    for (int way = 0; way < 8; ++way) {
        Index<3> step, I;
        for (int a = 0; a < 3; ++a) step[a] = (way >> a) & 1 ? -1 : 1;
        const auto begin = [&](int a) { return step[a] > 0 ? 0 : n_[a] - 1; };
        const auto inside = [&](int a) { return I[a] >= 0 && I[a] < n_[a]; };
        for (I[2] = begin(2); inside(2); I[2] += step[2])
            for (I[1] = begin(1); inside(1); I[1] += step[1])
                for (I[0] = begin(0); inside(0); I[0] += step[0])
                    for (int neighbour = 1; neighbour < 8; ++neighbour) {
                        Index<3> J = I;
                        bool there = true;
                        for (int a = 0; a < 3; ++a)
                            if ((neighbour >> a) & 1) J[a] -= step[a], there = there && J[a] >= 0 && J[a] < n_[a];
                        if (!there) continue;
                        const std::int32_t theirs = closest_[linear(J)];
                        if (theirs >= 0 && theirs != closest_[linear(I)]) offer(theirs, I);
                    }
    }
}

/// Winding number of the surface around each node: 1 inside, 0 outside; other values mean overlaps or inverted cavities.
void MeshSampler::find_inside(const std::string& name) {
    const auto& mesh = mesh_.triangles_;
    std::vector<std::int16_t> enters(product(n_), 0);
    for (const auto& t : mesh.corners) {
        std::array<Vec<3>, 3> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = (1 / mesh_.h_) * (mesh.points[static_cast<std::size_t>(t[k])] - mesh_.origin_);
        Index<3> lo, hi;
        for (int a = 1; a < 3; ++a) {
            lo[a] = std::max(0, static_cast<int>(std::ceil(std::min({p[0][a], p[1][a], p[2][a]}))));
            hi[a] = std::min(n_[a] - 1, static_cast<int>(std::floor(std::max({p[0][a], p[1][a], p[2][a]}))));
        }
        for (int k = lo[2]; k <= hi[2]; ++k)
            for (int j = lo[1]; j <= hi[1]; ++j) {
                std::array<int, 3> sides;
                std::array<real, 3> weight;
                for (std::size_t c = 0; c < 3; ++c) {
                    const Vec<3>&u = p[(c + 1) % 3], &v = p[(c + 2) % 3];
                    sides[c] = side(u[1] - j, u[2] - k, v[1] - j, v[2] - k);
                    weight[c] = (u[2] - k) * (v[1] - j) - (u[1] - j) * (v[2] - k);
                }
                if (sides[0] == 0 || sides[0] != sides[1] || sides[1] != sides[2]) continue;
                const real x = (weight[0] * p[0][0] + weight[1] * p[1][0] + weight[2] * p[2][0]) / (weight[0] + weight[1] + weight[2]);
                const int i = std::clamp(static_cast<int>(std::ceil(x)), 0, n_[0] - 1);
                enters[linear({i, j, k})] = static_cast<std::int16_t>(enters[linear({i, j, k})] + sides[0]);
            }
    }
    mesh_.phi_.resize(product(n_));
    Index<3> I;
    for (I[2] = 0; I[2] < n_[2]; ++I[2])
        for (I[1] = 0; I[1] < n_[1]; ++I[1]) {
            int times = 0;
            for (I[0] = 0; I[0] < n_[0]; ++I[0]) {
                times += enters[linear(I)];
                if (times < 0 || times > 1) {
                    const Vec<3> x = node(I);
                    char text[160];
                    std::snprintf(text, sizeof text, ": the surface %s itself: around [%.4g, %.4g, %.4g] it winds %d times",
                                  times > 1 ? "overlaps" : "is oriented opposite to", x[0], x[1], x[2], times);
                    throw BadInput(name + text);
                }
                const std::size_t at = linear(I);
                mesh_.phi_[at] = static_cast<float>(times == 1 ? -std::sqrt(squared_[at]) : std::sqrt(squared_[at]));
            }
        }
}

}  // namespace weir::geometry
