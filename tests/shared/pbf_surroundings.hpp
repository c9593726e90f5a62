// What is true of PBF on every backend between sides that repeat or are open, and round solids.
#pragma once
#include "shared/pbf_on_backend.hpp"

TEST_IN_2D_AND_3D("one step across sides that repeat, and round solids, agrees with the double reference to 1e-5 of the support") {
    NEEDS_BACKEND;
    for (const std::string& place : {test::periodic_sides<D>(), test::solids_at_rest<D>(), test::moving_solids<D>()}) {
        auto solver = on_backend<D>(test::box<D>(1, 1, 1), "settle = 0", place);
        test::disturb(solver->fluid());
        const Fluid<D> before = solver->fluid();
        const test::Expected<D> expected(solver->options(), before, 0.008);
        const real h = test::support<D>(*solver);
        ASSERT_GT(expected.largest_move, 1e-2 * h);
        solver->step(0.008);
        const Fluid<D>& after = solver->fluid();
        EXPECT_LE(expected.farthest(after), 1e-5 * h) << place;  // rounding as in a closed box
        for (int i = 0; i < before.count(); ++i)
            ASSERT_FALSE(after.domain.left(after.position(i)) || after.domain.outside(after.position(i)));
    }
}

TEST_IN_2D_AND_3D(
    "in all surroundings ten steps end within 1e-4 of the support of where SSE2 ends, with the same particles in the same order") {
    NEEDS_BACKEND;
    for (const std::string& place : test::surroundings<D>()) {
        auto here = on_backend<D>(test::box<D>(1, 1, 1), "", place);
        const auto there = test::on_sse2<D>(test::box<D>(1, 1, 1), "", place);
        for (int s = 0; s < 10; ++s) {
            const StepReport a = here->step(0.008), b = there->step(0.008);
            EXPECT_NEAR(a.density_error, b.density_error, 1e-5) << place;
            EXPECT_NEAR(a.cfl, b.cfl, 1e-3) << place;
        }
        ASSERT_EQ(here->fluid().id, there->fluid().id) << place;
        EXPECT_LE(test::farthest_apart<D>(here->fluid(), there->fluid()), 1e-4 * test::support<D>(*here)) << place;  // 55 times 1e-6 h
        EXPECT_EQ(test::integral(*here, "outside"), 0) << place;
    }
}

TEST_IN_2D_AND_3D("in all surroundings a run repeats to the last bit, through a change of order and a restart") {
    NEEDS_BACKEND;
    for (const std::string& place : test::surroundings<D>()) {
        const auto solver = [&] { return on_backend<D>(test::box<D>(1, 0.5, 1), "settle = 0", place); };
        auto through = solver(), again = solver(), first = solver(), second = solver();
        for (int s = 0; s < 20; ++s) through->step(0.008), again->step(0.008);
        for (int s = 0; s < 13; ++s) first->step(0.008);
        Checkpoint saved;
        first->save(saved);
        second->restore(saved);
        for (int s = 13; s < 20; ++s) second->step(0.008);
        for (auto* other : {again.get(), second.get()}) {
            EXPECT_EQ(through->fluid().x, other->fluid().x) << place;
            EXPECT_EQ(through->fluid().v, other->fluid().v) << place;
            EXPECT_EQ(through->fluid().id, other->fluid().id) << place;
        }
    }
}

TEST_IN_2D_AND_3D("along sides that repeat momentum stays; through an open one particles leave, and mass with them") {
    NEEDS_BACKEND;
    auto round = on_backend<D>(test::box<D>(1, 1, 1), "", test::periodic_sides<D>());
    const real before = test::integral(*round, "momentum_x"), mass = test::integral(*round, "mass");
    for (int s = 0; s < 10; ++s) round->step(0.008);
    // forces of pairs are rounded apart: 6e-8 m a particle and pass over 0.008 s, of either sign
    const int n = round->fluid().count();
    EXPECT_NEAR(test::integral(*round, "momentum_x"), before, mass / n * 10 * 1e-4 * std::sqrt(n));
    EXPECT_EQ(test::integral(*round, "mass"), mass);

    auto out = on_backend<D>(test::box<D>(1, 1, 1), "", test::open_sides<D>());
    const int at_first = out->fluid().count();
    for (int s = 0; s < 10; ++s) out->step(0.008);
    const int left = out->fluid().count();
    EXPECT_LT(left, at_first);
    EXPECT_EQ(test::integral(*out, "particles"), left);
    EXPECT_EQ(out->fields().find("position")->data[0].size(), static_cast<std::size_t>(left));
    for (int s = 0; s < 200; ++s) out->step(0.008);
    for (int i = 0; i < out->fluid().count(); ++i) ASSERT_LE(out->fluid().position(i)[0], 1);
}

TEST_IN_2D_AND_3D("a jet lets in density times area times speed, and what reaches a drain is gone") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>(test::box<D>(1, 1, 1), "", test::jet_and_drain<D>());
    const int at_first = solver->fluid().count();
    for (int s = 0; s < 10; ++s) solver->step(0.008);
    const auto& fluid = solver->fluid();
    // two rows, of four in 3D; one spacing of 1/8 m each 1/64 s, the first at once
    EXPECT_EQ(fluid.next_id, at_first + (D == 2 ? 2 : 8) * 6);
    EXPECT_LT(fluid.count(), fluid.next_id);  // the drain was full of liquid
    EXPECT_GT(fluid.count(), at_first / 2);
    EXPECT_EQ(test::integral(*solver, "mass"), fluid.count() * fluid.mass);
}
