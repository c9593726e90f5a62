// Sides through which fluid enters and leaves: volumes, balances, backflow.
#include "support.hpp"

#include "core/error.hpp"

namespace side_tests {

using namespace weir;
using namespace weir::test;
using two_phase::TwoPhase;

namespace {

/// A channel of 2 m by 1 m (by 0.5 m), 1000:1, without forces. It is open on the right.
template <int D>
std::string channel(const std::string& inflow, const std::string& liquid, const std::string& more = "") {
    return fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 10.0 }}
fluid = {{ density = 1000.0 }}
gas = {{ density = 1.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
sides = {{ x_min = {}, x_max = "outflow" }}
scheme = {{ poisson = {{ tolerance = 1e-10 }} }}
{}
)",
                       D, list({"24", "12", "6"}, D), list({"2.0", "1.0", "0.5"}, D), list({"-1.0", "-1.0", "-1.0"}, D), liquid, inflow,
                       more);
}

template <int D>
std::string inflow(const char* fluid) {
    return "{ kind = \"inflow\", velocity = " + list({"0.8", "0.0", "0.0"}, D) + ", fluid = \"" + fluid + "\" }";
}

template <int D>
real cross_section() {
    return D == 2 ? 1 : 0.5;
}

}  // namespace

// Nothing but the inflow moves the fluids: the column grows at its speed, to the round-off of the fluxes.
TEST_IN_2D_AND_3D("liquid that enters fills a channel at the speed of the inflow, and the balance holds") {
    TwoPhase<D> solver(two_phase_scene(channel<D>(inflow<D>("liquid"), list({"0.3", "2.0", "2.0"}, D))));
    const real start = integral(solver, "volume"), all = start + integral(solver, "gas_volume");
    EXPECT_EQ(integral(solver, "poured_volume"), 0);
    while (solver.time() < 0.5) solver.step(solver.advised_dt());
    const real poured = 0.8 * solver.time() * cross_section<D>();
    EXPECT_NEAR(integral(solver, "poured_volume"), poured, 1e-13);
    EXPECT_NEAR(integral(solver, "volume"), start + poured, 1e-13);
    EXPECT_NEAR(integral(solver, "gas_volume"), all - start - poured, 1e-13);
    EXPECT_NEAR(integral(solver, "front_x"), 0.3 + 0.8 * solver.time(), 0.5 * 2.0 / 24);  // half a cell
    EXPECT_NEAR(max_speed(solver), 0.8, 1e-7);
}

// The column leaves through the open side: all of it, and 0.8 m/s times 2.6 s is 0.08 m more than the channel is long. What stays are the
// last cells' dust of 1e-9 each.
TEST_IN_2D_AND_3D("gas that enters drives liquid out through the open side, and the balance holds") {
    TwoPhase<D> solver(two_phase_scene(channel<D>(inflow<D>("gas"), list({"1.3", "2.0", "2.0"}, D))));
    const real start = integral(solver, "volume");
    while (solver.time() < 2.6) {
        solver.step(solver.advised_dt());
        ASSERT_NEAR(integral(solver, "volume") - integral(solver, "poured_volume"), start, 1e-13);
    }
    EXPECT_NEAR(integral(solver, "volume"), 0, 1e-7);
    EXPECT_NEAR(integral(solver, "poured_volume"), -start, 1e-7);
}

// A column collapses, and leaves through the side; the gas comes in above it.
TEST_IN_2D_AND_3D("a dam that runs out through an open side empties the tank, and the balance holds") {
    auto scene = two_phase_scene(
        channel<D>("\"wall\"", list({"0.8", "0.7", "2.0"}, D), "effects = { gravity = { g = " + list({"0.0", "-9.81", "0.0"}, D) + " } }"));
    TwoPhase<D> solver(scene);
    const real start = integral(solver, "volume");
    while (solver.time() < (D == 2 ? 1.5 : 0.8)) {
        solver.step(solver.advised_dt());
        ASSERT_NEAR(integral(solver, "volume") - integral(solver, "poured_volume"), start, 1e-13);
        ASSERT_LT(mac::max_magnitude(solver.fraction(), 0.5), 0.5 + 1e-8);
    }
    EXPECT_LT(integral(solver, "volume"), (D == 2 ? 0.5 : 0.9) * start);
    EXPECT_LT(max_speed(solver), 12) << "gas at the surface moves faster than liquid, sqrt(2 g H) = 3.7 m/s, but not without bound";
}

TEST("a restored run remembers what was poured") {
    const auto scene = two_phase_scene(channel<2>(inflow<2>("liquid"), "[0.3, 2.0]"));
    TwoPhase<2> first(scene), second(scene);
    run(first, 7);
    Checkpoint checkpoint;
    first.save(checkpoint);
    second.restore(checkpoint);
    run(first, 3);
    run(second, 3);
    EXPECT_GT(integral(first, "poured_volume"), 0);
    EXPECT_EQ(integral(second, "poured_volume"), integral(first, "poured_volume"));
}

TEST("an inflow without an open side is refused") {
    const auto scene = two_phase_scene(channel<2>(inflow<2>("liquid"), "[0.3, 2.0]"), {{"sides.x_max", "\"wall\""}});
    try {
        const TwoPhase<2> solver(scene);
        ADD_FAILURE() << "not refused";
    } catch (const BadInput& bad) {
        EXPECT_NE(std::string(bad.what()).find("inflow needs an open side"), std::string::npos) << bad.what();
    }
}

// The column sinks by g t²/2 · (its share), some 5% of its height in 0.15 s, away from the open top that it touches at the start.
TEST_IN_2D_AND_3D("a column that sinks from an open top draws gas after it, or liquid where the scene says that liquid stands outside") {
    const auto scene_of = [](const std::string& top) {
        return two_phase_scene(fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
gas = {{ density = 1.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
sides.y_max = {}
effects.gravity.g = {}
)",
                                           D, list({"16", "16", "8"}, D), list({"1.0", "1.0", "0.5"}, D), list({"0.5", "-1.0", "-1.0"}, D),
                                           list({"2.0", "2.0", "2.0"}, D), top, list({"0.0", "-9.81", "0.0"}, D)));
    };
    const auto change = [&](const std::string& top) {
        TwoPhase<D> solver(scene_of(top));
        const real before = integral(solver, "volume");
        while (solver.time() < 0.15) solver.step(solver.advised_dt());
        EXPECT_NEAR(integral(solver, "volume") - integral(solver, "poured_volume"), before, 1e-14) << top;
        return integral(solver, "volume") / before - 1;
    };
    EXPECT_LT(change("\"outflow\""), 1e-14);
    EXPECT_GT(change("{ kind = \"outflow\", fluid = \"liquid\" }"), 0.01);
}

}  // namespace side_tests
