// Columns that pull their neighbours: the fast sweep against the plain one, bits for any number of threads, objects and the water they
// displace.
#include "core/parallel.hpp"
#include "heightfield/sweep.hpp"
#include "support/test.hpp"
#include "unit/heightfield/support.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace columns_tests {

using namespace weir;
using namespace weir::heightfield;

namespace {

scene::Scene columns(int dim, const std::string& more, int cells = 24) {
    const std::string floor = dim == 2 ? "[0, -1]" : "[0, -1, 0]";
    return test::height_scene(dim, "grid.origin = " + floor + "\nscheme.model = \"columns\"\n" + more, cells);
}
real value(const Solver& solver, const std::string& name) {
    for (const auto& i : solver.integrals())
        if (i.name == name) return i.value;
    return std::nan("");
}
std::vector<real> everything(const Solver& solver) {
    std::vector<real> all;
    for (const auto& f : solver.fields().fields)
        for (const auto& c : f.data) all.insert(all.end(), c.begin(), c.end());
    for (const auto& integral : solver.integrals()) all.push_back(integral.value);
    return all;
}
const std::string waves = "initial.surface = \"0.05*sin(9*x)\"\nterrain = { kind = \"formula\", height = \"-0.6 + 0.3*x\" }\n";
std::string floats(int dim) {
    return dim == 2
               ? "floats = [ { size = [0.3, 0.2], at = [0.41, -0.03], density = 0.4, motion = { kind = \"constant\", velocity = [0.3, 0] } "
                 "} ]\n"
               : "floats = [ { size = [0.3, 0.2, 0.4], at = [0.41, -0.03, 0.5], density = 0.4, motion = { kind = \"constant\", velocity = "
                 "[0.3, 0, 0.2] } }, { size = [0.2, 0.2, 0.2], at = [0.6, -0.1, 1.2], heave = false } ]\n";
}

}  // namespace

TEST_IN_2D_AND_3D("the fast sweep is the plain one, bit for bit where the pull varies and to round-off where it does not") {
    const Plane plane(columns(D, waves, 70));
    Field start(plane.extent()), rate(plane.extent());
    for (std::size_t c = 0; c < start.size(); ++c)
        start[c] = std::sin(0.7 * static_cast<real>(c)), rate[c] = std::cos(1.3 * static_cast<real>(c));
    Stiffness k;
    k.x = Field(replicated(Index<2>{{plane.nx + 1, plane.nz}}));
    k.z = Field(replicated(Index<2>{{plane.nx, plane.nz + 1}}));
    for (std::size_t f = 0; f < k.x.size(); ++f) k.x[f] = 1 + 0.5 * std::sin(static_cast<real>(f));
    for (std::size_t f = 0; D == 3 && f < k.z.size(); ++f) k.z[f] = 1 + 0.5 * std::cos(static_cast<real>(f));
    for (const bool periodic : {false, true})
        for (const bool uniform : {false, true}) {
            k.uniform = uniform, k.along_x = 1.25, k.along_z = D == 3 ? 0.75 : 0;
            for (const int count : {1, 2, 3}) {
                set_threads(count);
                Sweep sweep(plane, periodic, periodic && D == 3);
                Field s = start, w = rate, s0 = start, w0 = rate;
                for (int n = 0; n < 3; ++n) {
                    sweep.step(s, w, k, 0.1);
                    reference_sweep(plane, periodic, periodic && D == 3, s0, w0, k, 0.1);
                }
                for (std::size_t c = 0; c < s.size(); ++c) ASSERT_NEAR(s[c], s0[c], 1e-14) << c << ' ' << uniform << periodic << count;
            }
        }
    set_threads(0);
}

TEST_IN_2D_AND_3D("water and displaced volume are kept to round-off while objects heave and are dragged") {
    const auto solver = test::height_solver(columns(D, waves + floats(D), 40));
    const real before = value(*solver, "volume");
    real most = 0;
    for (int i = 0; i < 150; ++i) {
        solver->step(solver->advised_dt());
        EXPECT_NEAR(value(*solver, "volume"), before, 1e-12 * before);
        most = std::max(most, std::abs(value(*solver, "float0_speed")));
        // what the fields show is the same water: columns less what is displaced
        const FieldSet f = static_cast<const Solver&>(*solver).fields();
        real shown = 0;
        for (const real d : f.find("depth")->data[0]) shown += d;
        const GridView& g = f.grid;
        // the solve leaves 1e-14 of each covered column
        EXPECT_NEAR(shown * g.spacing[0] * (D == 3 ? g.spacing[2] : 1), before, 1e-10 * before);
    }
    EXPECT_GT(most, 0.01);
}

TEST_IN_2D_AND_3D("an object at rest stays at rest, as deep as Archimedes says, wherever its edges lie in their columns") {
    const std::string at = D == 2 ? "at = [0.4321, -0.08], size = [0.333, 0.2]" : "at = [0.4321, -0.08, 0.777], size = [0.333, 0.2, 0.222]";
    const auto solver = test::height_solver(columns(D,
                                                    "initial.surface = \"0\"\nterrain = { kind = \"formula\", height = \"-0.6 + 0.3*x\" }\n"
                                                    "floats = [ { " +
                                                        at + ", density = 0.4 } ]\n",
                                                    30));
    for (int i = 0; i < 100; ++i) solver->step(solver->advised_dt());
    const real area = D == 2 ? 0.333 : 0.333 * 0.222;
    EXPECT_NEAR(value(*solver, "float0_height"), -0.08, 1e-12);
    EXPECT_NEAR(value(*solver, "float0_displaced"), 0.08 * area, 1e-12);
    EXPECT_NEAR(value(*solver, "float0_force_x"), 0, 1e-10);
}

// The same object, pushed down, in the corner of the seams' beginnings, and 8 columns along x and 20 along z further on.
TEST_IN_2D_AND_3D("an object at a periodic seam makes the waves that it makes away from it") {
    constexpr int n = 40, m = n + 13, by_x = 8, by_z = 20;
    const auto run = [](bool away) {
        const real x = 0.105 + (away ? by_x * 1.0 / n : 0), z = 0.095 + (away ? by_z * 1.5 / m : 0);
        auto solver = test::height_solver(columns(
            D,
            fmt::format("grid.periodic = [\"x\"{}]\ninitial.surface = \"0\"\nterrain = {{ kind = \"formula\", height = \"-0.6\" }}\n"
                        "floats = [ {{ at = [{}, -0.12{}], size = [0.21, 0.2{}], density = 0.4 }} ]\n",
                        D == 3 ? ", \"z\"" : "", x, D == 3 ? fmt::format(", {}", z) : "", D == 3 ? ", 0.19" : ""),
            n));
        for (int i = 0; i < 60; ++i) solver->step(0.005);
        return solver;
    };
    const auto away = run(true), seam = run(false);
    EXPECT_NEAR(value(*seam, "float0_height"), value(*away, "float0_height"), 1e-11);  // round-off of places, over 60 steps
    EXPECT_GT(std::abs(value(*away, "float0_height") + 0.12), 1e-3);                   // it does heave
    const auto a = std::as_const(*seam).fields().find("", surface_height_name)->data[0],
               b = std::as_const(*away).fields().find("", surface_height_name)->data[0];
    for (int k = 0; k < (D == 3 ? m : 1); ++k)
        for (int i = 0; i < n; ++i) {
            const int there = (i + by_x) % n + n * (D == 3 ? (k + by_z) % m : 0);
            ASSERT_NEAR(a[static_cast<std::size_t>(i + n * k)], b[static_cast<std::size_t>(there)], 1e-11) << i << ' ' << k;
        }
}

// A float that spans one axis is a 2D problem along the other. Columns are 3 times as long along the spanned axis as along the other. 40
// steps leave some thousand units of round-off.
TEST("a float from wall to wall heaves as in 2D, along x and along z, in columns that are not squares") {
    const auto heave = [](int dim, const std::string& grid, const std::string& at, const std::string& size, const std::string& g,
                          const char* along) {
        const auto solver = test::height_solver(scene::parse(
            fmt::format("solver = \"heightfield\"\ntime = {{ end = 1.0 }}\ndim = {}\n{}\neffects.gravity.g = {}\nscheme.model = "
                        "\"columns\"\ninitial.surface = \"0.02*cos(5*{})\"\nterrain = {{ kind = \"formula\", height = \"-0.5\" }}\n"
                        "floats = [ {{ size = {}, at = {}, density = 0.4 }} ]\n",
                        dim, grid, g, along, size, at),
            "scene.toml", {heightfield::kind().schema}));
        std::vector<real> heights;
        for (int i = 0; i < 40; ++i) solver->step(0.004), heights.push_back(value(*solver, "float0_height"));
        return heights;
    };
    const auto plane =
        heave(2, "grid = { cells = [40, 1], size = [1.0, 1.0], origin = [0, -1] }", "[0.43, -0.14]", "[0.3, 0.2]", "[0, -9.81]", "x");
    const auto by_x = heave(3, "grid = { cells = [40, 1, 8], size = [1.0, 1.0, 0.6], origin = [0, -1, 0] }", "[0.43, -0.14, 0.3]",
                            "[0.3, 0.2, 0.6]", "[0, -9.81, 0]", "x");
    const auto by_z = heave(3, "grid = { cells = [8, 1, 40], size = [0.6, 1.0, 1.0], origin = [0, -1, 0] }", "[0.3, -0.14, 0.43]",
                            "[0.6, 0.2, 0.3]", "[0, -9.81, 0]", "z");
    EXPECT_GT(std::abs(plane.back() + 0.14), 1e-3);  // it does heave
    for (std::size_t i = 0; i < plane.size(); ++i) {
        EXPECT_NEAR(by_x[i], plane[i], 1e-12) << i;
        EXPECT_NEAR(by_z[i], plane[i], 1e-12) << i;
    }
}

// Held in water whose surface is tilted, an object is pushed down the slope by rho g d^2/2 for each metre of an upright side, d the depth
// of its outermost columns below their water. Its sides stand on edges of columns.
TEST_IN_2D_AND_3D("the horizontal force on a float in tilted water is the difference of rho g d^2/2 of its two sides") {
    constexpr int n = 30, m = n + 13;
    constexpr real dx = 1.0 / n, dz = 1.5 / m, slope = 0.1, underside = -0.12;
    for (const bool along_z : {false, true}) {
        if (D == 2 && along_z) continue;
        const std::string size = D == 2 ? fmt::format("[{}, 0.2]", 9 * dx) : fmt::format("[{}, 0.2, {}]", 9 * dx, 10 * dz),
                          at = D == 2 ? fmt::format("[{}, {}]", 13.5 * dx, underside)
                                      : fmt::format("[{}, {}, {}]", 13.5 * dx, underside, 15 * dz);
        const auto solver = test::height_solver(columns(D,
                                                        fmt::format("fluid.density = 1000.0\n"
                                                                    "initial.surface = \"{}*{}\"\n"
                                                                    "floats = [ {{ heave = false, at = {}, size = {} }} ]\n",
                                                                    slope, along_z ? "z" : "x", at, size),
                                                        n));
        const real first = along_z ? 10.5 * dz : 9.5 * dx, last = along_z ? 19.5 * dz : 17.5 * dx,
                   side = D == 2    ? 1
                          : along_z ? 9 * dx
                                    : 10 * dz;
        const real low = slope * first - underside, high = slope * last - underside,
                   push = 0.5 * 1000 * 9.81 * (low * low - high * high) * side;
        EXPECT_NEAR(value(*solver, along_z ? "float0_force_z" : "float0_force_x"), push, 1e-10 * std::abs(push)) << along_z;
    }
}

TEST_IN_2D_AND_3D("the same bits for any number of threads, and after a restart, with objects") {
    std::vector<real> first;
    for (const int count : {1, 3}) {
        set_threads(count);
        const scene::Scene scene = columns(D, waves + floats(D) + "effects.damping.rate = 0.5\nsides.x_max = \"outflow\"\n", 60);
        const auto whole = test::height_solver(scene), half = test::height_solver(scene), rest = test::height_solver(scene);
        for (int i = 0; i < 20; ++i) whole->step(0.002);
        for (int i = 0; i < 9; ++i) half->step(0.002);
        Checkpoint saved;
        half->save(saved);
        rest->restore(saved);
        EXPECT_EQ(everything(*half), everything(*rest));
        for (int i = 0; i < 11; ++i) rest->step(0.002);
        EXPECT_EQ(everything(*whole), everything(*rest)) << count;
        if (first.empty()) first = everything(*whole);
        EXPECT_EQ(everything(*whole), first) << count;
    }
    set_threads(0);
}

TEST("what columns cannot do is refused by name") {
    const auto told = [](const std::string& more) {
        try {
            (void)test::height_solver(columns(2, "initial.surface = \"0\"\n" + more));
        } catch (const BadInput& bad) {
            return std::string(bad.what());
        }
        return std::string("accepted");
    };
    const auto has = [](const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; };
    EXPECT_EQ(told(""), "accepted");
    EXPECT_TRUE(has(told("effects.rain.rate = 0.1\n"), "has no currents and keeps the still depth"));
    EXPECT_TRUE(has(told("initial.velocity = { name = \"constant\", value = [1, 0] }\n"), "scheme.model = \"columns\" has no currents"));
    EXPECT_TRUE(has(told("sides.x_min = { kind = \"level\", level = 0.1 }\n"), "has no inflow"));
    EXPECT_TRUE(
        has(told("floats = [ { size = [0.2, 0.2], at = [0.5, 0], density = 1.5 } ]\n"), "an object at least as dense as water sinks"));
    EXPECT_TRUE(
        has(told("floats = [ { size = [0.2, 0.2], at = [0.5, 0], motion = { kind = \"rotation\", rate = 1 } } ]\n"), "do not rotate"));
}

TEST("a column that runs dry ends the run with a reason") {
    const auto solver = test::height_solver(
        columns(2, "initial.surface = \"-0.03*exp(-(x-0.2)^2/0.005)\"\nterrain = { kind = \"formula\", height = \"-0.06 + 0.05*x\" }\n"));
    try {
        for (int i = 0; i < 400; ++i) solver->step(solver->advised_dt());
        ADD_FAILURE() << "nothing ran dry";
    } catch (const NumericalFailure& failure) {
        EXPECT_NE(std::string(failure.what()).find("became dry"), std::string::npos);
    }
}

TEST("far ahead of a wave the surface is level, and no number there is too small for a processor's fast ways") {
    const Plane plane(columns(2, waves, 2000));
    Sweep sweep(plane, false, false);
    Stiffness k;
    k.uniform = true, k.along_x = 1, k.along_z = 0;
    Field s(plane.extent()), w(plane.extent()), s0, w0;
    s[0] = 1;
    s0 = s, w0 = w;
    for (int n = 0; n < 900; ++n) {
        sweep.step(s, w, k, 0.3);
        reference_sweep(plane, false, false, s0, w0, k, 0.3);
    }
    int tiny = 0;
    for (std::size_t c = 0; c < s.size(); ++c) {
        tiny += std::fpclassify(s[c]) == FP_SUBNORMAL || std::fpclassify(w[c]) == FP_SUBNORMAL;
        ASSERT_NEAR(s[c], s0[c], 1e-13);
    }
#ifdef __SSE__
    EXPECT_EQ(tiny, 0);
#endif
    EXPECT_NE(s[300], 0) << "a wave is there";
}

TEST("an object that is dragged faster than waves passes a part of a column a step; its pressure is not water over its top") {
    const auto dragged = [](const std::string& velocity, const std::string& more) {
        return test::height_solver(columns(3,
                                           "initial.surface = \"0\"\nfloats = [ { size = [0.1, 0.1, 0.2], at = [0.2, -0.02, 0.75], heave = "
                                           "false, motion = { kind = \"constant\", velocity = " +
                                               velocity + " } } ]\n" + more,
                                           40));
    };
    const real still = dragged("[0, 0, 0]", "")->advised_dt();
    const auto fast = dragged("[12, 0, 0]", "");  // sqrt(g d) is 3.1 m/s
    EXPECT_LT(fast->advised_dt(), still);
    EXPECT_NEAR(fast->advised_dt() * 12 * 40, 0.45, 1e-12);
    for (int i = 0; i < 40; ++i) {
        fast->step(fast->advised_dt());
        EXPECT_EQ(fast->concern(), "");
    }
    const auto under = dragged("[0, -0.5, 0]", "");
    for (int i = 0; i < 60 && under->concern().empty(); ++i) under->step(under->advised_dt());
    EXPECT_NE(under->concern().find("above the top of a float"), std::string::npos);
}

// A regression pin: bends between columns, over the draft, are 0.14 with edges as sharp as the grid lets them be, and 0.065 with smeared
// ones.
TEST("an object that passes column after column leaves waves behind and no comb") {
    const auto solver =
        test::height_solver(columns(3,
                                    "initial.surface = \"0\"\nfloats = [ { size = [0.2, 0.2, 0.4], at = [0.2, -0.02, 0.75], "
                                    "heave = false, motion = { kind = \"constant\", velocity = [2, 0, 0] } } ]\n",
                                    40));
    real t = 0;
    for (; t < 0.25;) t += solver->step(solver->advised_dt()).dt;
    const FieldSet fields = static_cast<const Solver&>(*solver).fields();
    const auto &s = fields.find("surface")->data[0], &below = fields.find("displaced")->data[0];
    const auto nx = static_cast<std::size_t>(fields.grid.cells[0]);
    real sum = 0;
    int count = 0;
    for (std::size_t c = 1; c + 1 < s.size(); ++c) {
        if (c % nx == 0 || c % nx == nx - 1 || below[c - 1] + below[c] + below[c + 1] > 0) continue;
        const real bend = s[c - 1] - 2 * s[c] + s[c + 1];
        sum += bend * bend, ++count;
    }
    EXPECT_LT(std::sqrt(sum / count) / 0.02, 0.1);
}

}  // namespace columns_tests
