// Surfaces of flat liquids: closed lines where the liquid ends, the same for any number of threads.
#include "liquids.hpp"
#include "support/test.hpp"
#include "surfaces/contour_flat.hpp"
#include "surfaces/reference.hpp"

#include <numbers>

namespace flat_tests {

using namespace weir;
using namespace weir::test;

namespace {

scene::Scene flat_scene(int domain, const std::string& more = "") {
    const std::string n = std::to_string(domain), size = "[" + n + ", " + n + "]";
    return scene::parse("solver = \"pbf\"\ndim = 2\ngrid = { cells = " + size + ", size = " + size + " }\ntime = { end = 1.0 }\n" + more,
                        "test.toml", sim::schemas());
}

FieldSet fields_of(const Liquid& liquid) {
    FieldSet set;
    set.grid = {2, {liquid.domain, liquid.domain, 1}, {0, 0, 0}, {1, 1, 1}};
    set.fields = {{"position", "m", Where::particle, particle_set_name, {liquid.x[0], liquid.x[1]}},
                  {"velocity", "m/s", Where::particle, particle_set_name, {liquid.v[0], liquid.v[1]}}};
    return set;
}

SurfaceMesh lines_of(const Liquid& liquid, const Options& options, const std::string& more = "") {
    Reconstruction made(options, flat_scene(liquid.domain, more));
    return made.make(fields_of(liquid), 0);
}

/// Centres of cells where inside(x) holds, each moved by at most `jitter` along each axis.
template <class Inside>
Liquid flat_fill(int domain, const Inside& inside, real jitter = 0) {
    Liquid liquid;
    liquid.domain = domain;
    std::mt19937 random(5);
    std::uniform_real_distribution<real> off(-jitter, jitter);
    for (int j = 0; j < domain; ++j)
        for (int i = 0; i < domain; ++i) {
            const Vec<3> x{{i + 0.5, j + 0.5, 0}};
            if (inside(x)) liquid.put(x + (jitter > 0 ? Vec<3>{{off(random), off(random), 0}} : Vec<3>{}));
        }
    return liquid;
}

Vec<3> middle_of_disc(real radius) {
    const real half = 0.5 * (2 * static_cast<int>(radius) + 10);
    return {{half + 0.17, half - 0.21, 0}};
}
Liquid disc(real radius, real jitter = 0) {
    return flat_fill(
        2 * static_cast<int>(radius) + 10, [=](const Vec<3>& x) { return norm(x - middle_of_disc(radius)) < radius; }, jitter);
}
Liquid flat_spray(int domain, int count) {
    Liquid liquid;
    liquid.domain = domain;
    std::mt19937 random(7);
    std::uniform_real_distribution<real> at(0.2 * domain, 0.8 * domain);
    for (int i = 0; i < count; ++i) liquid.put({{at(random), at(random), 0}});
    return liquid;
}

}  // namespace

TEST("flat: the fast fields are those of a slice of a liquid that goes on for ever") {
    const Liquid liquid = disc(6, 0.25);
    std::vector<Vec<3>> endless;
    for (int layer = -10; layer <= 10; ++layer)
        for (std::size_t i = 0; i < liquid.x[0].size(); ++i) endless.push_back({{liquid.x[0][i], liquid.x[1][i], real(layer)}});
    for (const Method method : of_particles) {
        Reconstruction made(usual(method, 0.8), flat_scene(liquid.domain));
        made.make(fields_of(liquid), 0);
        const Samples& samples = made.samples();
        const ReferenceField exact(method, endless, true);
        real worst = 0;
        int compared = 0;
        for (int j = 1; j + 1 < samples.n[1]; ++j)
            for (int i = 1; i + 1 < samples.n[0]; ++i) {
                const real slow = std::clamp(exact.depth(samples.position(i, j, 0)), -1.0, 1.0);
                worst = std::max(worst, std::abs(real(samples(i, j, 0)) - slow));
                compared += std::abs(slow) < 1;
            }
        EXPECT_EQ(samples.n[2], 1);
        EXPECT_LT(worst, 2e-4 + 2e-3) << static_cast<int>(method);  // as in 3D, and values next to zero are moved by 2e-3
        EXPECT_GT(compared, 50);                                    // there is a surface
    }
}

TEST("flat: a disc of 16 particles has its area within 1%, and so has one that is twice as large") {
    for (const Method method : of_particles)
        for (const real radius : {16.0, 32.0}) {
            const real exact = std::numbers::pi * radius * radius;
            EXPECT_NEAR(volume(lines_of(disc(radius), usual(method))), exact, 0.01 * exact) << static_cast<int>(method) << ", " << radius;
        }
}

TEST("flat: discs, films, tanks and sprays are within closed lines") {
    const Liquid film = flat_fill(
        32, [](const Vec<3>& x) { return x[1] > 15 && x[1] < 16 && x[0] > 6 && x[0] < 26; }, 0.2);
    const Liquid tank = flat_fill(
        24, [](const Vec<3>& x) { return x[1] < 9; }, 0.2);
    for (const Method method : of_particles)
        for (const Liquid& liquid : {disc(9, 0.2), film, tank, flat_spray(40, 250)}) {
            const SurfaceMesh mesh = lines_of(liquid, usual(method));
            const Topology found = topology(mesh);
            EXPECT_GT(mesh.lines.size(), 10U);
            EXPECT_TRUE(mesh.corners.empty());
            EXPECT_EQ(found.open_edges, 0);
            EXPECT_EQ(found.unused_points, 0);
            EXPECT_EQ(found.euler, 0);
            EXPECT_GT(volume(mesh), 0);  // the liquid is on the left
        }
}

TEST("flat: liquid that touches air at two corners of a square of samples is joined or parted there, and closed") {
    Samples samples;
    samples.n = {4, 4, 1};
    samples.make_room();
    samples.depth.fill(-1);
    for (const float between : {-0.25F, -4.0F}) {
        samples(1, 1, 0) = samples(2, 2, 0) = 1;
        samples(2, 1, 0) = samples(1, 2, 0) = between;
        SurfaceMesh mesh;
        contour_flat(samples, mesh);
        EXPECT_EQ(topology(mesh).open_edges, 0);
        EXPECT_EQ(mesh.lines.size(), 8U);  // around one loop, or around two of four
        std::vector<int> next(mesh.points.size());
        for (const auto& [from, to] : mesh.lines) next[static_cast<std::size_t>(from)] = to;
        int round = 1;
        for (int p = next[0]; p != 0; p = next[static_cast<std::size_t>(p)]) ++round;
        EXPECT_EQ(round, between > -1 ? 8 : 4);
    }
}

TEST("flat: the same bits for any number of threads") {
    const Liquid liquid = flat_spray(40, 900);
    const int before = set_threads(1);
    for (const Method method : of_particles) {
        set_threads(1);
        const SurfaceMesh one = lines_of(liquid, usual(method));
        for (const int threads : {2, 3}) {
            set_threads(threads);
            const SurfaceMesh more = lines_of(liquid, usual(method));
            EXPECT_EQ(one.points, more.points);
            EXPECT_EQ(one.lines, more.lines);
            EXPECT_EQ(one.normals, more.normals);
            EXPECT_EQ(one.velocity, more.velocity);
            EXPECT_EQ(one.thickness, more.thickness);
        }
    }
    set_threads(before);
}

TEST("flat: a liquid at rest is level and stands where it does, up to the walls and to a solid") {
    const Liquid tank = flat_fill(28, [](const Vec<3>& x) { return x[1] < 12 && norm(x - Vec<3>{{14, 5, 0}}) > 4.5; });
    for (const Method method : of_particles) {
        const SurfaceMesh mesh = lines_of(tank, usual(method), "solids = [ { shape = \"sphere\", centre = [14, 5], radius = 4 } ]\n");
        real sum = 0, squares = 0, count = 0, low = infinity, high = -infinity, into = infinity;
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            const Vec<3>& x = mesh.points[i];
            low = std::min({low, x[0], x[1]}), high = std::max(high, x[0]);
            into = std::min(into, norm(x - Vec<3>{{14, 5, 0}}));
            if (mesh.normals[i][1] < 0.5 || x[1] < 10.5 || x[0] < 1.5 || x[0] > 26.5) continue;
            sum += x[1] - 12, squares += (x[1] - 12) * (x[1] - 12), ++count;
            EXPECT_NEAR(mesh.thickness[i], norm(x - Vec<3>{{14, 5, 0}}) < 8 ? mesh.thickness[i] : x[1], 0.02);
        }
        EXPECT_GT(count, 20);
        EXPECT_NEAR(sum / count, 0, 0.1);
        EXPECT_LT(std::sqrt(std::max(0.0, squares / count - sum / count * sum / count)), 0.05);
        EXPECT_NEAR(low, 0, 1e-5);
        EXPECT_NEAR(high, 28, 1e-5);
        EXPECT_GT(into, 4 - 0.05);  // linear between samples a spacing apart around a curvature of 1/4: h^2/(8 r)
    }
}

TEST("flat: velocity is that of the particles, and normals look out of the liquid") {
    for (const Method method : of_particles) {
        const SurfaceMesh mesh = lines_of(disc(8), usual(method));
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            EXPECT_GT(dot(mesh.normals[i], mesh.points[i] - middle_of_disc(8)), 0);
            EXPECT_EQ(mesh.normals[i][2], 0);
            // a linear field, and particles within two spacings, of which most lie below the point: half of that
            EXPECT_NEAR(mesh.velocity[i][0], mesh.points[i][1], 1.0);
            EXPECT_EQ(mesh.velocity[i][2], 0);
        }
    }
}

TEST("flat: a level set's surface is its zero, closed at the walls") {
    const int n = 24;
    std::vector<real> phi, still(static_cast<std::size_t>((n + 1) * n), 2.0);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) phi.push_back(0.1 * (j + 0.5 - 10.3));
    FieldSet fields;
    fields.grid = {2, {n, n, 1}, {0, 0, 0}, {0.1, 0.1, 0}};
    fields.fields = {{"level_set", "m", Where::cell, "", {phi}}, {"velocity", "m/s", Where::face, "", {still, still}}};
    const scene::Scene scene = scene::parse(
        "solver = \"mac_water\"\ndim = 2\ngrid = { cells = [24, 24], size = [2.4, 2.4] }\ntime = { end = 1.0 }\n", "test", sim::schemas());
    Reconstruction made({Method::level_set, 1, 0}, scene);
    const SurfaceMesh& mesh = made.make(fields, 0);
    EXPECT_EQ(topology(mesh).open_edges, 0);
    // four corners are bevelled: half of a rectangle of half a cell, by half a cell below and by the 0.8 of one to the zero above
    EXPECT_NEAR(volume(mesh), 2.4 * 1.03 - (2 * 0.5 * 0.5 + 2 * 0.5 * 0.8) / 2 * 0.01, 1e-6);  // single precision of 24 cells
    for (const Vec<3>& v : mesh.velocity) EXPECT_NEAR(norm(v - Vec<3>{{2, 2, 0}}), 0, 1e-14);
}

}  // namespace flat_tests
