// What is true of SPH on every backend.
#pragma once
#include "shared/sph_on_backend.hpp"

TEST_IN_2D_AND_3D("one step agrees with the double reference to 1e-5 of the support, with every kernel and every term") {
    NEEDS_BACKEND;
    const real dt = 0.002;
    for (const char* kernel : {"muller", "cubic", "wendland"})
        for (const Physics& physics : test::all_physics<D>()) {
            auto solver = on_backend<D>(fmt::format("kernel = \"{}\", {}", kernel, physics.scheme), physics.effects);
            test::shake(solver->fluid(), 0.2);
            const Fluid<D> before = solver->fluid();
            const Fluid<D> expected = test::reference_step<D>(solver->options(), before, dt);
            solver->step(dt);
            const test::Difference worst(solver->fluid(), expected);
            EXPECT_GT(test::farthest_moved(before, expected, dt), 1e-4 * test::h);  // forces must be there to be compared
            // single precision's 6e-8 in each of some thirty terms of a sum that moves particles by up to 0.1 h
            EXPECT_LE(worst.place, 1e-5 * test::h) << kernel << " " << physics.effects;
            EXPECT_LE(worst.density, 1e-4 * before.rho0) << kernel << " " << physics.effects;
        }
}

TEST_IN_2D_AND_3D("ten steps with each term of the physics end within 1e-4 of the support of where SSE2 ends") {
    NEEDS_BACKEND;
    for (const Physics& physics : test::all_physics<D>()) {
        auto here = on_backend<D>(physics.scheme, physics.effects);
        auto there = test::on_sse2<D>(physics.scheme, physics.effects);
        EXPECT_EQ(test::built(*here), test::built(*there));
        test::shake(here->fluid(), 0.1), test::shake(there->fluid(), 0.1);
        for (int s = 0; s < 10; ++s) {
            const StepReport a = here->step(0.001), b = there->step(0.001);
            EXPECT_NEAR(a.density_error, b.density_error, 1e-5);  // a mean of numbers known to some 1e-6
            EXPECT_NEAR(a.cfl, b.cfl, 1e-4);
            EXPECT_NEAR(here->advised_dt(), there->advised_dt(), 1e-4 * there->advised_dt());
        }
        const auto& x = here->fluid();
        EXPECT_EQ(x.id, there->fluid().id);
        EXPECT_LE(test::farthest_apart(x, there->fluid()), 1e-4 * test::h)
            << physics.effects;  // 55 times the rounding of one step, of 1e-6 h
        EXPECT_EQ(test::integral(*here, "outside"), 0);
    }
}

TEST_IN_2D_AND_3D("each effect does something, and five steps with it end within 1e-4 of the support of where SSE2 ends") {
    NEEDS_BACKEND;
    const auto run = [](auto& solver) {
        test::shake(solver.fluid(), 0.1);
        for (int s = 0; s < 5; ++s) solver.step(0.002);
        return Fluid<D>(solver.fluid());
    };
    const Fluid<D> plain = run(*on_backend<D>("density = \"summation\""));
    for (const Physics& physics : test::named_effects<D>()) {
        const Fluid<D> a = run(*on_backend<D>(physics.scheme, physics.effects));
        const Fluid<D> b = run(*test::on_sse2<D>(physics.scheme, physics.effects));
        EXPECT_GT(test::farthest_apart(a, plain), 1e-4 * test::h) << physics.scheme << physics.effects;
        EXPECT_LE(test::farthest_apart(a, b), 1e-4 * test::h) << physics.scheme << physics.effects;
    }
}

TEST_IN_2D_AND_3D("a run repeats to the last bit, through a change of order and a restart") {
    NEEDS_BACKEND;
    const auto solver = [] { return on_backend<D>("density = \"continuity\"", "effects.xsph = {}\neffects.density_diffusion = {}"); };
    auto through = solver(), again = solver(), first = solver(), second = solver();
    for (auto* s : {through.get(), again.get(), first.get()}) test::shake(s->fluid(), 0.2);
    for (int s = 0; s < 20; ++s) through->step(0.002), again->step(0.002);
    for (int s = 0; s < 13; ++s) first->step(0.002);
    Checkpoint saved;
    first->save(saved);
    second->restore(saved);
    for (int s = 13; s < 20; ++s) second->step(0.002);
    for (auto* other : {again.get(), second.get()}) {
        EXPECT_EQ(through->fluid().x, other->fluid().x);
        EXPECT_EQ(through->fluid().v, other->fluid().v);
        EXPECT_EQ(through->fluid().density, other->fluid().density);
        EXPECT_EQ(through->advised_dt(), other->advised_dt());
    }
}

TEST_IN_2D_AND_3D("a free drop keeps its momentum to round-off, whatever its particles do to each other") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>("density = \"summation\", tension = true", "effects.viscosity = {}\neffects.artificial_viscosity = {}");
    test::shake(solver->fluid(), 0.1);
    for (int i = 0; i < solver->fluid().count(); ++i)  // away from the walls
        for (int a = 0; a < D; ++a) {
            auto& xa = solver->fluid().x[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)];
            xa = (a == 1 ? 0.75 : 0.5) + 0.6 * (xa - 0.6);
        }
    const auto momentum = [&](int axis) {
        const auto& fluid = solver->fluid();
        real sum = 0, size = 0;
        for (int i = 0; i < fluid.count(); ++i) sum += fluid.velocity(i)[axis], size += std::abs(fluid.velocity(i)[axis]);
        return std::pair{sum, size};
    };
    std::array<real, D> before{};
    for (int a = 0; a < D; ++a) before[static_cast<std::size_t>(a)] = momentum(a).first;
    for (int s = 0; s < 5; ++s) solver->step(0.0005);
    for (int a = 0; a < D; ++a)  // every pair's two forces are rounded apart, each to 6e-8 of itself
        EXPECT_NEAR(momentum(a).first, before[static_cast<std::size_t>(a)], 1e-5 * momentum(a).second);
}

TEST_IN_2D_AND_3D("every particle in one cell: the list grows, nothing leaves; a particle that is not a number is caught") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>("density = \"summation\"");
    auto& fluid = solver->fluid();
    for (int i = 0; i < fluid.count(); ++i)
        Fluid<D>::put(fluid.x, i, Vec<D>::constant(0.5) + 0.05 * (fluid.position(i) - Vec<D>::constant(0.5)));
    const int n = fluid.count();
    solver->step(1e-5);
    EXPECT_EQ(test::integral(*solver, "max_neighbours"), n - 1);
    for (int s = 0; s < 5; ++s) solver->step(1e-5);
    EXPECT_EQ(test::integral(*solver, "outside"), 0);
    solver->fluid().v[0][3] = std::nan("");
    EXPECT_THROW(solver->step(1e-5), NumericalFailure);
}

TEST_IN_2D_AND_3D("what walls put back is counted, with how far; what never meets one is not") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>("density = \"summation\"", "");
    auto& fluid = solver->fluid();
    fluid.remove_if([](int i) { return i > 0; });
    const real dt = 0.002, spacing = fluid.domain.spacing, margin = fluid.domain.margin;
    Fluid<D>::put(fluid.x, 0, Vec<D>::constant(0.5));
    solver->step(dt);
    EXPECT_EQ(test::integral(*solver, "clamped"), 0);
    EXPECT_EQ(test::integral(*solver, "clamp_depth"), 0);
    auto& again = solver->fluid();
    const real above = 0.9 * spacing;  // the whole kernel less what the wall holds of it: no density that would push
    Fluid<D>::put(again.x, 0, above * Vec<D>::unit(1) + 0.5 * (Vec<D>::constant(1) - Vec<D>::unit(1)));
    Fluid<D>::put(again.v, 0, -100 * Vec<D>::unit(1));
    solver->step(dt);
    EXPECT_EQ(test::integral(*solver, "clamped"), 1);
    EXPECT_NEAR(test::integral(*solver, "clamp_depth"), (100 * dt - (above - margin)) / spacing, 1e-2);  // gravity and the wall's push
    Checkpoint saved;
    solver->save(saved);
    auto other = on_backend<D>("density = \"summation\"", "");
    other->restore(saved);
    EXPECT_EQ(test::integral(*other, "clamped"), 1);
}

TEST_IN_2D_AND_3D("no particle, and one: steps that report nothing, a fall like a stone's") {
    NEEDS_BACKEND;
    const std::string gravity = D == 2 ? "effects.gravity = { g = [0, -9.81] }" : "effects.gravity = { g = [0, -9.81, 0] }";
    auto solver = on_backend<D>("density = \"summation\"", gravity);
    auto& fluid = solver->fluid();
    fluid.remove_if([](int i) { return i > 0; });
    Fluid<D>::put(fluid.x, 0, Vec<D>::constant(0.5) + Vec<D>::constant(0.2));
    for (int s = 0; s < 10; ++s) solver->step(0.002);
    // symplectic Euler: g dt^2 n (n + 1) / 2
    EXPECT_NEAR(solver->fluid().position(0)[1], 0.7 - 9.81 * 0.002 * 0.002 * 55, 1e-9);
    solver->fluid().remove_if([](int) { return true; });
    EXPECT_EQ(solver->step(0.002).density_error, 0);
    EXPECT_EQ(solver->fields().find("position")->data[0].size(), 0u);
}
