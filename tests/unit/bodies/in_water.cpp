// Bodies in water with a free surface: they float where Archimedes says, fall, rest, and come back from a checkpoint.
#include "support.hpp"

#include <algorithm>

namespace in_water_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// A tank of 1 m by 0.8 m, 0.4 m deep, with a body.
std::string tank(int cells, const std::string& body, const std::string& more = "") {
    return fmt::format(R"(solver = "mac_water"
dim = 2
grid = {{ cells = [{}, {}], size = [1.0, 0.8] }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = [0.0, 0.0], max = [1.0, 0.4] }} ]
effects = {{ gravity = {{ g = [0.0, -9.81] }} }}
bodies = [ {} ]
{}
)",
                       cells, cells * 4 / 5, body, more);
}

/// How deep a disc of radius 1 floats: (q − sin q cos q)/π = s, the depth is 1 − cos q.
real draft_of_disc(real s) {
    real low = 0, high = pi;
    for (int i = 0; i < 60; ++i) {
        const real q = 0.5 * (low + high);
        ((q - std::sin(q) * std::cos(q)) / pi < s ? low : high) = q;
    }
    return 1 - std::cos(low);
}

}  // namespace

TEST("discs and boxes float as deep as Archimedes says, to a tenth of a cell, at three resolutions") {
    const OneThread alone;
    for (const int cells : {20, 30, 40})
        for (const real s : {0.1, 0.5, 0.9}) {
            const real r = 0.15, y = 0.4 + r - r * draft_of_disc(s), h = 1.0 / cells;
            const auto disc = solver_of(
                tank(cells, fmt::format("{{ shape = \"sphere\", centre = [0.5, {}], radius = {}, density = {} }}", y, r, 1000 * s)));
            real sum = 0;
            int count = 0;
            for (; disc->time() < 1.0; ++count) disc->step(disc->advised_dt()), sum += shown(*disc, "position", 1);
            EXPECT_NEAR(sum / count, y, 0.1 * h) << "disc, " << cells << " cells, s = " << s;
            const real height = 0.12, low = 0.4 - s * height;
            const auto box = solver_of(tank(cells, fmt::format("{{ shape = \"box\", min = [0.31, {}], max = [0.71, {}], density = {} }}",
                                                               low, low + height, 1000 * s)));
            for (sum = 0, count = 0; box->time() < 1.0; ++count) box->step(box->advised_dt()), sum += shown(*box, "position", 1);
            EXPECT_NEAR(sum / count, low + height / 2, 0.1 * h) << "box, " << cells << " cells, s = " << s;
        }
}

TEST("a checkpoint of bodies that touch in the water continues bit for bit") {
    const OneThread alone;
    const std::string text = tank(24, bodies_that_touch(0.12));
    const auto one = solver_of(text), two = solver_of(text);
    for (int i = 0; i < 25; ++i) one->step(0.008);
    Checkpoint checkpoint;
    one->save(checkpoint);
    two->restore(checkpoint);
    for (int i = 0; i < 25; ++i) one->step(0.008), two->step(0.008);
    expect_same_bodies(*one, *two, 3, 2);
    expect_same_numbers(*one, *two, "water.markers.0");
}

TEST("bodies in space that collide in the water continue from a checkpoint bit for bit, and with two threads as with one") {
    const std::string text = R"(solver = "mac_water"
dim = 3
grid = { cells = [16, 12, 10], size = [0.8, 0.6, 0.5] }
time = { end = 1.0 }
fluid = { density = 1000.0 }
liquid = [ { shape = "box", min = [0.0, 0.0, 0.0], max = [0.4, 0.4, 0.5] } ]
effects = { gravity = { g = [0.0, -9.81, 0.0] } }
bodies = [ { shape = "box", min = [0.1, 0.3, 0.1], max = [0.3, 0.45, 0.3], density = 300.0, friction = 0.3, spin = [1.0, 0.5, 0.2] },
           { shape = "capsule", from = [0.45, 0.1, 0.2], to = [0.6, 0.15, 0.25], radius = 0.07, density = 700.0 } ]
)";
    const auto one = solver_of(text), two = solver_of(text);
    for (int i = 0; i < 12; ++i) one->step(0.01);
    Checkpoint checkpoint;
    one->save(checkpoint);
    two->restore(checkpoint);
    for (int i = 0; i < 12; ++i) {
        set_threads(1);
        one->step(0.01);
        set_threads(2);
        two->step(0.01);
    }
    set_threads(0);
    expect_same_bodies(*one, *two, 2, 3);
}

TEST("a moored mesh on a hinged arm in the water continues from a checkpoint bit for bit, and the joints hold") {
    const std::string text = fmt::format(R"(solver = "mac_water"
dim = 3
grid = {{ cells = [16, 12, 12], size = [0.8, 0.6, 0.6] }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = [0.0, 0.0, 0.0], max = [0.8, 0.3, 0.6] }} ]
effects = {{ gravity = {{ g = [0.0, -9.81, 0.0] }} }}
bodies = [ {{ name = "duck", shape = "mesh", file = "{}/cases/shapes/duck.ply", scale = 0.25, at = [0.25, 0.3, 0.3], density = 269.0 }},
           {{ name = "arm", shape = "capsule", from = [0.5, 0.4, 0.3], to = [0.65, 0.4, 0.3], radius = 0.04, density = 2000.0 }} ]
joints = [ {{ kind = "mooring", body = "duck", at = [0.25, 0.26, 0.3], anchor = [0.25, 0.0, 0.3], length = 0.2, stiffness = 2000.0, damping = 5.0 }},
           {{ kind = "hinge", body = "arm", at = [0.5, 0.4, 0.3] }} ]
)",
                                         WEIR_SOURCE_DIR);
    const auto one = solver_of(text), two = solver_of(text);
    for (int i = 0; i < 12; ++i) one->step(0.01);
    Checkpoint checkpoint;
    one->save(checkpoint);
    two->restore(checkpoint);
    for (int i = 0; i < 12; ++i) one->step(0.01), two->step(0.01);
    expect_same_bodies(*one, *two, 2, 3);
    const Vec<3> arm{{shown(*one, "position", 0, 1) - 0.5, shown(*one, "position", 1, 1) - 0.4, shown(*one, "position", 2, 1) - 0.3}};
    // It began 0.075 m from the hinge and has fallen by a quarter of a turn at most, at 10 radians a second: v dt/2 by a step's turn.
    EXPECT_NEAR(norm(arm), 0.075, 0.075 * 0.5 * (10 * 0.01) * (10 * 0.01));
    EXPECT_LT(arm[1], -0.02);
    EXPECT_LT(shown(*one, "position", 1, 0), 0.25 * 0.162 + 0.3);  // the line has drawn the duck down
}

TEST("fifty balls that a wave wedges in a heap are not thrown, though their estimated added mass is several times too small") {
    const OneThread alone;
    const real radius = 0.025;
    std::string balls;
    for (int i = 0; i < 50; ++i) {
        const int row = i / 8, column = i % 8;
        balls += fmt::format("{}{{ shape = \"sphere\", centre = [{:.4f}, {:.4f}], radius = {}, density = 500.0 }}", i == 0 ? "" : ", ",
                             0.54 + radius * (1 + 2.1 * column + 1.05 * (row % 2)), 0.002 + radius * (1 + 1.86 * row), radius);
    }
    const auto solver = solver_of(R"(solver = "mac_water"
dim = 2
grid = { cells = [32, 32], size = [1.0, 1.0] }
time = { end = 1.0 }
fluid = { density = 1000.0 }
liquid = [ { shape = "box", min = [0.0, 0.0], max = [0.5, 0.6] } ]
effects = { gravity = { g = [0.0, -9.81] } }
scheme = { transfer = "flip", poisson = { method = "multigrid", tolerance = 1e-6 } }
bodies = [ )" + balls + " ]\n");
    const auto sum_of = [&](std::initializer_list<std::string> names) {
        real sum = 0;
        for (const Integral& i : solver->integrals())
            if (std::find(names.begin(), names.end(), i.name) != names.end()) sum += i.value;
        return sum;
    };
    const real held = sum_of({"potential_energy", "bodies_potential_energy"});
    ASSERT_GT(held, 0);
    int steps = 0;
    for (; solver->time() < 0.2 && steps < 400; ++steps) {
        const real dt = solver->advised_dt();
        ASSERT_GT(dt, 1e-5) << solver->time();  // 0.2 s in 400 steps are 5e-4 s each: a hundredth of that is a body that flies
        solver->step(dt);
        ASSERT_LT(sum_of({"kinetic_energy", "bodies_kinetic_energy"}), held) << "nothing else puts energy in, t = " << solver->time();
    }
    EXPECT_LT(steps, 400);
}

TEST("a heavy body falls through the air as a stone, sinks, and lies still on the floor") {
    const OneThread alone;
    const auto solver = solver_of(tank(30, "{ shape = \"box\", min = [0.4, 0.55], max = [0.6, 0.7], density = 3000.0 }"));
    const real dt = 0.002;
    for (int i = 0; i < 50; ++i) solver->step(dt);  // 0.1 s: 4.9 cm of the 15 to the water
    EXPECT_NEAR(shown(*solver, "position", 1), 0.625 - 0.5 * 9.81 * 0.01, 1e-12);
    run(*solver, 2.5);
    EXPECT_NEAR(shown(*solver, "position", 1), 0.075, 2e-3);  // it may sink in by the contacts' slop, and lies flat
    EXPECT_NEAR(std::remainder(shown(*solver, "angle", 0), pi / 2), 0, 0.02);
    EXPECT_NEAR(shown(*solver, "velocity", 1), 0, 1e-3);
}

TEST("a scene without bodies holds no byte of them, and runs no pass") {
    const auto without = solver_of(tank(10, ""));
    without->step(0.01);
    for (const auto& entry : without->passes().list()) EXPECT_TRUE(entry.name != "bodies" && entry.name != "solids") << entry.name;
    const auto with = solver_of(tank(10, "{ shape = \"box\", min = [0.4, 0.3], max = [0.6, 0.5], density = 500.0 }"));
    with->step(0.01);
    std::int64_t placed = 0;
    for (const auto& entry : with->passes().list()) placed += entry.name == "solids" ? entry.calls : 0;
    EXPECT_EQ(placed, 1) << "what bodies close of the grid is found anew in each step, once, and timed";
    EXPECT_EQ(without->fields().find(rigid::body_set_name, "position"), nullptr);
}

TEST("a body that falls on water dives no deeper than a tenth of a cell before the water feels it, and throws up no more than it brought") {
    const OneThread alone;
    const int cells = 20;  // the surface lies on faces: the grid sees a body that dives from within a cell half a cell later
    const real h = 1.0 / cells, top = 0.4, size = 0.2, start = 0.59;
    const auto solver =
        solver_of(tank(cells, fmt::format("{{ shape = \"box\", min = [0.4, {}], max = [0.6, {}], density = 1.0 }}", start, start + size)));
    real speed = 0, before = start + size / 2;
    while (shown(*solver, "velocity", 1) <= speed) {  // it falls faster and faster until it lands
        speed = shown(*solver, "velocity", 1), before = shown(*solver, "position", 1);
        solver->step(solver->advised_dt());
    }
    EXPECT_LE(shown(*solver, "position", 1), before);
    EXPECT_GE(shown(*solver, "position", 1) - size / 2, top - 0.101 * h);  // the surface at rest is flat to the pressure's tolerance
    for (const Integral& integral : solver->integrals()) {
        if (integral.name == "kinetic_energy") {
            EXPECT_LE(integral.value, 0.5 * size * size * 2 * 9.81 * (start - top));
        }
    }
}

namespace {

/// What solids close of the grid as they stand, found in one sweep of all cells.
template <int D>
void expect_placed_as_a_whole(const mac::MacState<D>& s, const geometry::Solids<D>& solids, const scene::Scene& scene, bool with_velocity) {
    mac::MacState<D> whole(scene, {});
    mac::SolidPlacement<D> placement(solids, whole);
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        for (std::size_t f = 0; f < whole.solid.open[at].size(); ++f) {
            ASSERT_EQ(s.solid.open[at][f], whole.solid.open[at][f]) << "face " << f << " along " << a;
            if (with_velocity) {
                ASSERT_EQ(s.solid.velocity[at][f], whole.solid.velocity[at][f]) << "face " << f << " along " << a;
            }
        }
    }
    for (std::size_t c = 0; c < s.cells.size(); ++c)
        ASSERT_EQ(s.cells[c] == poisson::Cell::solid, whole.cells[c] == poisson::Cell::solid) << "cell " << c;
}

}  // namespace

TEST(
    "what bodies close is found in boxes about them as in the whole grid, bit for bit, of bodies that fall, float, stand and meet a wall") {
    const OneThread alone;
    const std::string text = tank(
        32,
        "{ shape = \"box\", min = [0.1, 0.5], max = [0.25, 0.6], density = 300.0, spin = [2.0] }, { shape = \"sphere\", centre = [0.5, "
        "0.4], radius = 0.08, density = 500.0 }, { shape = \"box\", min = [0.7, 0.0], max = [0.85, 0.1], density = 3000.0 }, { shape = "
        "\"sphere\", centre = [0.35, 0.7], radius = 0.05, density = 10.0, velocity = [-3.0, 0.0] }",
        "solids = [ { shape = \"box\", min = [0.93, -0.1], max = [1.1, 0.5] } ]");
    const scene::Scene scene = scene_of(text);
    const auto solver = water::kind().make(scene, {});
    const auto& state = dynamic_cast<const water::Water<2>&>(*solver).state();
    int moved = 0;
    for (int step = 0; step < 80; ++step) {
        const real before = shown(*solver, "position", 1, 0);
        solver->step(solver->advised_dt());
        moved += shown(*solver, "position", 1, 0) != before;
        rigid::Bodies<2> bodies(scene);
        const FieldSet fields = solver->fields();
        bodies.recall([&](const char* field, std::size_t component, std::size_t body) {
            return fields.find(rigid::body_set_name, field)->data[component][body];
        });
        geometry::Solids<2> solids(scene.root().tables("solids"));
        bodies.join(solids);
        bodies.place(solids);
        expect_placed_as_a_whole(state, solids, scene, false);
        if (::testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(moved, 70);
}

TEST(
    "what bodies close in space is found in boxes about them as in the whole grid, bit for bit, with the velocities that they close it "
    "at") {
    const OneThread alone;
    const scene::Scene scene =
        scene_of(box_that_strikes(", { shape = \"box\", min = [0.5, 0.11, 0.3], max = [0.6, 0.2, 0.4], density = 500.0 }"));
    auto bodies = mac::BodiesInFlow<3>::make(scene);
    mac::MacState<3> state(scene, {});
    mac::SolidPlacement<3> placement(mac::BodiesInFlow<3>::solids(scene, bodies.get()), state);
    bodies->start(state, placement);
    for (int step = 0; step < 60; ++step) {
        bodies->advance_free(placement, 0.01);
        state.time += 0.01;
        placement.place(state, state.time);
        expect_placed_as_a_whole(state, placement.solids(), scene, true);
        if (::testing::Test::HasFatalFailure()) return;
        bodies->solve(state, placement, 0.01, nullptr, 1e-6, nullptr);  // no fluid: they fall, turn, and meet the floor
    }
    EXPECT_LT(placement.changed().front().hi[0] - placement.changed().front().lo[0], 20);  // boxes, not the whole grid
}

}  // namespace in_water_tests
