// Meshes: files as different programs write them, what is refused and why, moments by the divergence theorem, distances.
#include "core/error.hpp"
#include "geometry/mesh/mesh.hpp"
#include "geometry/shape.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <random>

namespace meshes_tests {

using namespace weir;
using namespace weir::geometry;

namespace {

const Triangles tetrahedron{{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, {}};

Triangles box_of(const Vec<3>& min, const Vec<3>& max, bool inwards = false) {
    Triangles mesh;
    for (int c = 0; c < 8; ++c) mesh.points.push_back({{c & 1 ? max[0] : min[0], c & 2 ? max[1] : min[1], c & 4 ? max[2] : min[2]}});
    for (const std::array<int, 4>& q : {std::array{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}})
        mesh.corners.push_back({q[0], q[1], q[2]}), mesh.corners.push_back({q[0], q[2], q[3]});
    if (inwards)
        for (auto& t : mesh.corners) std::swap(t[1], t[2]);
    return mesh;
}

Triangles both(Triangles a, const Triangles& b) {
    const int first = static_cast<int>(a.points.size());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    for (auto t : b.corners) a.corners.push_back({t[0] + first, t[1] + first, t[2] + first});
    return a;
}

/// An octahedron on the unit sphere, each triangle cut in four so many times.
Triangles ball_of(int times) {
    Triangles mesh{{{{1, 0, 0}}, {{-1, 0, 0}}, {{0, 1, 0}}, {{0, -1, 0}}, {{0, 0, 1}}, {{0, 0, -1}}},
                   {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}},
                   {}};
    for (; times > 0; --times) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [entry, made] = middles.emplace(std::minmax(a, b), static_cast<int>(mesh.points.size()));
            if (made) {
                const Vec<3> m = mesh.points[static_cast<std::size_t>(a)] + mesh.points[static_cast<std::size_t>(b)];
                mesh.points.push_back(m / norm(m));
            }
            return entry->second;
        };
        std::vector<std::array<int, 3>> finer;
        for (const auto& t : mesh.corners) {
            const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
            for (const std::array<int, 3>& n : {std::array{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}}) finer.push_back(n);
        }
        mesh.corners = finer;
    }
    return mesh;
}

std::string bytes_of_floats(const std::vector<float>& list, bool swapped = false) {
    std::string bytes;
    for (const float f : list) {
        std::array<char, 4> raw;
        std::memcpy(raw.data(), &f, 4);
        if (swapped) std::reverse(raw.begin(), raw.end());
        bytes.append(raw.data(), 4);
    }
    return bytes;
}
std::string bytes_of_int(std::uint32_t n, bool swapped = false) {
    std::string bytes(4, 0);
    std::memcpy(bytes.data(), &n, 4);
    if (swapped) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

std::string stl_of_bytes(const Triangles& mesh) {
    std::string bytes(80, ' ');
    bytes += bytes_of_int(static_cast<std::uint32_t>(mesh.corners.size()));
    for (const auto& t : mesh.corners) {
        bytes += bytes_of_floats({0, 0, 0});
        for (const int c : t)
            for (int a = 0; a < 3; ++a) bytes += bytes_of_floats({static_cast<float>(mesh.points[static_cast<std::size_t>(c)][a])});
        bytes += std::string(2, 0);
    }
    return bytes;
}

std::string stl_of_text(const Triangles& mesh) {
    std::string text = "solid of a test\n";
    for (const auto& t : mesh.corners) {
        text += " facet normal 0 0 0\n  outer loop\n";
        for (const int c : t) {
            const Vec<3>& x = mesh.points[static_cast<std::size_t>(c)];
            text += fmt::format("   vertex {} {} {:e}\n", x[0], x[1], x[2]);
        }
        text += "  endloop\n endfacet\n";
    }
    return text + "endsolid of a test\n";
}

std::string ply_of(const Triangles& mesh, const std::string& format) {
    const bool swapped = format == "binary_big_endian";
    std::string text = "ply\nformat " + format + " 1.0\ncomment of a test\nelement vertex " + std::to_string(mesh.points.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar "
                       "blue\nelement face " +
                       std::to_string(mesh.corners.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Vec<3>& x : mesh.points)
        text += format == "ascii"
                    ? fmt::format("{} {} {} 255 0 51\n", x[0], x[1], x[2])
                    : bytes_of_floats({static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])}, swapped) + "\xff" +
                          std::string(1, '\0') + "\x33";
    for (const auto& t : mesh.corners) {
        text += format == "ascii" ? "3" : "\x03";
        for (const int c : t) text += format == "ascii" ? fmt::format(" {}", c) : bytes_of_int(static_cast<std::uint32_t>(c), swapped);
        if (format == "ascii") text += "\n";
    }
    return text;
}

std::filesystem::path write(const test::TemporaryFolder& folder, const std::string& name, const std::string& content) {
    std::ofstream(folder.path() / name, std::ios::binary) << content;
    return folder.path() / name;
}

/// What a reader of the file, and the making of a mesh of it, say.
std::string refusal(const test::TemporaryFolder& folder, const std::string& name, const std::string& content) {
    const auto file = write(folder, name, content);
    try {
        Mesh(read_triangles(file), 16, name);
    } catch (const BadInput& bad) {
        std::string text = bad.what();
        const auto at = text.find(folder.path().string());
        return at == std::string::npos ? text : text.erase(at, folder.path().string().size() + 1);
    }
    return "accepted";
}

}  // namespace

TEST("a box, a tetrahedron and a ball have the moments of their formulas") {
    const Vec<3> min{{1, -2, 0.5}}, max{{1.5, -1, 3}}, size = max - min;
    const Mesh box(box_of(min, max), 16, "box");
    const real volume = size[0] * size[1] * size[2];
    EXPECT_NEAR(box.volume(), volume, 1e-14);
    EXPECT_LT(norm(box.centre() - 0.5 * (min + max)), 1e-14);
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            EXPECT_NEAR(box.second()[static_cast<std::size_t>(a)][b], a == b ? volume * size[a] * size[a] / 12 : 0, 1e-14);
    const Mesh corner(tetrahedron, 16, "tetrahedron");
    EXPECT_NEAR(corner.volume(), 1.0 / 6, 1e-16);
    EXPECT_LT(norm(corner.centre() - Vec<3>::constant(0.25)), 1e-15);
    for (int a = 0; a < 3; ++a)  // ∫x² = 1/60, ∫xy = 1/120, less V c c
        for (int b = 0; b < 3; ++b) EXPECT_NEAR(corner.second()[static_cast<std::size_t>(a)][b], a == b ? 1.0 / 160 : -1.0 / 480, 1e-16);
    const Mesh coarse(ball_of(3), 16, "ball"), fine(ball_of(4), 16, "ball");
    const auto errors = [](const Mesh& m) { return std::array{4 * pi / 3 - m.volume(), 4 * pi / 15 - m.second()[1][1]}; };
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {  // the second order of a surface by chords
        EXPECT_GT(errors(fine)[k], 0);
        EXPECT_NEAR(errors(coarse)[k] / errors(fine)[k], 4, 0.2);
    }
}

TEST("every format and kind of file gives the same mesh") {
    const test::TemporaryFolder folder;
    const std::string obj =
        "# a comment\no corner\nvn 0 0 1\nv 0 0 0 1 0 0.2\nv 1 0 0 1 0 0.2\nv 0 1 0 1 0 0.2\nv 0 0 1 1 0 0.2\n"
        "s off\nf 1/2/3 3//1 2\nf -4 -3 -1\nf 1 4 3\nf 2 3 4\n";
    for (const auto& [name, content] :
         {std::pair{"a.stl", stl_of_bytes(tetrahedron)}, std::pair{"b.stl", stl_of_text(tetrahedron)}, std::pair{"c.obj", obj},
          std::pair{"d.ply", ply_of(tetrahedron, "ascii")}, std::pair{"e.ply", ply_of(tetrahedron, "binary_little_endian")},
          std::pair{"f.PLY", ply_of(tetrahedron, "binary_big_endian")}}) {
        const Mesh mesh(read_triangles(write(folder, name, content)), 16, name);
        EXPECT_EQ(mesh.triangles().points.size(), 4U) << name;
        EXPECT_NEAR(mesh.volume(), 1.0 / 6, 1e-16) << name;
        if (std::string(name).back() == 'l') continue;  // STL knows no colours
        ASSERT_EQ(mesh.triangles().colours.size(), 4U) << name;
        EXPECT_LT(norm(mesh.triangles().colours[2] - Vec<3>{{1, 0, 0.2}}), 1e-12) << name;
    }
}

TEST("a mesh that is inside out is turned, and a hole in it is a hole") {
    const Vec<3> one = Vec<3>::constant(1);
    const Mesh turned(box_of({}, one, true), 16, "box");
    EXPECT_NEAR(turned.volume(), 1, 1e-15);
    EXPECT_NEAR(turned.distance(Vec<3>::constant(0.5)), -0.5, 1e-6);  // a node; numbers of the grid are single
    const Mesh hollow(both(box_of({}, one), box_of(0.25 * one, 0.75 * one, true)), 32, "hollow");
    EXPECT_NEAR(hollow.volume(), 1 - 0.125, 1e-15);
    EXPECT_NEAR(hollow.distance(Vec<3>::constant(0.5)), 0.25, 1e-6);
}

TEST("what bounds no region, and what is broken, is refused with the reason") {
    const test::TemporaryFolder folder;
    const Vec<3> one = Vec<3>::constant(1);
    Triangles open = box_of({}, one), twice = box_of({}, one), flipped = box_of({}, one),
              one_point = both(box_of({}, one), box_of(one, 2 * one));
    open.corners.pop_back();
    twice.points.push_back({{2, 2, 2}}), twice.corners.push_back({0, 1, 8});
    std::swap(flipped.corners[3][0], flipped.corners[3][1]);
    const auto text = [](const Triangles& mesh) { return stl_of_text(mesh); };
    const std::string face_of = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 ";
    std::string huge(84, '\0');
    std::memcpy(huge.data() + 80, "\x80\x96\x98\x00", 4);
    for (const auto& [name, content, expected] : std::initializer_list<std::array<std::string, 3>>{
             {"open.stl", text(open), "open.stl: not closed: 3 edges belong to one triangle only, the first at [0, 0.5, 1]"},
             {"edge.stl", text(twice), "edge.stl: not manifold: 3 triangles meet at the edge at [0.5, 0, 0]"},
             {"flipped.stl", text(flipped), "flipped.stl: two triangles at the edge at [1, 0.5, 0.5] face opposite ways"},
             {"point.stl", text(one_point), "point.stl: not manifold: two surfaces meet in the one point [1, 1, 1]"},
             {"overlap.stl", text(both(box_of({}, one), box_of(0.4 * one, 1.4 * one))),
              "overlap.stl: the surface overlaps itself: around [0.4375, 0.4375, 0.4375] it winds 2 times"},
             {"inner.stl", text(both(box_of({}, one), box_of(2 * one, 2.5 * one, true))),
              "inner.stl: the surface is oriented opposite to itself: around [2.031, 2.031, 2.031] it winds -1 times"},
             {"empty.stl", "solid a\nendsolid a\n", "empty.stl: no triangle with an area is in it"},
             {"short.stl", std::string(80, 'x') + bytes_of_int(3), "short.stl: 3 triangles take 234 bytes; the file has 84"},
             {"none.stl", "facets", "none.stl: no STL file: neither \"solid\" nor a count of triangles stands at its beginning"},
             {"many.stl", huge, "many.stl: 10000000 triangles; at most 1000000 are read, more than a grid of distances can show"},
             {"words.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0",
              "words.stl:4:10: \"zero\" stands where a coordinate is expected"},
             {"ends.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 1",
              "ends.stl:4:11: the file ends where a coordinate is expected"},
             {"point.obj", face_of + "9\n", "point.obj:4:7: a face names point 9; 3 stand before it"},
             {"half.obj", "v 0 0\nv 1 0 0\n", "half.obj:1:6: the line ends where a coordinate is expected"},
             {"edge.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", "edge.obj:3:6: a face has three corners at least"},
             {"early.ply", ply_of(tetrahedron, "binary_little_endian").substr(0, 260),
              "early.ply: the file ends after 260 bytes, within its data"},
             {"early2.ply",
              "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n1\n",
              "early2.ply:9:1: the file ends where a number is expected"},
             {"type.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty floaty x\n",
              "type.ply:4:10: \"floaty\" is no type of a property; known: char, uchar, short, ushort, int, uint, float, double, list"},
             {"many.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nelement face 10000000\n",
              "many.ply: 10000000 triangles; at most 1000000 are read, more than a grid of distances can show"},
             {"bare.ply", "ply\nformat ascii 1.0\nelement vertex 3999999999\nend_header\n",
              "bare.ply: the header announces 3999999999 elements \"vertex\" without a property"},
             {"where.ply",
              "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty list uchar int y\nproperty float z\nend_header\n",
              "where.ply: the header announces vertices without a property \"y\""},
             {"sheet.obj", "v 0 0 0\nv 1 0 0.3\nv 0 1 0.7\nf 1 2 3\nf 3 2 1\n", "sheet.obj: the surface is flat: it bounds no volume"},
             {"far.obj", "v 0 0 0\nv 1 0 0\nv 0 1e200 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
              "far.obj: it extends from 0 to 1e+200 along y; coordinates up to 1e+30 in magnitude are supported"},
             {"tiny.obj", "v 0 0 0\nv 1e-99 0 0\nv 0 1e-99 0\nv 0 0 1e-99\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
              "tiny.obj: its longest side is 1e-99; at least 1e-30 is read"},
             {"head.ply", "ply\nformat ascii 1.0\n", "head.ply:3:1: the header has no end"},
             {"mesh.vtk", "", "mesh.vtk: its name says no format of meshes; known: .obj, .ply, .stl"}})
        EXPECT_EQ(refusal(folder, name, content), expected);
    EXPECT_EQ(refusal(folder, "whole.stl", text(box_of({}, one))), "accepted");
    EXPECT_THROW(read_triangles(folder.path() / "nowhere.stl"), BadInput);
    std::filesystem::create_symlink("/dev/zero", folder.path() / "endless.stl");
    EXPECT_THROW(read_triangles(folder.path() / "endless.stl"), BadInput);
}

TEST("distances are those of the triangles, to what linear interpolation leaves") {
    std::mt19937 random(11);
    std::uniform_real_distribution<real> coordinate(-1.1, 1.1);
    const int resolution = 48;
    const real h = 2.0 / resolution;
    const Vec<3> half{{1, 0.6, 0.8}};
    const Mesh cube(box_of(-half, half), resolution, "box"), round(ball_of(5), resolution, "ball");
    const auto exact = box<3>(-half, half);
    for (int i = 0; i < 4000; ++i) {
        Vec<3> x;
        for (int a = 0; a < 3; ++a) x[a] = coordinate(random);
        // A mean of values at corners of a cell, of a function whose slope is at most one: half a diagonal. Off the grid it is a lower
        // bound.
        const real cubes = exact->distance(x), balls = norm(x) - 1;
        EXPECT_LT(cube.distance(x), cubes + 0.87 * h);
        EXPECT_GT(cube.distance(x), std::min(cubes, 0.05) - 0.87 * h);
        // Of a ball of radius r it is 3/8 h²/r (second derivatives 1/r along each axis) and the sagitta of a chord, here of 1/20.
        const real within = 0.375 * h * h / (1 - 3 * h) + 0.05 * 0.05 / 8 * 1.4;
        if (std::abs(balls) < 2 * h)
            EXPECT_NEAR(round.distance(x), balls, within);
        else
            EXPECT_EQ(round.distance(x) < 0, balls < 0) << balls;
    }
}

// The nearest point may lie on any edge or corner of a triangle; the order of the corners must not matter. At nodes near the surface
// distances are exact but for single precision, 2^-24 of 1, and the round-off of the boxes' formula.
TEST("distances to a box are exact beside faces, edges and corners, for any first corner of its triangles") {
    std::mt19937 random(3);
    const Vec<3> half{{1, 0.6, 0.8}};
    const auto exact = box<3>(-half, half);
    for (int order = 0; order < 6; ++order) {
        Triangles triangles = box_of(-half, half);
        for (auto& t : triangles.corners) std::rotate(t.begin(), t.begin() + static_cast<int>(random() % 3), t.end());
        const int resolution = 20;
        const real h = 2.0 / resolution;
        const Mesh mesh(triangles, resolution, "box");
        real worst = 0;
        int beside_edges = 0;
        for (int k = -9; k <= 9; ++k)  // nodes of its grid lie about its middle
            for (int j = -7; j <= 7; ++j)
                for (int i = -11; i <= 11; ++i) {
                    const Vec<3> x{{i * h, j * h, k * h}};
                    worst = std::max(worst, std::abs(mesh.distance(x) - exact->distance(x)));
                    int beyond = 0;
                    for (int a = 0; a < 3; ++a) beyond += std::abs(x[a]) > half[a] + 1e-9;
                    beside_edges += beyond == 2;
                }
        EXPECT_GT(beside_edges, 100);
        EXPECT_LT(worst, 1e-6) << order;
    }
}

TEST("the shapes of the tree are closed, lie about their waterline, and carry colours") {
    for (const char* name : {"duck", "boat", "buoy"}) {
        const auto file = std::filesystem::path(WEIR_SOURCE_DIR) / "cases/shapes" / (std::string(name) + ".ply");
        const Mesh mesh(read_triangles(file), 64, name);
        EXPECT_GT(mesh.volume(), 0.2) << name;
        EXPECT_LT(mesh.triangles().corners.size(), 20000U) << name;
        EXPECT_EQ(mesh.triangles().colours.size(), mesh.triangles().points.size()) << name;
        EXPECT_LT(mesh.min()[1], -0.1) << name;
        EXPECT_GT(mesh.max()[1], 0.5) << name;
        EXPECT_NEAR(mesh.centre()[2], 0, 1e-3) << name;  // one side like the other
    }
}

}  // namespace meshes_tests
