// Water beside solids that cut its cells: it slides along them without losing or gaining speed, and no transfer feeds on what stands
// inside them.
#include "free_surface/solid_faces.hpp"
#include "support.hpp"

#include <algorithm>
#include <cmath>

namespace solids_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// A layer of water on a floor that cuts its cells, all moving along it at 1 m/s, without gravity; x (and z) are periodic.
template <int D>
std::string sliding_layer(const std::string& transfer) {
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {}, periodic = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
solids = [ {{ shape = "box", min = {}, max = {} }} ]
initial = {{ velocity = {{ name = "constant", value = {} }} }}
scheme = {{ transfer = "{}" }}
)",
                       D, list({"12", "16", "8"}, D), list({"0.75", "1.0", "0.5"}, D), D == 2 ? "[\"x\"]" : "[\"x\", \"z\"]",
                       list({"-1.0", "0.195", "-1.0"}, D), list({"2.0", "0.6", "2.0"}, D), list({"-1.0", "-1.0", "-1.0"}, D),
                       list({"2.0", "0.195", "2.0"}, D), list({"1.0", "0.0", "0.0"}, D), transfer);
}

/// A column of water, 0.4 m high, runs against a pillar that stands at no cell's side.
std::string pillar(const std::string& transfer, real radius) {
    return fmt::format(R"(solver = "mac_water"
dim = 3
grid = {{ cells = [40, 20, 20], size = [1.0, 0.5, 0.5] }}
time = {{ end = 1.0, cfl = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = [0.0, 0.0, 0.0], max = [0.4, 0.4, 0.5] }} ]
solids = [ {{ shape = "cylinder", from = [0.7, -0.1, 0.25], to = [0.7, 0.6, 0.25], radius = {} }} ]
effects = {{ gravity = {{ g = [0.0, -9.81, 0.0] }} }}
scheme = {{ transfer = "{}" }}
)",
                       radius, transfer);
}

/// A ball that swings to and fro in a tank half full of water, 0.63 m/s at most.
template <int D>
std::string swinging_ball(const std::string& transfer) {
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 4.0, cfl = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
solids = [ {{ shape = "sphere", centre = {}, radius = 0.1, motion = {{ kind = "sinusoidal", amplitude = {}, frequency = 0.5 }} }} ]
effects = {{ gravity = {{ g = {} }} }}
scheme = {{ transfer = "{}" }}
)",
                       D, list({"32", "24", "12"}, D), list({"1.0", "0.75", "0.375"}, D), list({"0.0", "0.0", "0.0"}, D),
                       list({"1.0", "0.4", "0.375"}, D), list({"0.5", "0.25", "0.2"}, D), list({"0.2", "0.0", "0.0"}, D),
                       list({"0.0", "-9.81", "0.0"}, D), transfer);
}

/// The speeds that water can reach which falls from `height`, and a step that its fastest part crosses a cell in. A steady jet has at most
/// √(2 g H) (Bernoulli). Where a front meets a wall the jet is faster for a while (Wagner 1932; tips at three times the front's speed are
/// seen with no solid but the domain's wall): four times is allowed. What feeds on itself passes every bound within some ten steps.
struct Limits {
    real speed, dt;
    Limits(real height, real h, real driven = 0)
        : speed(4 * (std::sqrt(2 * 9.81 * height) + driven)), dt(h / (speed + std::sqrt(9.81 * h))) {}
};

template <int D>
real fastest_marker(const water::Water<D>& water) {
    real fastest = 0;
    for (std::size_t p = 0; p < water.markers().count(); ++p) {
        Vec<D> v;
        for (int d = 0; d < D; ++d) v[d] = water.markers().v[static_cast<std::size_t>(d)][p];
        fastest = std::max(fastest, norm(v));
    }
    return fastest;
}

/// Leaves numbers on the stack where the next function has its own.
[[gnu::noinline]] void litter() {
    volatile real stack[4096];
    for (volatile real& value : stack) value = 1e9;
}

}  // namespace

// What is left differs from thread to thread and from call to call: nothing may be made of it.
TEST_IN_2D_AND_3D("inside a solid a component of which nothing is known beside a face counts as none, whatever is left in memory") {
    const Vec<D> centre = Vec<D>::constant(0.5);
    const auto scene =
        water_scene(fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
solids = [ {{ shape = "sphere", centre = {}, radius = 0.23 }} ]
)",
                                D, list({"16", "16", "16"}, D), list({"1.0", "1.0", "1.0"}, D), list({"0.0", "0.0", "0.0"}, D),
                                list({"0.1", "1.0", "1.0"}, D), list({"0.5", "0.5", "0.5"}, D)));
    mac::MacState<D> state(scene, FieldPlan{});
    const free_surface::Frame<D> frame(state.u, state.sides);
    mac::SolidPlacement<D> placement(geometry::Solids<D>(scene.root().tables("solids")), state);
    free_surface::FacesInSolids<D> in_solids;
    in_solids.find(placement, state, frame, true);
    free_surface::FaceMarks<D> known;
    for (int a = 0; a < D; ++a) {
        known[static_cast<std::size_t>(a)] = Grid<std::uint8_t, D>(state.u[a].extent());
        known[static_cast<std::size_t>(a)].fill(a == 1 ? 1 : 0);
        state.u[a].fill(1);
    }
    litter();
    in_solids.constrain(state.u, known, frame);
    for (const Index<D>& I : in_solids.faces()[1]) {
        const Vec<D> away = state.u.face_centre(1, I) - centre;
        const real ny = norm(away) > 0 ? away[1] / norm(away) : 0;
        if (norm(away) > 0.1) {
            EXPECT_NEAR(state.u[1](I), 1 - ny * ny, 1e-5);  // n by differences over h/1000
        }
    }
    EXPECT_GT(in_solids.faces()[1].size(), 10u);
}

TEST_IN_2D_AND_3D("a layer that slides over a solid without friction keeps its speed, with every transfer") {
    // Exact for all of them: the velocity is constant, and the continued one inside the solid is the same constant.
    for (const std::string transfer : {"grid", "pic", "flip", "apic"}) {
        water::Water<D> water(water_scene(sliding_layer<D>(transfer)));
        for (int step = 0; step < 30; ++step) water.step(0.02);
        for (std::size_t p = 0; p < water.markers().count() && transfer != "grid"; ++p) {
            ASSERT_NEAR(water.markers().v[0][p], 1, 1e-9) << transfer << ", marker " << p;
            ASSERT_NEAR(water.markers().v[1][p], 0, 1e-9) << transfer << ", marker " << p;
        }
        EXPECT_NEAR(integral(water, "momentum_x"), 1000 * integral(water, "volume"), 1e-6 * 1000 * integral(water, "volume")) << transfer;
    }
}

TEST("a front that meets a pillar splashes, but neither feeds on its own splash nor loses its time step") {
    const Limits limits(0.4, 0.025);
    for (const auto& [transfer, radius] : {std::pair{"flip", 0.06}, {"flip", 0.08}, {"apic", 0.075}}) {
        water::Water<3> water(water_scene(pillar(transfer, radius)));
        while (water.time() < 0.33) {
            const real dt = water.advised_dt();
            ASSERT_GT(dt, limits.dt) << transfer << ", radius " << radius << ", t = " << water.time();
            water.step(dt);
            ASSERT_LT(fastest_marker(water), limits.speed) << transfer << ", radius " << radius << ", t = " << water.time();
        }
        EXPECT_GT(integral(water, "front_x"), 0.8) << "it passed the pillar";
    }
}

TEST_IN_2D_AND_3D("water that a moving solid stirs stays as calm as the solid is") {
    const Limits limits(0.2, 0.03125, 0.63);  // waves stay below half of the depth
    for (const std::string transfer : {"flip", "apic"}) {
        water::Water<D> water(water_scene(swinging_ball<D>(transfer)));
        while (water.time() < (D == 2 ? 2 : 0.6)) {
            const real dt = water.advised_dt();
            ASSERT_GT(dt, limits.dt) << transfer << ", t = " << water.time();
            water.step(dt);
            ASSERT_LT(fastest_marker(water), limits.speed) << transfer << ", t = " << water.time();
        }
    }
}

TEST("water at rest sees a body coming: without gravity too it goes a cell a step at most") {
    // cfl = 1: the body's own speed, 5 m/s, must not cross more than one of 32 cells of 1/32 m
    water::Water<2> water(water_scene(R"(solver = "mac_water"
dim = 2
grid = { cells = [32, 32], size = [1.0, 1.0] }
time = { end = 0.1, cfl = 1.0 }
fluid = { density = 1000.0 }
liquid = [ { shape = "box", min = [0.0, 0.0], max = [1.0, 0.5] } ]
solids = [ { shape = "sphere", centre = [0.2, 0.25], radius = 0.1, motion = { kind = "constant", velocity = [5.0, 0.0] } } ]
)"));
    EXPECT_LE(water.advised_dt(), 1.0 / 32 / 5.0 * (1 + 1e-9));
    water.step(water.advised_dt());
    EXPECT_GT(fastest_marker(water), 0) << "and it moves the water";
}

TEST("beside solids at rest and moving ones, one thread and three give the same bits") {
    for (const std::string& text : {pillar("flip", 0.08), swinging_ball<3>("flip"), swinging_ball<3>("apic")}) {
        water::Water<3> one(water_scene(text)), three(water_scene(text));
        for (auto* water : {&one, &three}) {
            set_threads(water == &one ? 1 : 3);
            for (int step = 0; step < 12; ++step) water->step(water->advised_dt());
        }
        set_threads(1);
        const auto same = [](const auto& a, const auto& b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); };
        for (int a = 0; a < 3; ++a) {
            EXPECT_TRUE(same(one.state().u[a].values(), three.state().u[a].values()));
            EXPECT_TRUE(same(one.markers().v[static_cast<std::size_t>(a)], three.markers().v[static_cast<std::size_t>(a)]));
        }
    }
}

}  // namespace solids_tests
