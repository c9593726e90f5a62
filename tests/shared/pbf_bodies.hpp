// What is true of PBF on every backend.
#pragma once
#include "shared/pbf_on_backend.hpp"

TEST_IN_2D_AND_3D("one step agrees with the double reference to 1e-5 of the support, with every kernel") {
    NEEDS_BACKEND;
    for (const char* kernel : {"muller", "cubic", "wendland"})
        for (const bool warm : {false, true}) {  // the paper's iteration with its artificial pressure; the one that keeps its multipliers
            const std::string scheme =
                fmt::format("iterations = 4, kernel = \"{}\", warm_start = {}, settle = 0", kernel, warm ? 0.8 : 0.0);
            auto solver = on_backend<D>(test::box<D>(1, 1, 1), scheme, warm ? "" : "effects.artificial_pressure = { k = 0.01 }");
            test::disturb(solver->fluid());
            const Fluid<D> before = solver->fluid();
            const test::Expected<D> expected(solver->options(), before, 0.008);
            const real h = test::support<D>(*solver);
            // a mass counted twice once made every lambda zero, and all variants agreed: so the thing tested must be there
            ASSERT_GT(expected.largest_lambda, 1e-4 * h * h);
            ASSERT_GT(expected.largest_move, 1e-2 * h);
            solver->step(0.008);
            // coordinates of up to 6 h in single precision are rounded to 4e-7 h; four iterations, each with a sum of tens of terms
            EXPECT_LE(expected.farthest(solver->fluid()), 1e-5 * h) << kernel << " " << warm;
        }
}

TEST_IN_2D_AND_3D("ten steps from the settled state end within 1e-4 of the support of where SSE2 ends, particle by particle") {
    NEEDS_BACKEND;
    auto here = on_backend<D>(test::box<D>(0.5, 1, 1));
    const auto there = test::on_sse2<D>(test::box<D>(0.5, 1, 1));
    for (int s = 0; s < 10; ++s) {
        const real dt = s == 5 ? 0.003 : 0.008;  // one is cut short, as to meet a frame
        const StepReport a = here->step(dt), b = there->step(dt);
        EXPECT_EQ(a.iterations, b.iterations);
        EXPECT_NEAR(a.density_error, b.density_error, 1e-5);  // a mean of numbers known to some 1e-6
        EXPECT_NEAR(a.cfl, b.cfl, 1e-3);
    }
    const auto& x = here->fluid();
    EXPECT_EQ(x.id, there->fluid().id);
    // each step's rounding, 1e-6 h, stays as speed: after n steps n (n + 1) / 2 times that
    EXPECT_LE(test::farthest_apart(x, there->fluid()), 1e-4 * test::support<D>(*here));
    EXPECT_EQ(test::integral(*here, "outside"), 0);
}

TEST_IN_2D_AND_3D("each effect does something, and five steps with it end within 1e-4 of the support of where SSE2 ends") {
    NEEDS_BACKEND;
    const auto run = [](auto& solver) {
        test::disturb(solver.fluid());
        for (int s = 0; s < 5; ++s) solver.step(0.004);
        return Fluid<D>(solver.fluid());
    };
    const std::string liquid = test::box<D>(0.75, 0.75, 0.75), scheme = "settle = 0";
    auto without = on_backend<D>(liquid, scheme);
    const Fluid<D> plain = run(*without);
    for (const std::string& effect : test::effects<D>()) {
        auto here = on_backend<D>(liquid, scheme, effect);
        auto there = test::on_sse2<D>(liquid, scheme, effect);
        EXPECT_EQ(test::built(*here), test::built(*there));
        EXPECT_GT(test::built(*here).size(), 1u);  // gravity, and it
        const real h = test::support<D>(*here);
        const Fluid<D> a = run(*here), b = run(*there);
        EXPECT_GT(test::farthest_apart(a, plain), 1e-3 * h) << effect;
        EXPECT_LE(test::farthest_apart(a, b), 1e-4 * h) << effect;  // 15 times 1e-6 h, and what vorticity's direction makes of it
    }
}

TEST_IN_2D_AND_3D("a run repeats to the last bit, through a change of order and a restart") {
    NEEDS_BACKEND;
    const std::string more = "effects.xsph = {}\neffects.vorticity = { epsilon = 0.1 }";
    const auto solver = [&] { return on_backend<D>(test::box<D>(0.5, 1, 1), "", more); };
    auto through = solver(), again = solver(), first = solver(), second = solver();
    for (int s = 0; s < 20; ++s) through->step(0.008), again->step(0.008);
    for (int s = 0; s < 13; ++s) first->step(0.008);
    Checkpoint saved;
    first->save(saved);
    second->restore(saved);
    for (int s = 13; s < 20; ++s) second->step(0.008);
    EXPECT_NE(through->fluid().id.front(), through->fluid().id.back());
    for (auto* other : {again.get(), second.get()}) {
        EXPECT_EQ(through->fluid().x, other->fluid().x);
        EXPECT_EQ(through->fluid().v, other->fluid().v);
        EXPECT_EQ(through->fluid().id, other->fluid().id);
    }
}

TEST_IN_2D_AND_3D("with a tolerance the iterations end when the mean compression is below it, and not before") {
    NEEDS_BACKEND;
    const std::string scheme = "tolerance = 2e-3, max_iterations = 200, settle = 0";
    auto here = on_backend<D>(test::box<D>(1, 1, 1), scheme);
    auto there = test::on_sse2<D>(test::box<D>(1, 1, 1), scheme);
    test::disturb(here->fluid()), test::disturb(there->fluid());
    const int iterations = here->step(0.008).iterations;
    EXPECT_GT(iterations, 1);
    EXPECT_LT(iterations, 200);
    EXPECT_NEAR(iterations, there->step(0.008).iterations, 1);  // a mean that meets the tolerance to rounding
}

TEST_IN_2D_AND_3D("in free fall all that changes momentum is gravity") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>(test::box<D>(0.5, 0.5, 0.5), "settle = 0");
    auto& fluid = solver->fluid();
    test::disturb(fluid);
    for (int i = 0; i < fluid.count(); ++i)  // farther than the support from all walls, and too dense, so that all push
        Fluid<D>::put(fluid.x, i, Vec<D>::constant(0.28) + 0.88 * fluid.position(i));
    const auto momentum = [&](int a) {
        real sum = 0;
        for (int i = 0; i < solver->fluid().count(); ++i) sum += solver->fluid().velocity(i)[a];
        return sum;
    };
    std::array<real, D> before{};
    for (int a = 0; a < D; ++a) before[static_cast<std::size_t>(a)] = momentum(a);
    const StepReport report = solver->step(0.002);
    EXPECT_GT(report.max_density_error, 1e-3);
    const int n = solver->fluid().count();
    for (int a = 0; a < D;
         ++a)  // a position is rounded to 6e-8 m in each of five passes, over 0.002 s: 3e-5 m/s a particle, of either sign
        EXPECT_NEAR(momentum(a), before[static_cast<std::size_t>(a)] - (a == 1 ? 9.81 * 0.002 * n : 0), 3e-4 * std::sqrt(n));
}

TEST_IN_2D_AND_3D("every particle in one cell: the list grows, nothing leaves") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>(test::box<D>(1, 1, 1), "settle = 0");
    auto& fluid = solver->fluid();
    for (int i = 0; i < fluid.count(); ++i)
        Fluid<D>::put(fluid.x, i, Vec<D>::constant(0.5) + 0.1 * (fluid.position(i) - Vec<D>::constant(0.5)));
    const int n = fluid.count();
    for (int s = 0; s < 10; ++s) {
        solver->step(0.008);
        if (s == 0) {
            EXPECT_GT(test::integral(*solver, "max_neighbours"), n / 2);
        }
        ASSERT_EQ(test::integral(*solver, "outside"), 0) << "step " << s;
    }
}

TEST_IN_2D_AND_3D("a single particle falls like one and ends on the floor") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>(test::box<D>(0.125, 0.125, 0.125));
    ASSERT_EQ(solver->fluid().count(), 1);
    Fluid<D>::put(solver->fluid().x, 0, Vec<D>::constant(0.8));
    for (int s = 0; s < 10; ++s) solver->step(0.008);
    // symplectic Euler: g dt^2 n (n + 1) / 2
    EXPECT_NEAR(solver->fluid().position(0)[1], 0.8 - 9.81 * 0.008 * 0.008 * 55, 1e-6);
    for (int s = 0; s < 100; ++s) solver->step(0.008);
    EXPECT_NEAR(solver->fluid().position(0)[1], solver->fluid().domain.margin, 1e-6);
}

TEST_IN_2D_AND_3D("what walls put back is counted, with how far; what never meets one is not") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>(test::box<D>(0.125, 0.125, 0.125), "settle = 0");
    auto& fluid = solver->fluid();
    ASSERT_EQ(fluid.count(), 1);
    const real dt = 0.008, spacing = fluid.domain.spacing, margin = fluid.domain.margin;
    Fluid<D>::put(fluid.x, 0, Vec<D>::constant(0.5));
    solver->step(dt);
    EXPECT_EQ(test::integral(*solver, "clamped"), 0);
    EXPECT_EQ(test::integral(*solver, "clamp_depth"), 0);
    auto& again = solver->fluid();
    Fluid<D>::put(again.x, 0, 0.1 * Vec<D>::unit(1) + 0.5 * (Vec<D>::constant(1) - Vec<D>::unit(1)));
    Fluid<D>::put(again.v, 0, -20 * Vec<D>::unit(1));
    solver->step(dt);
    EXPECT_EQ(test::integral(*solver, "clamped"), 1);
    // The prediction ends below the floor by this much; a particle alone is not corrected any further.
    const real below = dt * (20 + 9.81 * dt) - (0.1 - margin);
    EXPECT_NEAR(test::integral(*solver, "clamp_depth"), below / spacing, 1e-6);  // the device keeps it in single precision
}

TEST_IN_2D_AND_3D("a block at rest meets no wall; one thrown at a corner is put back as often and as far as SSE2 says") {
    NEEDS_BACKEND;
    auto still = on_backend<D>(test::box<D>(1, 0.5, 1));
    for (int s = 0; s < 20; ++s) still->step(0.004);
    EXPECT_EQ(test::integral(*still, "clamped"), 0) << "half a spacing is left to every wall";
    const auto thrown = [](auto& solver) {
        auto& fluid = solver.fluid();
        for (int i = 0; i < fluid.count(); ++i) Fluid<D>::put(fluid.v, i, Vec<D>::constant(-10));
        for (int s = 0; s < 3; ++s) solver.step(0.008);
    };
    const std::string liquid = test::box<D>(0.5, 0.5, 0.5), scheme = "settle = 0";
    auto here = on_backend<D>(liquid, scheme);
    auto there = test::on_sse2<D>(liquid, scheme);
    thrown(*here), thrown(*there);
    const real count = test::integral(*there, "clamped"), depth = test::integral(*there, "clamp_depth");
    EXPECT_GT(count, here->fluid().count() / 4);
    EXPECT_NEAR(test::integral(*here, "clamped"), count, 0.02 * count) << "one that only touches the wall may fall on either side";
    EXPECT_NEAR(test::integral(*here, "clamp_depth"), depth, 1e-3 * depth);
}

TEST_IN_2D_AND_3D("a tank that has run empty steps and reports nothing; one that is empty from the start is refused") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>(test::box<D>(0.5, 0.5, 0.5));
    solver->fluid().remove_if([](int) { return true; });
    ASSERT_EQ(solver->fluid().count(), 0);
    EXPECT_EQ(solver->step(0.008).density_error, 0);
    EXPECT_GT(solver->advised_dt(), 0);
    // between the lattice's places
    const std::string speck =
        fmt::format("{{ shape = \"sphere\", centre = {}, radius = 0.01 }}", D == 2 ? "[0.5, 0.5]" : "[0.5, 0.5, 0.5]");
    EXPECT_THROW(on_backend<D>(speck), BadInput);
}

TEST_IN_2D_AND_3D("a particle that is not a number is caught in the step it appears, by name") {
    NEEDS_BACKEND;
    for (const bool position : {true, false}) {
        auto solver = on_backend<D>(test::box<D>(0.5, 0.5, 0.5));
        solver->step(0.008);
        (position ? solver->fluid().x : solver->fluid().v)[0][3] = std::nan("");
        EXPECT_THROW(solver->step(0.008), NumericalFailure);
    }
}
