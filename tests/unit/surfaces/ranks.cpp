// Surfaces that ranks make together: point for point and triangle for triangle those of one process, wherever planes are cut and whichever
// rank holds which particles.
#include "liquids.hpp"
#include "parallel/communicator.hpp"
#include "support/forked_ranks.hpp"
#include "support/test.hpp"

#include <algorithm>
#include <filesystem>

namespace ranks_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// The entries [first, first + part.size()) of all.
template <class T>
bool is_part(const std::vector<T>& part, const std::vector<T>& all, std::size_t first) {
    return first + part.size() <= all.size() && std::equal(part.begin(), part.end(), all.begin() + static_cast<std::ptrdiff_t>(first));
}

void expect_part(const SurfaceMesh& part, const SurfaceMesh& all) {
    const auto first = [](std::size_t count) { return begins_of_ranks(count)[static_cast<std::size_t>(communicator().rank())]; };
    const auto count = [](std::size_t own) { return begins_of_ranks(own).back(); };
    EXPECT_EQ(first(part.points.size()), part.first);
    EXPECT_EQ(count(part.points.size()), all.points.size());
    EXPECT_EQ(count(part.velocity.size()), all.velocity.size());
    EXPECT_EQ(count(part.thickness.size()), all.thickness.size());
    EXPECT_TRUE(is_part(part.points, all.points, part.first));
    EXPECT_TRUE(is_part(part.normals, all.normals, part.first));
    EXPECT_TRUE(is_part(part.thickness, all.thickness, part.first));
    EXPECT_TRUE(part.velocity.empty() || is_part(part.velocity, all.velocity, part.first));
    EXPECT_EQ(count(part.corners.size()), all.corners.size());
    EXPECT_EQ(count(part.lines.size()), all.lines.size());
    EXPECT_TRUE(is_part(part.corners, all.corners, first(part.corners.size())));
    EXPECT_TRUE(is_part(part.lines, all.lines, first(part.lines.size())));
}

/// Of particles of which each rank shows a part, one of them none.
void expect_together(const Liquid& liquid, const Options& options, const scene::Scene& scene, int ranks) {
    const auto dim = static_cast<std::size_t>(scene.dim());
    const auto fields = [&](std::size_t begin, std::size_t end) {
        FieldSet set;
        const int n = liquid.domain;
        set.grid = {scene.dim(), {n, n, dim == 2 ? 1 : n}, {0, 0, 0}, {1, 1, 1}};
        FieldView x{"position", "m", Where::particle, particle_set_name, {}}, v{"velocity", "m/s", Where::particle, particle_set_name, {}};
        for (std::size_t a = 0; a < dim; ++a) {
            x.data.push_back(std::span(liquid.x[a]).subspan(begin, end - begin));
            v.data.push_back(std::span(liquid.v[a]).subspan(begin, end - begin));
        }
        set.fields = {x, v};
        return set;
    };
    const auto count = static_cast<std::size_t>(liquid.count());
    const SurfaceMesh whole = Reconstruction(options, scene).make(fields(0, count), 0);
    EXPECT_GT(whole.points.size(), 100U);
    on_ranks(ranks, [&] {
        const auto rank = static_cast<std::size_t>(communicator().rank()), others = static_cast<std::size_t>(ranks) - 1;
        FieldSet part = rank == 0 ? fields(0, 0) : fields(count * (rank - 1) / others, count * rank / others);
        part.particles_in_parts = true;
        Reconstruction maker(options, scene);
        expect_part(maker.make_part(part, 0), whole);
        expect_part(maker.make_part(fields(0, count), 0), whole);  // of those that all have
    });
}

scene::Scene scene_for(const std::string& solver, int dim, const std::vector<int>& cells, const std::string& more) {
    std::string n;
    for (const int c : cells) n += (n.empty() ? "" : ", ") + std::to_string(c);
    return scene::parse("solver = \"" + solver + "\"\ndim = " + std::to_string(dim) + "\ngrid = { cells = [" + n + "], size = [" + n +
                            "] }\ntime = { end = 1.0 }\n" + more,
                        "test.toml", sim::schemas());
}

/// Those of a slice so thick on both sides of the middle.
Liquid in_plane(const Liquid& liquid, real half = 0.6) {
    Liquid flat;
    flat.domain = liquid.domain;
    for (std::size_t i = 0; i < liquid.x[0].size(); ++i)
        if (std::abs(liquid.x[2][i] - 0.5 * liquid.domain) < half) flat.put({{liquid.x[0][i], liquid.x[1][i], 0}});
    return flat;
}

/// Liquid against all walls with a hole in it, and drops above it: lines through it cross every cut.
Liquid tank(int n, unsigned seed) {
    const Liquid pool = fill(
        n,
        [=](const Vec<3>& x) {
            const Vec<3> hole{{0.4 * n, 0.3 * n, 0.5 * n}};
            return (x[1] < 0.6 * n || x[2] < 4) && norm(x - hole) > 0.2 * n;
        },
        0.3, seed);
    std::vector<Vec<3>> list;
    for (std::size_t i = 0; i < pool.x[0].size(); ++i) list.push_back({{pool.x[0][i], pool.x[1][i], pool.x[2][i]}});
    std::mt19937 random(seed);
    std::uniform_real_distribution<real> at(0.0, real(n));
    for (int i = 0; i < 3 * n; ++i) list.push_back({{at(random), at(random), at(random)}});
    std::shuffle(list.begin(), list.end(), random);  // on any rank, they stand anywhere
    Liquid all;
    all.domain = n;
    for (const Vec<3>& x : list) all.put(x);
    return all;
}

}  // namespace

// Before the others, which use VTK in the process that forks: a thread of its own is not in the fork.
TEST("with one thread a surface starts no other: ranks are forked beside it") {
    const auto threads_of_process = [] {
        const std::filesystem::directory_iterator tasks("/proc/self/task");
        return std::distance(begin(tasks), end(tasks));
    };
    on_ranks(1, [&] {
        for (int i = 0; i < 3; ++i)
            EXPECT_GT(Reconstruction(usual(Method::density), scene_of(26)).make(tank(26, 5).fields(), 0).points.size(), 100U);
        EXPECT_EQ(threads_of_process(), 1);
    });
}

TEST("particles in space: the parts are those of one process, of liquid against walls and of sprays") {
    for (const Method method : of_particles)
        for (const int ranks : {2, 3, 4}) {
            expect_together(tank(26, 5), usual(method), scene_of(26), ranks);
            expect_together(spray(40, 500, 3), usual(method, 0.7), scene_of(40), ranks);
        }
}

TEST("particles in a plane: the parts are those of one process") {
    for (const Method method : of_particles)
        for (const int ranks : {2, 3, 4}) {
            const std::string solid = "solids = [ { shape = \"sphere\", centre = [14, 9], radius = 4 } ]\n";
            expect_together(in_plane(tank(30, 7)), usual(method), scene_for("pbf", 2, {30, 30}, solid), ranks);
            expect_together(in_plane(spray(60, 1200, 3), 4), usual(method, 1.5), scene_for("pbf", 2, {60, 60}, ""), ranks);
        }
}

TEST("around the ends of every axis, and where there are fewer planes than ranks") {
    const std::string
        flat =
            "x_min = { kind = \"periodic\" }, x_max = { kind = \"periodic\" }, y_min = { kind = \"periodic\" }, y_max = { kind "
            "= \"periodic\" }",
        deep = flat + ", z_min = { kind = \"periodic\" }, z_max = { kind = \"periodic\" }";
    const Liquid film = fill(
        24, [](const Vec<3>& x) { return x[2] < 2; }, 0.2);
    for (const Method method : of_particles) {
        expect_together(tank(22, 9), usual(method), scene_of(22, "sides = { " + deep + " }\n"), 3);
        expect_together(in_plane(tank(22, 9)), usual(method), scene_for("pbf", 2, {22, 22}, "sides = { " + flat + " }\n"), 3);
        expect_together(film, usual(method, 2), scene_of(24), 4);
    }
}

TEST("much smoothing, which moves points from layer to layer") {
    for (const int ranks : {2, 4}) {
        expect_together(tank(24, 11), {Method::density, 0.5, 40}, scene_of(24), ranks);
        expect_together(in_plane(tank(24, 11)), {Method::density, 0.5, 40}, scene_for("pbf", 2, {24, 24}, ""), ranks);
    }
}

namespace {

/// Water on a grid, of which a rank knows its own planes of φ, and of the velocity and of the cells beside them.
struct Water {
    std::array<int, 3> n;
    int dim;
    std::vector<real> phi{};
    std::array<std::vector<real>, 3> u{};
    std::array<std::vector<real>, 3> x{};  // markers
    explicit Water(int d) : n{d == 2 ? 20 : 14, d == 2 ? 44 : 13, d == 2 ? 1 : 30}, dim(d) {
        const auto level = [&](const Vec<3>& at) {
            const real wave = (d == 2 ? 9 : 6) + 2 * std::sin(0.4 * at[0]) * std::cos(0.3 * (d == 2 ? at[0] : at[2]));
            const Vec<3> drop{{7, d == 2 ? 36.0 : 10.5, d == 2 ? 0.0 : 15.5}};
            return std::min(at[1] - (d == 2 ? 2.5 * wave : wave), norm(at - drop) - 1.7);
        };
        const auto each = [&](const std::array<int, 3>& count, auto&& f) {
            for (int k = 0; k < count[2]; ++k)
                for (int j = 0; j < count[1]; ++j)
                    for (int i = 0; i < count[0]; ++i) f(Vec<3>{{real(i), real(j), real(k)}});
        };
        const Vec<3> half = d == 2 ? Vec<3>{{0.5, 0.5, 0}} : Vec<3>{{0.5, 0.5, 0.5}};
        std::mt19937 random(3);
        std::uniform_real_distribution<real> off(0, 0.5);
        const auto wet = [&](const Vec<3>& at) {
            if (level(at) >= -0.3) return;
            for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) x[a].push_back(at[a]);
        };
        each(n, [&](const Vec<3>& at) {
            phi.push_back(level(at + half));
            for (const real b : {0.0, 0.5})
                for (const real c : {0.0, 0.5})
                    for (const real e : {0.0, 0.5})
                        if (dim == 3 || e == 0) wet(at + Vec<3>{{b + off(random), c + off(random), dim == 2 ? 0 : e + off(random)}});
        });
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
            std::array<int, 3> faces = n;
            ++faces[a];
            each(faces, [&](const Vec<3>& at) { u[a].push_back(std::sin(at[0] + 2 * at[1] + 3 * at[2] + real(a))); });
        }
    }
    std::size_t plane(const std::array<int, 3>& count) const {
        return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(dim == 2 ? 1 : count[1]);
    }
    /// Stale ghosts of this rank are not numbers.
    void forget(const Partition& cut) {
        const int last = n[static_cast<std::size_t>(dim - 1)], rank = communicator().rank();
        const auto keep = [](std::vector<real>& list, std::size_t per, int begin, int end) {
            for (std::size_t i = 0; i < list.size(); ++i)
                if (static_cast<int>(i / per) < begin || static_cast<int>(i / per) >= end) list[i] = NAN;
        };
        keep(phi, plane(n), cut.begin(rank), cut.end(rank, last));
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
            std::array<int, 3> faces = n;
            ++faces[a];
            keep(u[a], plane(faces), cut.begin(rank) - 2, cut.end(rank, faces[static_cast<std::size_t>(dim - 1)]) + 2);
        }
    }
    /// Markers [begin, end), which carry no velocity.
    FieldSet fields(std::size_t begin, std::size_t end) const {
        FieldSet set;
        set.grid = {dim, n, {0, 0, 0}, {1, 1, 1}};
        FieldView velocity{"velocity", "m/s", Where::face, "", {}}, position{"position", "m", Where::particle, marker_set_name, {}};
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
            velocity.data.push_back(u[a]);
            position.data.push_back(std::span(x[a]).subspan(begin, end - begin));
        }
        set.fields = {velocity, {level_set_name, "m", Where::cell, "", {phi}}, position};
        return set;
    }
};

}  // namespace

TEST_IN_2D_AND_3D("water on a grid: from its level set and from its markers, of ranks that know their own planes") {
    Water water(D);
    const scene::Scene scene = scene_for("mac_water", D, D == 2 ? std::vector<int>{20, 44} : std::vector<int>{14, 13, 30}, "");
    const int planes = water.n[D - 1];
    const std::size_t markers = water.x[0].size();
    for (const Method method : {Method::level_set, Method::zhu_bridson, Method::anisotropic, Method::density})
        for (const std::vector<int>& at : {std::vector<int>{0, 16, planes}, {0, 1, 3, planes}, {0, 11, planes - 2, planes - 1, planes}})
            for (const real cell : {1.0, 2.0, 0.4}) {
                if ((method == Method::level_set || at[1] == 1) && cell != 1) continue;
                const Options options{method, cell, method == Method::density ? 3 : 0};
                const SurfaceMesh whole = Reconstruction(options, scene).make(water.fields(0, markers), 0);
                EXPECT_GT(whole.points.size(), 100U);
                EXPECT_EQ(whole.velocity.size(), whole.points.size());
                const Partition cut{at};
                on_ranks(
                    cut.ranks(),
                    [&] {
                        Water own = water;
                        own.forget(cut);
                        const auto rank = static_cast<std::size_t>(communicator().rank()), ranks = static_cast<std::size_t>(cut.ranks());
                        FieldSet fields = own.fields(markers * rank / ranks, markers * (rank + 1) / ranks);
                        fields.cut = &cut, fields.particles_in_parts = true;
                        Reconstruction maker(options, scene);
                        expect_part(maker.make_part(fields, 0), whole);
                        if (cell == 1) expect_part(maker.make_part(water.fields(0, markers), 0), whole);  // where all know all
                    },
                    true);
            }
}

TEST_IN_2D_AND_3D("the surface of markers without a velocity has that of the grid") {
    Water water(D);
    const scene::Scene scene = scene_for("mac_water", D, D == 2 ? std::vector<int>{20, 44} : std::vector<int>{14, 13, 30}, "");
    for (std::size_t a = 0; a < D; ++a)  // as fast as a face is high: linear between faces
        for (std::size_t i = 0; i < water.u[a].size(); ++i) {
            const auto wide = static_cast<std::size_t>(water.n[0] + (a == 0)), high = static_cast<std::size_t>(water.n[1] + (a == 1));
            water.u[a][i] = real(i / wide % high) + (a == 1 ? 0 : 0.5);
        }
    const SurfaceMesh mesh = Reconstruction({Method::zhu_bridson, 1, 0}, scene).make(water.fields(0, water.x[0].size()), 0);
    ASSERT_EQ(mesh.velocity.size(), mesh.points.size());
    int seen = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const real y = mesh.points[i][1];
        if (y < 0.5 || y > water.n[1] - 0.5) continue;  // beyond the outermost samples
        ++seen;
        for (int a = 0; a < D; ++a) EXPECT_NEAR(mesh.velocity[i][a], y, 1e-12);
    }
    EXPECT_GT(seen, 50);
}

TEST("no liquid at all, and a position that is not a number: all ranks say the same") {
    const Liquid none = spray(10, 0, 1);
    on_ranks(3, [&] {
        FieldSet fields = none.fields();
        fields.particles_in_parts = true;
        Reconstruction maker(usual(Method::density), scene_of(10));
        const SurfaceMesh& mesh = maker.make_part(fields, 0);
        EXPECT_TRUE(mesh.points.empty() && mesh.corners.empty() && mesh.normals.empty() && mesh.thickness.empty());
        Liquid broken = spray(10, 30, 1);
        if (communicator().rank() == 1) broken.x[1][7] = NAN;
        fields = broken.fields();
        fields.particles_in_parts = true;
        EXPECT_THROW(maker.make_part(fields, 0), NumericalFailure);
    });
}

}  // namespace ranks_tests
