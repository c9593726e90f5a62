// What is true of SPH on every backend between sides that repeat or are open, and round solids.
#pragma once
#include "shared/sph_on_backend.hpp"

namespace weir::test {
namespace {

/// Gravity and viscosity, with which walls and solids pull and drag.
template <int D>
std::string heavy_and_viscous() {
    return "effects.gravity = { g = " + list<D>(0, -9.81, 0) + " }\neffects.viscosity = {}\n";
}
const std::string stuck = ", slip = \"no\"";
const std::string summed = "density = \"summation\"", by_rate = "density = \"delta\"";
/// All surroundings of a liquid whose density follows its rate; and solids in one whose density is summed: (scheme, place).
template <int D>
std::vector<std::pair<std::string, std::string>> surrounded() {
    std::vector<std::pair<std::string, std::string>> all{{summed, solids_at_rest<D>(stuck)}};
    for (const std::string& place : surroundings<D>(stuck)) all.emplace_back(by_rate, place);
    return all;
}

}  // namespace
}  // namespace weir::test

TEST_IN_2D_AND_3D("in all surroundings that let nothing in one step agrees with the double reference to 1e-5 of the support") {
    NEEDS_BACKEND;
    const real dt = 0.002;
    for (const auto& [density, place] : test::surrounded<D>()) {
        if (place == test::jet_and_drain<D>()) continue;
        auto solver = on_backend<D>(density, test::heavy_and_viscous<D>() + place);
        test::shake(solver->fluid(), 0.2);
        const Fluid<D> before = solver->fluid();
        const Fluid<D> expected = test::reference_step<D>(solver->options(), before, dt);
        solver->step(dt);
        const Fluid<D>& after = solver->fluid();
        ASSERT_EQ(after.count(), before.count());
        const auto& domain = after.domain;
        const test::Difference worst(after, expected);
        EXPECT_LE(worst.place, 1e-5 * test::h) << density << place;  // rounding as in a closed box
        EXPECT_LE(worst.density, 1e-4 * before.rho0) << density << place;
        for (int i = 0; i < before.count(); ++i) ASSERT_FALSE(domain.left(after.position(i)) || domain.outside(after.position(i)));
    }
}

TEST_IN_2D_AND_3D(
    "in all surroundings ten steps end within 1e-4 of the support of where SSE2 ends, with the same particles in the same order") {
    NEEDS_BACKEND;
    for (const auto& [density, place] : test::surrounded<D>()) {
        auto here = on_backend<D>(density, test::heavy_and_viscous<D>() + place);
        auto there = test::on_sse2<D>(density, test::heavy_and_viscous<D>() + place);
        test::shake(here->fluid(), 0.1), test::shake(there->fluid(), 0.1);
        for (int s = 0; s < 10; ++s) {
            const StepReport a = here->step(0.002), b = there->step(0.002);
            EXPECT_NEAR(a.density_error, b.density_error, 1e-5) << place;
            EXPECT_NEAR(a.cfl, b.cfl, 1e-3) << place;
            EXPECT_NEAR(here->advised_dt(), there->advised_dt(), 1e-4 * there->advised_dt()) << place;
        }
        ASSERT_EQ(here->fluid().id, there->fluid().id) << place;
        EXPECT_LE(test::farthest_apart<D>(here->fluid(), there->fluid()), 1e-4 * test::h) << place;  // 55 times the rounding of one step
        EXPECT_EQ(test::integral(*here, "outside"), 0) << place;
    }
}

TEST_IN_2D_AND_3D("in all surroundings a run repeats to the last bit, through a change of order and a restart") {
    NEEDS_BACKEND;
    for (const std::string& place : test::surroundings<D>(test::stuck)) {
        const auto solver = [&] { return on_backend<D>(test::by_rate, test::heavy_and_viscous<D>() + place); };
        auto through = solver(), again = solver(), first = solver(), second = solver();
        for (int s = 0; s < 20; ++s) through->step(0.004), again->step(0.004);
        for (int s = 0; s < 13; ++s) first->step(0.004);
        Checkpoint saved;
        first->save(saved);
        second->restore(saved);
        for (int s = 13; s < 20; ++s) second->step(0.004);
        for (auto* other : {again.get(), second.get()}) {
            EXPECT_EQ(through->fluid().x, other->fluid().x) << place;
            EXPECT_EQ(through->fluid().v, other->fluid().v) << place;
            EXPECT_EQ(through->fluid().id, other->fluid().id) << place;
            EXPECT_EQ(through->fluid().density, other->fluid().density) << place;
        }
    }
}

TEST_IN_2D_AND_3D("along sides that repeat momentum stays; through an open one particles leave, and mass with them") {
    NEEDS_BACKEND;
    auto round = on_backend<D>(test::by_rate, test::heavy_and_viscous<D>() + test::periodic_sides<D>());
    test::shake(round->fluid(), 0.1);
    const real before = test::integral(*round, "momentum_x");
    for (int s = 0; s < 5; ++s) round->step(0.0005);
    EXPECT_NEAR(test::integral(*round, "momentum_x"), before, 1e-5 * before);  // every pair's two forces are rounded apart
    auto out = on_backend<D>(test::by_rate, test::heavy_and_viscous<D>() + test::open_sides<D>());
    const int at_first = out->fluid().count();
    for (int s = 0; s < 50; ++s) out->step(0.002);
    const int left = out->fluid().count();
    EXPECT_LT(left, at_first);
    EXPECT_EQ(test::integral(*out, "particles"), left);
    for (int i = 0; i < left; ++i) ASSERT_LE(out->fluid().position(i)[0], 1);
}

TEST_IN_2D_AND_3D("a jet lets in density times area times speed, and what reaches a drain is gone") {
    NEEDS_BACKEND;
    auto solver = on_backend<D>(test::by_rate, test::heavy_and_viscous<D>() + test::jet_and_drain<D>());
    const int at_first = solver->fluid().count();
    for (int s = 0; s < 10; ++s) solver->step(0.002);
    const auto& fluid = solver->fluid();
    // two rows, of four in 3D; one spacing of 1/8 m each 1/64 s, the first at once
    EXPECT_EQ(fluid.next_id, at_first + (D == 2 ? 2 : 8) * 2);
    EXPECT_LT(fluid.count(), fluid.next_id);  // the drain was full of liquid
    EXPECT_GT(fluid.count(), at_first / 2);
    EXPECT_EQ(test::integral(*solver, "mass"), fluid.count() * fluid.mass);
}
