// Terrain and water of a scene: formulas, grids, images, shapes; and what is wrong with them, where it stands.
#include "core/parallel.hpp"
#include "heightfield/raster.hpp"
#include "heightfield/start.hpp"
#include "scene/formula.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"
#include "unit/heightfield/support.hpp"

#include <fmt/format.h>

#include <fstream>

namespace terrain_tests {

using namespace weir;
using namespace weir::heightfield;

namespace {

std::filesystem::path written(const test::TemporaryFolder& folder, const std::string& name, const std::string& text) {
    std::ofstream(folder.path() / name, std::ios::binary) << text;
    return folder.path() / name;
}
template <class F>
std::string refusal(F&& f) {
    try {
        f();
    } catch (const BadInput& bad) {
        return bad.what();
    }
    return "accepted";
}
bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string header = "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 2\nNODATA_value -9999\n";

}  // namespace

TEST("an ASCII grid's rows run from north to south; it is bilinear between centres") {
    const test::TemporaryFolder folder;
    const Raster r = read_asc(written(folder, "a.asc", header + "4 5 6\n1 2 3\n"), {});
    EXPECT_EQ(r(11, 21), 1);
    EXPECT_EQ(r(15, 23), 6);
    EXPECT_EQ(r(12, 21), 1.5);
    EXPECT_EQ(r(13, 22), 3.5);
    EXPECT_EQ(r(0, 0), 1);  // the nearest centre's
}

TEST("what is wrong with an ASCII grid is told with its line and column") {
    const test::TemporaryFolder folder;
    const auto told = [&](const std::string& text) { return refusal([&] { (void)read_asc(written(folder, "a.asc", text), {}); }); };
    EXPECT_TRUE(has(told(header + "4 5 6\n1 x2 3\n"), "a.asc:8:3: \"x2\" stands where height 2 of row 2"))
        << told(header + "4 5 6\n1 x2 3\n");
    EXPECT_TRUE(has(told(header + "4 5 6\n1 2\n"), "a.asc:9:1: the file ends where height 3 of row 2"));
    EXPECT_TRUE(has(told(header + "4 5 6\n1 2 3 9\n"), "a.asc:8:7: \"9\" follows the last of 3 x 2"));
    EXPECT_TRUE(has(told(header + "4 5 6\n1 -9999 3\n"), "a.asc:8:3: missing data"));
    EXPECT_TRUE(has(told("ncols 3\nnrow 2\n"), "a.asc:2:1: \"nrow\" is not a key"));
    EXPECT_TRUE(has(told("ncols 0\n"), "a.asc:1:7: ncols is 0"));
    EXPECT_TRUE(has(told("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\n1 2 3\n"), "a.asc:5:1: the header ends here and lacks cellsize"));
    EXPECT_TRUE(has(told(""), "lacks ncols"));
    EXPECT_TRUE(has(refusal([] { (void)read_asc("/nowhere.asc", {}); }), "cannot be read"));
}

TEST("more cells than the file has bytes are refused before they are allocated, and what has no end is not read") {
    const test::TemporaryFolder folder;
    const std::string asc = "ncols 16384\nnrows 16384\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n";  // 2 GiB of heights
    EXPECT_TRUE(
        has(refusal([&] { (void)read_asc(written(folder, "a.asc", asc), {}); }), "the header declares 268435456 cells; the file has only"));
    EXPECT_TRUE(
        has(refusal([&] { (void)read_pgm(written(folder, "a.pgm", "P2 16384 16384 1\n0 1\n")); }), "the header declares 268435456 cells"));
    EXPECT_TRUE(has(refusal([&] { (void)read_pgm(written(folder, "b.pgm", "P5 16384 16384 1\n0 1\n")); }), "the picture ends after"));
    EXPECT_TRUE(has(refusal([] { (void)read_asc("/dev/zero", {}); }), "this is a device or a pipe"));
    EXPECT_TRUE(has(refusal([] { (void)read_pgm("/dev/zero"); }), "this is a device or a pipe"));
}

TEST("grey maps, written out and in bytes") {
    const test::TemporaryFolder folder;
    const Raster text = read_pgm(written(folder, "a.pgm", "P2\n# c\n2 2\n10\n0 5\n10 1\n"));
    const Raster bytes = read_pgm(written(folder, "b.pgm", std::string("P5 2 2 10\n") + '\0' + '\5' + '\12' + '\1'));
    EXPECT_EQ(text.value, bytes.value);
    EXPECT_EQ(text.value, (std::vector<real>{0, 0.5, 1, 0.1}));
    const auto told = [&](const std::string& t) { return refusal([&] { (void)read_pgm(written(folder, "a.pgm", t)); }); };
    EXPECT_TRUE(has(told("P6\n"), "a.pgm:1:1: \"P6\" is not the beginning of a grey map"));
    EXPECT_TRUE(has(told("P2\n2 2\n10\n0 5\n11 1\n"), "a.pgm:5:1: 11 is not a grey value from 0 to 10"));
    EXPECT_TRUE(has(told("P5 2 2 10\n12"), "the picture ends after 2 of 4 bytes"));
}

TEST("formulas: precedence, functions, and where they are wrong") {
    const auto f = [](const std::string& text, real x = 0, real z = 0) {
        const real at[2] = {x, z};
        return scene::Formula(text, {"x", "z"})(at);
    };
    EXPECT_EQ(f("1 + 2*3^2"), 19);
    EXPECT_EQ(f("-x^2", 3), -9);
    EXPECT_EQ(f("2^-1"), 0.5);
    EXPECT_EQ(f("2^3^2"), 512);
    EXPECT_EQ(f("8/4/2"), 1);
    EXPECT_EQ(f("max(x, min(z, 7)) - step(x)", 1, 9), 6);
    EXPECT_EQ(f("1e-3*x", 2), 0.002);
    EXPECT_NEAR(f("sin(pi/6) + sech(0) + hypot(3, 4)"), 6.5, 1e-15);
    const auto wrong = [](const std::string& text) {
        try {
            scene::Formula(text, {"x"});
        } catch (const scene::BadFormula& bad) {
            return std::to_string(bad.at) + ": " + bad.what();
        }
        return std::string("accepted");
    };
    EXPECT_EQ(wrong("1 + y"), "4: unknown name \"y\" in the formula");
    EXPECT_EQ(wrong("2 x"), "2: \"x\" is not expected here");
    EXPECT_EQ(wrong("(1 + x"), "6: a closing bracket is missing");
    EXPECT_EQ(wrong("1 +"), "3: the formula ends where a value is expected");
    EXPECT_EQ(wrong("sin x"), "0: unknown name \"sin\" in the formula");
    EXPECT_EQ(wrong("max(1)"), "5: \"max\" requires another number of arguments");
    EXPECT_EQ(wrong("x = 2"), "2: \"=\" is not expected here") << "a formula changes nothing";
    EXPECT_EQ(wrong("x, 2"), "0: one value is expected");
    EXPECT_EQ(f("x <= 2 ? 1 : 0", 2), 1);
}

TEST("a formula takes one value for each variable, looks at no more, and does with no fewer") {
    const scene::Formula f("2*x", {"x"});
    const real two[] = {3, 1e300}, none[] = {0};
    EXPECT_EQ(f(two), 6);  // under the address sanitizer: nothing is written beyond the one variable
    EXPECT_THROW(f(std::span<const real>(none, 0)), std::logic_error);
}

TEST("a formula that threads ask at once answers each of them") {
    const scene::Formula f("x^2 + sin(z)", {"x", "z"});
    constexpr int count = 200000;
    std::vector<real> value(count);
    const int before = set_threads(4);
    parallel_for(0, count, [&](int i) {
        const real at[2] = {0.001 * i, 0.002 * i};
        value[static_cast<std::size_t>(i)] = f(at);
    });
    set_threads(before);
    int wrong = 0;
    for (int i = 0; i < count; ++i) {
        const real at[2] = {0.001 * i, 0.002 * i};
        wrong += value[static_cast<std::size_t>(i)] != f(at);
    }
    EXPECT_EQ(wrong, 0);
}

TEST("a mistake in a scene's formula stands at its own column") {
    const std::string text = "terrain = { kind = \"formula\", height = \"0.1*x + q\" }\n";
    const std::string told = refusal([&] { (void)test::height_solver(test::height_scene(2, text)); });
    EXPECT_TRUE(has(told, ":7:49: terrain.height: unknown name \"q\" in the formula")) << told;
}

TEST_IN_2D_AND_3D("boxes and planes fill columns to the last bit; what hangs above the bed is refused") {
    const std::string high = D == 2 ? "min = [0, -1], max = [1, 0.3]" : "min = [0, -1, 0], max = [1, 0.3, 1.5]";
    const scene::Scene box = test::height_scene(
        D, "liquid = [ { shape = \"box\", " + high + " } ]\nterrain = { kind = \"formula\", height = \"0.2*sin(7*x)\" }\n");
    const State state(box);
    for (std::size_t c = 0; c < state.h.size(); ++c) EXPECT_EQ(state.h[c], std::max(0.0, 0.3 - state.bed[c]));
    const std::string drop = D == 2 ? "centre = [0.5, 0.6]" : "centre = [0.5, 0.6, 0.5]";
    const std::string told =
        refusal([&] { State s(test::height_scene(D, "liquid = [ { shape = \"sphere\", " + drop + ", radius = 0.2 } ]\n")); });
    EXPECT_TRUE(has(told, "this water is above air")) << told;
}

TEST_IN_2D_AND_3D("solids raise the bed by their height and by the part of a column that they cover; floating ones are refused") {
    const std::string more = "initial.surface = \"0.2\"\nsolids = [ { shape = \"box\", ";
    const auto scene = [&](const std::string& two, const std::string& three) {
        return test::height_scene(D, more + (D == 2 ? two : three) + " } ]\n", 8);
    };
    const State state(scene("min = [0.25, 0], max = [0.5625, 0.4]", "min = [0.25, 0, 0], max = [0.5625, 0.4, 1.5]"));
    for (int k = 0; k < state.plane.nz; ++k) {
        EXPECT_EQ(state.bed[state.plane.at(1, k)], 0);
        EXPECT_NEAR(state.bed[state.plane.at(2, k)], 0.4, 1e-15);
        EXPECT_NEAR(state.bed[state.plane.at(4, k)], 0.2, 1e-15);  // half of the column from 0.5 to 0.625
        EXPECT_EQ(state.h[state.plane.at(2, k)], 0);
    }
    const std::string told = refusal(
        [&] { (void)test::height_solver(scene("min = [0.3, 0.1], max = [0.6, 0.4]", "min = [0.3, 0.1, 0], max = [0.6, 0.4, 1]")); });
    EXPECT_TRUE(has(told, "this solid has air or water below it")) << told;
}

TEST_IN_2D_AND_3D("where no solid is the bed stays, however deep it lies") {
    const std::string box = D == 2 ? "min = [0.25, -3], max = [0.5, -2.5]" : "min = [0.25, -3, 0], max = [0.5, -2.5, 1.5]";
    const State state(test::height_scene(
        D,
        std::string("grid.origin = ") + (D == 2 ? "[0, -3]" : "[0, -3, 0]") +
            "\ninitial.surface = \"-2.2\"\nterrain = { kind = \"formula\", height = \"-2.9\" }\nsolids = [ { shape = \"box\", " + box +
            " } ]\n",
        8));
    for (int i = 0; i < state.plane.nx; ++i) EXPECT_NEAR(state.bed[state.plane.at(i, 0)], i == 2 || i == 3 ? -2.5 : -2.9, 1e-15) << i;
}

TEST_IN_2D_AND_3D("liquid of any thickness is there: a film, a slope, the cap of a ball, in a domain many times as high") {
    const std::string z0 = D == 2 ? "" : ", 0.0", z1 = D == 2 ? "" : ", 1.5", mid = D == 2 ? "" : ", 0.75";
    const auto depths = [&](const std::string& shape) {
        const State s(test::height_scene(D, "liquid = [ { " + shape + " } ]\nterrain = { kind = \"formula\", height = \"0\" }\n"));
        return std::vector<real>(s.h.data(), s.h.data() + s.h.size());
    };
    for (const real thick : {0.4, 1.0 / 128, 1e-3, 1e-6, 1e-9})
        for (const real h : depths(fmt::format("shape = \"box\", min = [0.0, 0.0{}], max = [1.0, {}{}]", z0, thick, z1)))
            ASSERT_EQ(h, thick);           // a box ends where it says
    for (const real thick : {1e-3, 1e-7})  // of a plane the height is within its rounding
        for (const real h : depths(fmt::format("shape = \"plane\", point = [0.5, {}{}], normal = [0.0, 1.0{}]", thick, mid, z0)))
            ASSERT_NEAR(h, thick, 1e-15);
    const State s(
        test::height_scene(D, fmt::format("liquid = [ {{ shape = \"sphere\", centre = [0.5, -0.99{}], radius = 1.0 }} ]\nterrain = {{ "
                                          "kind = \"formula\", height = \"0\" }}\n",
                                          mid)));
    for (int k = 0; k < s.plane.nz; ++k)
        for (int i = 0; i < s.plane.nx; ++i) {
            const real r2 = std::pow(s.plane.x(i) - 0.5, 2) + (D == 2 ? 0 : std::pow(s.plane.z(k) - 0.75, 2));
            ASSERT_NEAR(s.h[s.plane.at(i, k)], r2 < 1 ? std::max(0.0, std::sqrt(1 - r2) - 0.99) : 0, 1e-15) << i << ' ' << k;
        }
}

}  // namespace terrain_tests
