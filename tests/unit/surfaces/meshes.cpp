// What is done to meshes and lattices, and what is measured of them.
#include "liquids.hpp"
#include "support/test.hpp"
#include "surfaces/contour.hpp"
#include "surfaces/finish.hpp"
#include "surfaces/prepare.hpp"

#include <numbers>

namespace meshes_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// Distance to a ball of radius r about the middle, on n samples a metre apart.
template <class Depth>
Samples samples_of(int n, const Depth& depth) {
    Samples samples;
    samples.n = {n, n, n};
    samples.make_room();
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) samples(i, j, k) = static_cast<float>(std::clamp(depth(samples.position(i, j, k)), -1.0, 1.0));
    return samples;
}

SurfaceMesh contoured(Samples samples) {
    avoid_zero(samples);
    SurfaceMesh mesh;
    contour(samples, mesh);
    return mesh;
}

/// Each sample inside or outside by chance: every kind of meeting of sheets.
Samples noise(int n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<real> depth(-1, 1);
    return samples_of(n, [&](const Vec<3>&) { return depth(random); });
}

}  // namespace

TEST("a tetrahedron has its volume, its area, and the Euler number of a ball") {
    SurfaceMesh mesh;
    mesh.points = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
    mesh.corners = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    EXPECT_NEAR(volume(mesh), 1.0 / 6, 1e-15);
    EXPECT_NEAR(area(mesh), 1.5 + std::sqrt(3.0) / 2, 1e-15);
    EXPECT_NEAR(smallest_triangle(mesh), 0.5, 1e-15);
    EXPECT_EQ(topology(mesh).open_edges, 0);
    EXPECT_EQ(topology(mesh).edges, 6);
    EXPECT_EQ(topology(mesh).euler, 2);
    mesh.corners.pop_back();  // open
    EXPECT_EQ(topology(mesh).open_edges, 3);
    mesh.corners.push_back({1, 3, 2});  // closed, but one looks inwards
    EXPECT_EQ(topology(mesh).open_edges, 3);
}

TEST("a ball is one closed surface that looks outwards, and a ring has a hole") {
    const SurfaceMesh ball = contoured(samples_of(32, [](const Vec<3>& x) { return 10 - norm(x - Vec<3>{{15.3, 15.6, 15.1}}); }));
    EXPECT_EQ(topology(ball).open_edges, 0);
    EXPECT_EQ(topology(ball).euler, 2);
    // chords: on each of the two axes h^2/(8 r) at most, of 3/r in the volume
    EXPECT_NEAR(volume(ball) / (4 * std::numbers::pi / 3 * 1000), 1, 3 * 2 / (8.0 * 100));
    const SurfaceMesh ring =
        contoured(samples_of(32, [](const Vec<3>& x) { return 3.5 - std::hypot(std::hypot(x[0] - 15.5, x[2] - 15.5) - 9, x[1] - 15.5); }));
    EXPECT_EQ(topology(ring).open_edges, 0);
    EXPECT_EQ(topology(ring).euler, 0);
}

TEST("of noise too the surface is closed, no edge has four triangles, and no triangle is a sliver") {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const SurfaceMesh mesh = contoured(noise(24, seed));
        EXPECT_GT(mesh.corners.size(), 10000U);
        EXPECT_EQ(topology(mesh).open_edges, 0);
        EXPECT_GT(smallest_triangle(mesh), 1e-6);
    }
}

TEST("samples at zero and all but at zero make no slivers") {
    const SurfaceMesh flat = contoured(samples_of(16, [](const Vec<3>& x) { return x[1] < 7.5 ? (x[1] < 7 ? 1.0 : 0.0) : -1.0; }));
    const SurfaceMesh nearly = contoured(samples_of(16, [](const Vec<3>& x) { return 6 + 1e-7 - norm(x - Vec<3>{{8, 8, 8}}); }));
    EXPECT_GT(smallest_triangle(flat), 1e-6);
    EXPECT_GT(smallest_triangle(nearly), 1e-6);
    EXPECT_EQ(topology(nearly).open_edges, 0);
}

TEST("smoothing flattens bumps and keeps the volume; with no weight nothing moves") {
    SurfaceMesh ball = contoured(samples_of(40, [](const Vec<3>& x) {
        return 16 - norm(x - Vec<3>{{19.5, 19.5, 19.5}}) + 0.3 * std::sin(3 * x[0]) * std::sin(3 * x[1]) * std::sin(3 * x[2]);
    }));
    const real before = volume(ball), rough = area(ball);
    SurfaceMesh same = ball;
    smooth(same, whole_of(same), std::vector<real>(ball.points.size(), 0.0), 25);
    EXPECT_EQ(same.points, ball.points);
    smooth(ball, whole_of(ball), std::vector<real>(ball.points.size(), 1.0), 25);
    EXPECT_LT(area(ball), rough);
    // Taubin's steps: what a pass leaves of a sphere differs from 1 by the square of its curvature over the cells'; plain ones take 10%
    EXPECT_NEAR(volume(ball) / before, 1, 0.005);
}

TEST("the thickness of a slab is its height") {
    Samples slab = samples_of(32, [](const Vec<3>& x) { return std::min(x[1] - 6.2, 20.7 - x[1]); });
    SurfaceMesh mesh = contoured(slab);
    add_normals(mesh);
    add_thickness(mesh, whole_of(mesh), slab);
    int seen = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const bool middle = mesh.points[i][0] > 4 && mesh.points[i][0] < 27 && mesh.points[i][2] > 4 && mesh.points[i][2] < 27;
        if (!middle || std::abs(mesh.normals[i][1]) < 0.9) continue;
        EXPECT_NEAR(mesh.thickness[i], 14.5, 1e-4);  // linear between samples, in single precision
        ++seen;
    }
    EXPECT_GT(seen, 500);
}

}  // namespace meshes_tests
