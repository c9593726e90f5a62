// What must not break PBF: wherever particles start and however long the step, they stay finite and inside, and bad numbers are caught.
#include "core/error.hpp"
#include "unit/pbf/scenes.hpp"

#include "support/test.hpp"

namespace robustness_tests {

using namespace weir;
using particles::Fluid;

namespace {

template <int D>
real integral(const pbf::PbfSolver<D>& solver, const std::string& name) {
    for (const auto& i : solver.integrals())
        if (i.name == name) return i.value;
    return not_applicable;
}

/// Runs and checks after every step; max_speed throws where something is not finite.
template <int D>
void stays_inside(pbf::PbfSolver<D>& solver, int steps, real dt) {
    for (int s = 0; s < steps; ++s) {
        solver.step(dt);
        ASSERT_EQ(integral(solver, "outside"), 0) << "step " << s;
    }
}

}  // namespace

TEST_IN_2D_AND_3D("coincident particles stay finite and inside") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(0.5, 0.5, 0.5)));
    auto& fluid = solver->fluid();
    for (int i = 0; i < fluid.count(); i += 2) Fluid<D>::put(fluid.x, i, fluid.position(0));
    stays_inside(*solver, 50, 0.008);
}

TEST_IN_2D_AND_3D("every particle in one cell, far more than the list's first room: the list grows, nothing leaves") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(1, 1, 1), "settle = 0"));
    auto& fluid = solver->fluid();
    solver->pairs().list().entries_at_first = 64;
    for (int i = 0; i < fluid.count(); ++i)
        Fluid<D>::put(fluid.x, i, Vec<D>::constant(0.5) + 0.1 * (fluid.position(i) - Vec<D>::constant(0.5)));
    solver->step(0.008);
    EXPECT_GT(solver->pairs().list().growths(), 0);
    EXPECT_GT(integral(*solver, "max_neighbours"), fluid.count() / 2);
    stays_inside(*solver, 30, 0.008);
}

TEST_IN_2D_AND_3D("a single particle falls like one and ends on the floor") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(0.125, 0.125, 0.125)));
    ASSERT_EQ(solver->fluid().count(), 1);
    Fluid<D>::put(solver->fluid().x, 0, Vec<D>::constant(0.8));
    for (int s = 0; s < 10; ++s) solver->step(0.008);
    // symplectic Euler: g dt^2 n (n + 1) / 2
    EXPECT_NEAR(solver->fluid().position(0)[1], 0.8 - 9.81 * 0.008 * 0.008 * 55, 1e-6);
    stays_inside(*solver, 200, 0.008);
    EXPECT_NEAR(solver->fluid().position(0)[1], solver->fluid().domain.margin, 1e-6);
}

TEST_IN_2D_AND_3D("a tank that has run empty steps and reports nothing") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(0.5, 0.5, 0.5)));
    solver->fluid().remove_if([](int) { return true; });
    ASSERT_EQ(solver->fluid().count(), 0);
    EXPECT_EQ(solver->step(0.008).density_error, 0);
    EXPECT_GT(solver->advised_dt(), 0);
}

/// Mean over all particles of a block without gravity; at its sides kernels reach beyond it, and that is at most half of the mass.
TEST_IN_2D_AND_3D("densities are in kg/m^3: within a factor of two of the liquid's") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(1, 1, 1)));
    solver->step(0.008);
    real sum = 0;
    for (int i = 0; i < solver->fluid().count(); ++i) sum += solver->fluid().density[static_cast<std::size_t>(i)];
    EXPECT_NEAR(std::log2(sum / solver->fluid().count() / 1000), 0, 1);
}

TEST_IN_2D_AND_3D("a block twice too dense spreads without leaving the box") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(1, 1, 1)));
    auto& fluid = solver->fluid();
    const real squeeze = std::pow(0.5, 1.0 / D);
    for (int i = 0; i < fluid.count(); ++i) Fluid<D>::put(fluid.x, i, squeeze * fluid.position(i));
    EXPECT_GT(solver->step(0.008).max_density_error, 0.01);
    stays_inside(*solver, 200, 0.008);
}

TEST("walls that would do nothing are refused: an inflow, and what sticks") {
    for (const char* more : {"sides.x_min = { kind = \"inflow\", velocity = [1, 0] }", "sides.x_min = { kind = \"wall\", slip = \"no\" }",
                             "sides.x_min = { kind = \"moving_wall\", velocity = [0, 1] }",
                             "solids = [ { shape = \"sphere\", centre = [0.8, 0.8], radius = 0.1, slip = \"no\" } ]"})
        EXPECT_THROW(test::pbf_solver<2>(test::pbf_scene<2>(test::box<2>(0.5, 0.5, 0.5), "", more)), scene::BadScene) << more;
}

TEST("the advised step divides the run evenly, or a frame where it is met exactly, is that of the fastest flow, and never changes") {
    const auto scene = test::pbf_scene<2>(test::box<2>(1, 1, 1), "", "output = { every = 0.1, at = \"exact\" }");
    const auto advised = [&](const std::string& more) {
        return test::pbf_solver<2>(test::pbf_scene<2>(test::box<2>(1, 1, 1), "", more))->advised_dt();
    };
    EXPECT_EQ(advised("output.every = 0.1"), advised(""));
    EXPECT_EQ(advised("output.every = 0.0173"), advised(""));
    auto solver = test::pbf_solver<2>(scene);
    const real dt = solver->advised_dt(), fall = std::sqrt(2 * 9.81 * 0.9375);  // from the highest particle
    EXPECT_LE(dt, 0.5 * 0.125 / fall);
    EXPECT_EQ(dt, 0.1 / std::round(0.1 / dt));
    for (int s = 0; s < 20; ++s) solver->step(dt);
    EXPECT_EQ(solver->advised_dt(), dt);
}

/// A constraint that is off by 1% lets what is pushed apart rise as much.
constexpr real energy_slack = 1.01;

template <int D>
real energy(const pbf::PbfSolver<D>& solver) {
    return integral(solver, "kinetic_energy") + integral(solver, "potential_energy");
}

TEST_IN_2D_AND_3D("a block that falls apart at the advised step gains no energy") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(0.5, 1, 1)));
    const real first = energy(*solver), dt = solver->advised_dt();
    for (int s = 0; s < 300; ++s) {
        solver->step(dt);
        ASSERT_LE(energy(*solver), energy_slack * first) << "step " << s;
    }
}

TEST_IN_2D_AND_3D("a step that is cut short to meet a frame brings no energy") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(1, 1, 1)));
    const real first = energy(*solver), dt = 0.008;
    for (int s = 0; s < 200; ++s) {
        solver->step(s % 10 == 9 ? 0.01 * dt : dt);
        ASSERT_LE(energy(*solver), energy_slack * first) << "step " << s;
    }
}

TEST_IN_2D_AND_3D("ten times the advised step stays finite and inside") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(0.5, 1, 1)));
    stays_inside(*solver, 100, 10 * solver->advised_dt());
}

TEST_IN_2D_AND_3D("a column 5 m deep holds its weight at the advised step") {
    const std::string cells = D == 2 ? "[8, 44]" : "[8, 44, 8]", size = D == 2 ? "[1, 5.5]" : "[1, 5.5, 1]";
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(1, 5, 1), "", "", cells, size));
    stays_inside(*solver, 300, solver->advised_dt());
    // H g dt^2 = (cfl d)^2 / 2, so N iterations leave a mean of cfl^2 / 4 S (1 - w) / (r N) = 0.8% at any depth
    EXPECT_LE(integral(*solver, "mean_compression"), 0.01);
    // half of the surface's own spacing, and of what 0.8% take off the height
    EXPECT_NEAR(integral(*solver, "mean_height"), 2.5, 0.5 * 0.125 + 0.5 * 0.008 * 5);
}

TEST_IN_2D_AND_3D("thrown at a corner at 100 m/s, no particle gets out") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(0.5, 0.5, 0.5)));
    auto& fluid = solver->fluid();
    for (int i = 0; i < fluid.count(); ++i) Fluid<D>::put(fluid.v, i, Vec<D>::constant(-100));
    stays_inside(*solver, 50, 0.008);
}

TEST_IN_2D_AND_3D("a particle that is not a number is caught in the step it appears, by name") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(0.5, 0.5, 0.5)));
    solver->step(0.008);
    solver->fluid().v[0][3] = std::nan("");
    EXPECT_THROW(solver->step(0.008), NumericalFailure);
}

TEST_IN_2D_AND_3D("a ball in the way is not entered") {
    const std::string ball = D == 2 ? "solids = [{ shape = \"sphere\", centre = [0.75, 0.3], radius = 0.2 }]"
                                    : "solids = [{ shape = \"sphere\", centre = [0.75, 0.3, 0.5], radius = 0.2 }]";
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(0.5, 1, 1), "", ball));
    stays_inside(*solver, 150, 0.008);
}

/// Motion of all, and of the bodies; at the start the water's 613 J/m over the floor, and the discs' 25 above it.
TEST("a particle between a wall and a floating disc does not throw the disc") {
    for (const char* at : {"0.7", "0.702", "0.704"}) {
        const std::string bodies = fmt::format(R"(bodies = [ {{ shape = "sphere", centre = [{0}, 0.09], radius = 0.09, density = 500 }},
            {{ shape = "sphere", centre = [{0}, 0.24], radius = 0.06, density = 500 }} ])",
                                               at);
        auto solver = test::pbf_solver<2>(
            test::pbf_scene<2>("{ shape = \"box\", min = [0, 0], max = [0.5, 0.5] }", "iterations = 8", bodies, "[32, 32]", "[1, 1]"));
        real most = 0;
        for (int s = 0; s < 1000; ++s) {
            solver->step(0.002);
            most = std::max(most, integral(*solver, "kinetic_energy") + integral(*solver, "bodies_kinetic_energy"));
        }
        EXPECT_LT(most, 613 + 25) << at;
    }
}

TEST_IN_2D_AND_3D("a liquid at rest on a periodic floor is the same everywhere along it") {
    auto solver = test::pbf_solver<D>(
        test::pbf_scene<D>(test::box<D>(1, 0.5, 1), "", "sides = { x_min = { kind = \"periodic\" }, x_max = { kind = \"periodic\" } }"));
    for (int s = 0; s < 20; ++s) solver->step(0.008);
    // a lattice that repeats has no sideways force: columns stay columns, to single precision
    for (int i = 0; i < solver->fluid().count(); ++i) EXPECT_LE(std::abs(solver->fluid().velocity(i)[0]), 1e-3);
    EXPECT_EQ(integral(*solver, "outside"), 0);
}

TEST_IN_2D_AND_3D("a list that would need more memory than it may have is refused by name, and the state is that of the last step") {
    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(1, 1, 1), "settle = 0"));
    solver->step(0.008);
    auto& fluid = solver->fluid();
    for (int i = 0; i < fluid.count(); ++i) Fluid<D>::put(fluid.x, i, Vec<D>::constant(0.5) + 0.001 * fluid.position(i));
    solver->pairs().list().max_bytes = 1000;  // all in one cell: n^2 entries of 4 bytes
    const auto steps = fluid.steps;
    try {
        solver->step(0.008);
        ADD_FAILURE() << "was not refused";
    } catch (const NumericalFailure& failure) {
        EXPECT_NE(std::string(failure.what()).find("neighbour list"), std::string::npos) << failure.what();
    }
    EXPECT_EQ(fluid.steps, steps);
    EXPECT_GE(fluid.max_speed(), 0);
}

TEST("a million particles make a few steps, inside and finite") {
    auto solver = test::pbf_solver<3>(
        test::pbf_scene<3>("{ shape = \"box\", min = [0, 0, 0], max = [1, 1, 1] }", "settle = 0", "", "[100, 150, 100]", "[1, 1.5, 1]"));
    ASSERT_EQ(solver->fluid().count(), 1000000);
    stays_inside(*solver, 3, 0.0006);
    EXPECT_EQ(integral(*solver, "particles"), 1e6);
}

TEST_IN_2D_AND_3D("what walls put back is counted once, beside a side that repeats too, and alike with any number of threads") {
    const auto run = [](int with) {
        set_threads(with);
        auto solver = test::pbf_solver<D>(test::pbf_scene<D>(
            test::box<D>(1, 0.5, 1), "settle = 0", "sides = { x_min = { kind = \"periodic\" }, x_max = { kind = \"periodic\" } }"));
        auto& fluid = solver->fluid();
        for (int i = 0; i < fluid.count(); ++i) Fluid<D>::put(fluid.v, i, -10 * Vec<D>::unit(1));
        for (int s = 0; s < 5; ++s) solver->step(0.008);
        return std::pair{integral(*solver, "clamped"), integral(*solver, "clamp_depth")};
    };
    const auto one = run(1), three = run(3);
    set_threads(1);
    EXPECT_GT(one.first, 0);
    EXPECT_EQ(one, three);

    auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(0.125, 0.125, 0.125), "settle = 0",
                                                         "sides = { x_min = { kind = \"periodic\" }, x_max = { kind = \"periodic\" } }"));
    Fluid<D>::put(solver->fluid().x, 0, 0.01 * Vec<D>::constant(1));  // it has an image beyond the side
    Fluid<D>::put(solver->fluid().v, 0, -5 * Vec<D>::unit(1));
    solver->step(0.008);
    EXPECT_EQ(integral(*solver, "clamped"), 1);
}

}  // namespace robustness_tests
