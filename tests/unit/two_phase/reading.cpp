// What a scene of two phases may not contain, and what the step is bounded by.
#include "support.hpp"

#include "core/error.hpp"

namespace reading_tests {

using namespace weir;
using namespace weir::test;
using two_phase::TwoPhase;

namespace {

std::string refusal(const std::string& text, const std::vector<scene::Override>& changes = {}) {
    try {
        TwoPhase<2> solver(two_phase_scene(text, changes));
    } catch (const BadInput& bad) {
        return bad.what();
    }
    return "";
}

}  // namespace

TEST("what is not supported is refused by name") {
    const auto has = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
    };
    const std::string text = collapse<2>();
    has(refusal(text, {{"sides.x_min", "{ kind = \"inflow\", velocity = [1.0, 0.0] }"}}), "inflow");
    const std::string ball = "{ shape = \"sphere\", centre = [0.5, 0.5], radius = 0.1";
    has(refusal(text, {{"solids", "[ " + ball + " } ]"}}), "surface_tension");
    has(refusal(text, {{"emitters", "[ { shape = \"sphere\", centre = [0.5, 0.5], radius = 0.1 } ]"}}), "emitters");
    has(refusal(text, {{"bodies", "[ { shape = \"sphere\", centre = [0.5, 0.5], radius = 0.1, density = 500.0 } ]"}}), "surface_tension");
    has(refusal(text, {{"effects.volume_control", "{}"}}), "volume_control");
    has(refusal(text, {{"time.cfl", "0.6"}}), "cfl");
    has(refusal(text, {{"liquid", "[]"}}), "liquid");
    EXPECT_EQ(refusal(text), "");
}

TEST("the step is bounded by the fastest fluid, the tension or the gravity, and the run counts which") {
    const auto counts = [](const std::vector<scene::Override>& changes) {
        TwoPhase<2> solver(two_phase_scene(collapse<2>(), changes));
        solver.step(solver.advised_dt());
        return std::array{integral(solver, "steps_bound_by_speed"), integral(solver, "steps_bound_by_tension"),
                          integral(solver, "steps_bound_by_gravity")};
    };
    const real h = 1.0 / 16;
    const scene::Override slack{"effects.surface_tension.sigma", "0.1"};
    EXPECT_EQ(counts({slack}), (std::array<real, 3>{0, 0, 1}));
    EXPECT_EQ(counts({}), (std::array<real, 3>{0, 1, 0}));
    EXPECT_EQ(counts({{"initial.liquid_velocity", "[0.0, 100.0]"}}), (std::array<real, 3>{1, 0, 0}));
    TwoPhase<2> solver(two_phase_scene(collapse<2>(), {slack}));
    EXPECT_NEAR(solver.advised_dt(), 0.5 * std::sqrt(h / 9.81), 1e-15);
    EXPECT_NEAR(solver.stable_dt().dt, std::sqrt(h / 9.81), 1e-15);
    // Brackbill, Kothe & Zemach 1992, eq. 61: (<rho> h^3 / (2 pi sigma))^(1/2) with the mean density, and half of it
    const real mean = 0.5 * (1000 + 1);
    EXPECT_NEAR(TwoPhase<2>(two_phase_scene(collapse<2>())).advised_dt(), 0.5 * std::sqrt(mean * h * h * h / (2 * pi * 10)), 1e-15);
}

}  // namespace reading_tests
