// Surfaces of liquids: closed, where the liquid ends, the same for any number of threads.
#include "liquids.hpp"
#include "support/count_allocations.hpp"
#include "support/test.hpp"

#include <numbers>

namespace surfaces_tests {

using namespace weir;
using namespace weir::test;

namespace {

Liquid ball(real radius, real jitter = 0) {
    const int domain = 2 * static_cast<int>(radius) + 10;
    const Vec<3> middle{{0.5 * domain + 0.17, 0.5 * domain - 0.21, 0.5 * domain + 0.38}};
    return fill(
        domain, [=](const Vec<3>& x) { return norm(x - middle) < radius; }, jitter);
}

real ball_error(real radius, const Options& options) {
    return std::abs(volume(surface_of(ball(radius), options)) / (4 * std::numbers::pi / 3 * radius * radius * radius) - 1);
}

void expect_sound(const SurfaceMesh& mesh, real spacing2) {
    EXPECT_GT(mesh.corners.size(), 0U);
    EXPECT_EQ(topology(mesh).open_edges, 0);
    EXPECT_EQ(topology(mesh).unused_points, 0);
    EXPECT_GT(smallest_triangle(mesh), 1e-6 * spacing2);
    EXPECT_GT(volume(mesh), 0);
}

/// Mean and root mean square of the height of the surface over the middle of a tank, from the liquid's own.
struct Height {
    real shift = 0, rough = 0;
};
Height height_over(const SurfaceMesh& mesh, real level, int domain, real margin) {
    real sum = 0, squares = 0, count = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const Vec<3>& x = mesh.points[i];
        if (mesh.normals[i][1] < 0.5 || x[1] < 0.5 * level) continue;
        if (x[0] < margin || x[0] > domain - margin || x[2] < margin || x[2] > domain - margin) continue;
        sum += x[1] - level, squares += (x[1] - level) * (x[1] - level), ++count;
    }
    EXPECT_GT(count, 100);
    return {sum / count, std::sqrt(std::max(0.0, squares / count - sum / count * sum / count))};
}

}  // namespace

TEST("balls, tanks, thin films and sprays have closed surfaces without slivers") {
    const Liquid film = fill(
        32, [](const Vec<3>& x) { return x[1] > 15 && x[1] < 16 && x[0] > 6 && x[0] < 26 && x[2] > 6 && x[2] < 26; }, 0.2);
    const Liquid tank = fill(
        24, [](const Vec<3>& x) { return x[1] < 9; }, 0.2);
    for (const Method method : of_particles) {
        expect_sound(surface_of(ball(9, 0.2), usual(method)), 1);
        expect_sound(surface_of(film, usual(method)), 1);
        expect_sound(surface_of(tank, usual(method)), 1);
        expect_sound(surface_of(spray(32, 900, 3), usual(method)), 1);
        expect_sound(surface_of(ball(9, 0.2), usual(method, 0.5)), 0.25);
        EXPECT_EQ(topology(surface_of(ball(9), usual(method))).euler, 2);
        EXPECT_EQ(topology(surface_of(tank, usual(method))).euler, 2);
    }
}

TEST("single particles are drops, each a ball of about a particle's volume") {
    Liquid two;
    two.domain = 24;
    two.put({{8.2, 8.1, 8.4}}), two.put({{16.3, 16.2, 15.9}});
    for (const Method method : of_particles) {
        const SurfaceMesh mesh = surface_of(two, usual(method, 0.5));
        EXPECT_EQ(topology(mesh).open_edges, 0);
        EXPECT_EQ(topology(mesh).euler, 4);
        // between an octahedron, which is left of a ball about a sample, in a ball of half a spacing's radius, and a ball of a whole one
        EXPECT_GT(volume(mesh), 2 * 4.0 / 3 / 8);
        EXPECT_LT(volume(mesh), 2 * std::numbers::pi / 6 * 8);
    }
}

TEST("the same bits for any number of threads") {
    const Liquid liquid = spray(30, 6000, 8);
    const int before = set_threads(1);
    for (const Method method : of_particles) {
        set_threads(1);
        const SurfaceMesh one = surface_of(liquid, usual(method));
        for (const int threads : {2, 3}) {
            set_threads(threads);
            const SurfaceMesh more = surface_of(liquid, usual(method));
            EXPECT_EQ(one.points, more.points);
            EXPECT_EQ(one.corners, more.corners);
            EXPECT_EQ(one.normals, more.normals);
            EXPECT_EQ(one.velocity, more.velocity);
            EXPECT_EQ(one.thickness, more.thickness);
        }
    }
    set_threads(before);
}

TEST("a ball of 16 particles has its volume within 1%, and one of 8 is farther off") {
    for (const Method method : of_particles) {
        EXPECT_LT(ball_error(16, usual(method)), 0.01);
        EXPECT_LT(ball_error(16, usual(method)),
                  ball_error(8, usual(method)) + 0.002);  // of lattices: the count of a ball of 8 is off by .2%
    }
}

TEST("a block has its volume within 1%") {
    const Liquid block = fill(40, [](const Vec<3>& x) { return x[0] > 4 && x[0] < 36 && x[1] > 4 && x[1] < 36 && x[2] > 4 && x[2] < 36; });
    for (const Method method : of_particles) EXPECT_NEAR(volume(surface_of(block, usual(method))) / (32.0 * 32 * 32), 1, 0.01);
}

TEST("a liquid at rest is flat and stands where it does, up to the walls") {
    const Liquid tank = fill(28, [](const Vec<3>& x) { return x[1] < 12; });
    for (const Method method : of_particles)
        for (const real cell : {1.0, 0.7}) {
            const Height height = height_over(surface_of(tank, usual(method, cell)), 12, 28, 1.5);
            EXPECT_LT(height.rough, 0.05);
            EXPECT_NEAR(height.shift, 0, 0.1);
        }
}

TEST("a surface ends at the walls, and at a solid") {
    const Liquid tank = fill(28, [](const Vec<3>& x) { return x[1] < 12 && norm(x - Vec<3>{{14, 6, 14}}) > 4.5; });
    const std::string solid = "solids = [ { shape = \"sphere\", centre = [14, 6, 14], radius = 4 } ]\n";
    for (const Method method : of_particles) {
        const SurfaceMesh mesh = surface_of(tank, usual(method), solid);
        EXPECT_EQ(topology(mesh).open_edges, 0);
        real low = infinity, high = -infinity, into = infinity;
        for (const Vec<3>& x : mesh.points)
            low = std::min({low, x[0], x[1], x[2]}), high = std::max({high, x[0], x[2]}),
            into = std::min(into, norm(x - Vec<3>{{14, 6, 14}}));
        EXPECT_NEAR(low, 0, 1e-5);  // single precision of 28 cells
        EXPECT_NEAR(high, 28, 1e-5);
        EXPECT_GT(into, 4 - 0.05);  // linear between samples a spacing apart around a curvature of 1/4: h^2/(8 r)
    }
}

TEST("velocity is that of the particles, and normals look out of the liquid") {
    const Liquid drop = ball(8);
    for (const Method method : of_particles) {
        const SurfaceMesh mesh = surface_of(drop, usual(method));
        const Vec<3> middle{{13.17, 12.79, 13.38}};
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            EXPECT_GT(dot(mesh.normals[i], mesh.points[i] - middle), 0);
            // a linear field, and particles within two spacings, of which most lie below the point: half of that
            for (int a = 0; a < 3; ++a) EXPECT_NEAR(mesh.velocity[i][a], mesh.points[i][(a + 1) % 3], 1.0);
        }
    }
}

TEST("a level set's surface is its zero, closed at the walls") {
    const int n = 24;
    std::vector<real> phi, still(static_cast<std::size_t>((n + 1) * n * n), 2.0);
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) phi.push_back(0.1 * (j + 0.5 - 10.3));
    FieldSet fields;
    fields.grid = {3, {n, n, n}, {0, 0, 0}, {0.1, 0.1, 0.1}};
    fields.fields = {{"level_set", "m", Where::cell, "", {phi}}, {"velocity", "m/s", Where::face, "", {still, still, still}}};
    const scene::Scene scene =
        scene::parse("solver = \"mac_water\"\ndim = 3\ngrid = { cells = [24, 24, 24], size = [2.4, 2.4, 2.4] }\ntime = { end = 1.0 }\n",
                     "test", sim::schemas());
    Reconstruction made({Method::level_set, 1, 0}, scene);
    const SurfaceMesh& mesh = made.make(fields, 0);
    EXPECT_EQ(topology(mesh).open_edges, 0);
    EXPECT_EQ(topology(mesh).euler, 2);
    EXPECT_GT(smallest_triangle(mesh), 1e-6 * 0.01);
    // twelve edges, bevelled by half a cell: h^2/8 of a cross section each, of 4 x 24 + 8 x 10.3 and 4 x 24 cells of length
    EXPECT_NEAR(volume(mesh), 2.4 * 2.4 * 1.03, 0.2 * 274 * 1e-3);
    for (const Vec<3>& v : mesh.velocity) EXPECT_NEAR(norm(v - Vec<3>{{2, 2, 2}}), 0, 1e-14);  // weights sum to 1 but for rounding
}

TEST("markers that part inside a liquid leave no hole where a level set tells that there is none, and one where it does not") {
    const int cells = 12;
    const Vec<3> hole{{12, 12, 12}};
    const Liquid tank = fill(2 * cells, [&](const Vec<3>& x) { return x[1] < 20 && norm(x - hole) > 2; });
    for (const bool known : {false, true}) {
        std::vector<real> phi;
        for (int k = 0; k < cells; ++k)
            for (int j = 0; j < cells; ++j)
                for (int i = 0; i < cells; ++i) {
                    const Vec<3> x{{2 * i + 1.0, 2 * j + 1.0, 2 * k + 1.0}};
                    phi.push_back(std::max(x[1] - 20, known ? 2 - norm(x - hole) : -infinity));
                }
        FieldSet fields;
        fields.grid = {3, {cells, cells, cells}, {0, 0, 0}, {2, 2, 2}};
        fields.fields = {{"position", "m", Where::particle, marker_set_name, {tank.x[0], tank.x[1], tank.x[2]}},
                         {level_set_name, "m", Where::cell, "", {phi}}};
        const scene::Scene scene =
            scene::parse("solver = \"mac_water\"\ndim = 3\ngrid = { cells = [12, 12, 12], size = [24, 24, 24] }\ntime = { end = 1.0 }\n",
                         "test", sim::schemas());
        for (const Method method : of_particles) {
            Reconstruction made(usual(method), scene);
            EXPECT_EQ(topology(made.make(fields, 0)).euler, known ? 4 : 2) << static_cast<int>(method);  // two for each closed surface
        }
    }
}

TEST("a liquid that is gone has no surface, and one that comes back has") {
    Reconstruction made(usual(Method::zhu_bridson), scene_of(48));
    EXPECT_GT(made.make(ball(6).fields(), 0).corners.size(), 0U);
    Liquid none;
    EXPECT_EQ(made.make(none.fields(), 0).points.size(), 0U);
    EXPECT_EQ(made.mesh().normals.size() + made.mesh().velocity.size() + made.mesh().thickness.size(), 0U);
    EXPECT_GT(made.make(ball(6).fields(), 0).corners.size(), 0U);
}

TEST("where a scene names no surface, none is made, and nothing is allocated") {
    const scene::Scene plain = scene_of(48);
    const long before = test::allocations;
    EXPECT_EQ(reconstruction_of(plain), nullptr);
    EXPECT_EQ(test::allocations - before, 0);
    EXPECT_NE(reconstruction_of(scene_of(48, "output.surface = \"density\"\n")), nullptr);
}

}  // namespace surfaces_tests
