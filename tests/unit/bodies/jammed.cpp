// A body that is pushed through a wall of the domain ends the run, with the body, the wall and the place named.
#include "support.hpp"

#include "core/error.hpp"
#include "rigid/inside.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"

namespace jammed_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// A box with a wall at one end of an axis; gravity points to it. `at` is the distance from this wall.
template <int D>
struct Towards {
    int axis, end;

    real coordinate(real at) const { return end == 0 ? at : 1 - at; }
    std::string vector(real along, real others) const {
        std::string text = "[";
        for (int a = 0; a < D; ++a) text += fmt::format("{}{:.6f}", a ? ", " : "", a == axis ? along : others);
        return text + "]";
    }
    std::string box(real from, real to, real others_from, real others_to) const {
        const real one = coordinate(from), other = coordinate(to);
        return fmt::format("shape = \"box\", min = {}, max = {}", vector(std::min(one, other), others_from),
                           vector(std::max(one, other), others_to));
    }
    std::string side(int which) const { return fmt::format("{}_{}", "xyz"[axis], which == 0 ? "min" : "max"); }

    /// Liquid half a metre deep, with a floating ball; a plate pushes it to the wall within a second. The opposite side is open.
    std::string scene(const std::string& solver, int cells, const std::string& wall = "wall") const {
        const real to_wall = end == 0 ? -1 : 1;
        const std::string liquid = solver == "mac" ? "" : "liquid = [ { " + box(-9, 0.5, -9, 9) + " } ]\n";
        return fmt::format(R"(solver = "{}"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.5 }}
fluid = {{ density = 1000.0 }}
effects = {{ gravity = {{ g = {} }} }}
sides = {{ {} = "{}", {} = "outflow" }}
solids = [ {{ {}, motion = {{ kind = "keyframes", frames = [ {{ t = 0.0 }}, {{ t = 1.0, offset = {} }} ] }} }} ]
bodies = [ {{ shape = "sphere", centre = {}, radius = 0.1, density = 500.0, name = "ball" }} ]
{}{})",
                           solver, D, D == 2 ? fmt::format("[{0}, {0}]", cells) : fmt::format("[{0}, {0}, {0}]", cells), vector(1, 1),
                           vector(9.81 * to_wall, 0), side(end), wall, side(1 - end), box(0.7, 0.8, 0.3, 0.7), vector(0.65 * to_wall, 0),
                           vector(coordinate(0.5), 0.5), solver == "two_phase" ? "gas = { density = 1.2 }\n" : "", liquid);
    }
};

Simulation simulation_of(const std::string& text) { return Simulation(scene::parse(text, "jammed.toml", sim::schemas())); }

template <int D>
void expect_jammed(const std::string& solver, int cells, const Towards<D>& to) {
    Simulation simulation = simulation_of(to.scene(solver, cells));
    try {
        simulation.run_until(1.5);
        FAIL() << solver << ": no failure at " << to.side(to.end);
    } catch (const NumericalFailure& failure) {
        const std::string said = failure.what();
        EXPECT_EQ(failure.quantity, "position");
        EXPECT_EQ(failure.step, simulation.steps() + 1);
        // The plate is nearer to the wall than the ball's diameter after 0.5 m of its path at 0.65 m/s, at 0.769 s; it stops at 1 s.
        EXPECT_GT(failure.time, 0.769) << said;
        EXPECT_LT(failure.time, 1.0 + 1e-9) << said;
        EXPECT_EQ(said.find("bodies[0] (\"ball\") is jammed: its centre, ["), 0u) << said;
        EXPECT_NE(said.find("m, is beyond the wall " + to.side(to.end) + " at "), std::string::npos) << said;
    }
}

TEST("a body that a moving solid pushes through a wall ends the run with its name, the wall and the place") {
    const OneThread alone;
    for (const std::string solver : {"mac_water", "two_phase", "mac"})
        for (const Towards<2> to : {Towards<2>{1, 0}, Towards<2>{1, 1}, Towards<2>{0, 1}}) expect_jammed(solver, 32, to);
    for (const std::string solver : {"pbf", "sph"}) expect_jammed(solver, 24, Towards<2>{1, 0});
    expect_jammed("mac_water", 16, Towards<3>{1, 0});
    expect_jammed("two_phase", 16, Towards<3>{2, 1});
}

TEST("a body may leave through an open side") {
    const OneThread alone;
    for (const std::string solver : {"mac_water", "two_phase"}) {
        Simulation simulation = simulation_of(Towards<2>{1, 0}.scene(solver, 32, "outflow"));
        ASSERT_NO_THROW(simulation.run_until(1.2)) << solver;
        EXPECT_LT(simulation.fields().find(rigid::body_set_name, "position")->data[1][0], -0.01) << solver;
    }
}

// The depth is a tenth of the bounding ball's radius, 0.0141 m. The side y_max is open.
TEST("a body beyond a wall is jammed where its deepest point moves further out, at every wall of the domain") {
    const scene::Scene scene = scene::parse(Towards<2>{1, 0}.scene("mac_water", 16), "jammed.toml", sim::schemas());
    const geometry::Solids<2> solids(scene);
    for (const auto& [axis, end] : {std::pair{0, 0}, {0, 1}, {1, 0}, {1, 1}})
        for (const real depth : {-0.05, 0.0135, 0.0148})
            for (const real speed : {-0.01, 0.01}) {
                rigid::Bodies<2> bodies(scene);
                const auto along = static_cast<std::size_t>(axis);
                const real out = end == 0 ? -1 : 1;
                rigid::Twist<2> by{};
                by[along] = out * (0.5 + depth);
                bodies[0].shift(by);
                bodies[0].velocity[along] = out * speed;
                const bool closed = axis != 1 || end != 1, jammed = closed && depth > 0.0141 && speed > 0;
                const auto check = [&] { rigid::require_inside(bodies.all(), bodies.surroundings(solids)); };
                if (jammed)
                    EXPECT_THROW(check(), NumericalFailure) << axis << end;
                else
                    EXPECT_NO_THROW(check()) << axis << end << ' ' << depth << ' ' << speed;
            }
}

// The box crosses 5 of its 20 cells in a step, strikes the ball and the wall, and overlaps the wall by 0.2 of its radius.
TEST("bodies that strike each other and a wall, turning by large angles in a step, overlap it, are separated, and end inside") {
    const scene::Scene scene = scene_of(box_that_strikes());
    auto bodies = mac::BodiesInFlow<3>::make(scene);
    mac::MacState<3> state(scene, {});
    mac::SolidPlacement<3> placement(mac::BodiesInFlow<3>::solids(scene, bodies.get()), state);
    bodies->start(state, placement);
    real furthest = 0;
    for (int step = 0; step < 60; ++step) {
        bodies->advance_free(placement, 0.01);
        state.time += 0.01;
        placement.place(state, state.time);
        bodies->solve(state, placement, 0.01, nullptr, 1e-6, nullptr);
        furthest = std::max(furthest, bodies->bodies()[0].at[0]);
    }
    EXPECT_GT(furthest, 1 + 0.1 * bodies->bodies()[0].radius);
    for (const auto& body : bodies->bodies().all())
        for (int a = 0; a < 3; ++a) {
            EXPECT_GT(body.at[a], 0);
            EXPECT_LT(body.at[a], state.extent()[a] * 0.05);
        }
}

}  // namespace

}  // namespace jammed_tests
