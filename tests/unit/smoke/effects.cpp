// What effects and emitters do in one step, by their own formulas, cell by cell and face by face.
#include "smoke/effects.hpp"

#include "smoke/emitters.hpp"
#include "support/grid_solvers.hpp"
#include "support/test.hpp"

namespace weir::smoke::effects_tests {

namespace {

template <int D>
real some_value(const Index<D>& I, real phase) {
    real angle = phase;
    for (int a = 0; a < D; ++a) angle += (2 + a) * I[a];
    return 2 + std::sin(angle);
}

}  // namespace

TEST_IN_2D_AND_3D("buoyancy pushes every inner face along y by the mean of its two cells: warmth upwards, smoke downwards") {
    const auto scene = test::mac_scene(test::unit_box(D, 7, "effects = { buoyancy = { alpha = 0.3, beta = 0.7, ambient = 1.5 } }\n"));
    auto effects = make_effects<D>(effect_kinds(), scene, all_stages);
    MacState<D> state(scene, effects.plan());
    auto &T = state["temperature"], &smoke = state["smoke"];
    for_each_cell(state.extent(), [&](const Index<D>& I) { T(I) = some_value<D>(I, 0), smoke(I) = some_value<D>(I, 1); });
    Passes passes;
    effects.apply(Stage::force, state, 0.1, passes);
    for (int a = 0; a < D; ++a)
        for_each_inner_face(state.u, a, [&](const Index<D>& I) {
            const Index<D> below = I - e<D>(a);
            const real push = 0.7 * (0.5 * (T(below) + T(I)) - 1.5) - 0.3 * 0.5 * (smoke(below) + smoke(I));
            ASSERT_NEAR(state.u[a](I), a == 1 ? 0.1 * push : 0, 1e-15) << a;  // round-off of sums of some units
        });
}

TEST_IN_2D_AND_3D("along paths cooling and decay leave exp(-rate dt) of what fields are above their surroundings") {
    const auto scene = test::mac_scene(test::unit_box(
        D, 7,
        "effects = { cooling = { rate = 0.7, ambient = 1.2 }, decay = { rate = 0.4 } }\nscheme = { advection = \"semi_lagrangian\" }\n"));
    auto effects = make_effects<D>(effect_kinds(), scene, all_stages);
    MacState<D> state(scene, effects.plan());
    auto &T = state["temperature"], &smoke = state["smoke"];
    for_each_cell(state.extent(), [&](const Index<D>& I) { T(I) = some_value<D>(I, 0), smoke(I) = some_value<D>(I, 1); });
    Passes passes;
    effects.apply(Stage::carried, state, 0.5, passes);
    for_each_cell(state.extent(), [&](const Index<D>& I) {
        ASSERT_NEAR(T(I), 1.2 + std::exp(-0.35) * (some_value<D>(I, 0) - 1.2), 1e-15);
        ASSERT_NEAR(smoke(I), std::exp(-0.2) * some_value<D>(I, 1), 1e-15);
    });
}

TEST("an effect whose stage a solver does not run is refused by name when it is registered") {
    struct Late : MacEffect<2> {
        Stage stage() const override { return Stage::finish; }
        void apply(MacState<2>&, real) override {}
    };
    Effects<MacState<2>> effects("mac_water", {Stage::source, Stage::force});
    try {
        effects.add("drag", std::make_unique<Late>());
        ADD_FAILURE() << "it would never act";
    } catch (const std::logic_error& wrong) {
        EXPECT_STREQ(wrong.what(),
                     "effect \"drag\" acts at stage \"finish\", which solver \"mac_water\" does not run; its stages: source, force");
    }
    EXPECT_TRUE(effects.plans().empty());
}

TEST_IN_2D_AND_3D("an emitter gives the faces inside it its velocity along their own axis, and no others") {
    const auto scene =
        test::mac_scene(test::unit_box(D, 8,
                                       "emitters = [ { shape = \"sphere\", centre = " + test::list(D, "0.5") +
                                           ", radius = 0.2, velocity = " + (D == 2 ? "[0.1, 0.2]" : "[0.1, 0.2, 0.3]") + " } ]\n"));
    FieldPlan plan;
    MacState<D> state(scene, Emitters<D>::needs(scene, plan));
    Emitters<D>(scene, state).apply(state, 0.1);
    const Vec<3> velocity{{0.1, 0.2, 0.3}};
    for (int a = 0; a < D; ++a)
        for_each_inner_face(state.u, a, [&](const Index<D>& I) {
            const bool inside = norm(state.u.face_centre(a, I) - Vec<D>::constant(0.5)) < 0.2;
            ASSERT_EQ(state.u[a](I), inside ? velocity[a] : 0) << a;
        });
}

TEST_IN_2D_AND_3D("explicit friction is advised its limit of a fluid at rest: 1 over 2 nu times the sum of 1/h^2") {
    const FlowSolver<D> flow(test::mac_scene(test::unit_box(
        D, 8, "fluid.viscosity = 0.5\neffects = { viscosity = { scheme = \"explicit\" } }\nscheme = { advection = \"conservative\" }\n")));
    EXPECT_NEAR(flow.advised_dt(), 1 / (2 * 0.5 * D * 64), 1e-15);
}

}  // namespace weir::smoke::effects_tests
