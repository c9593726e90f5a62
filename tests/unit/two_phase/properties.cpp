// Properties of the whole step: volumes, symmetries, threads, restarts.
#include "support.hpp"

#include "core/error.hpp"

namespace property_tests {

using namespace weir;
using namespace weir::test;
using two_phase::Experiment;
using two_phase::TwoPhase;

namespace {

/// The largest difference of fractions between a solver and another one whose cell `to(I)` is cell I of the first.
template <int D, class F>
real difference(const TwoPhase<D>& one, const TwoPhase<D>& other, F&& to) {
    return max_over(one.fraction().extent(), [&](const Index<D>& I) { return std::abs(one.fraction()(I) - other.fraction()(to(I))); });
}

}  // namespace

// The sum of n^D fractions in [0, 1], each with the round-off of D sweeps, over 40 steps.
TEST_IN_2D_AND_3D("a collapse keeps the volume of each phase to round-off, and fractions stay in [0, 1]") {
    TwoPhase<D> solver(two_phase_scene(collapse<D>()));
    const real liquid = integral(solver, "volume"), gas = integral(solver, "gas_volume");
    for (int step = 0; step < 40; ++step) {
        solver.step(solver.advised_dt());
        EXPECT_LT(mac::max_magnitude(solver.fraction(), 0.5), 0.5 + 1e-8);  // the divergence that the pressure left
    }
    EXPECT_NEAR(integral(solver, "volume"), liquid, 1e-14);
    EXPECT_NEAR(integral(solver, "gas_volume"), gas, 1e-14);
    EXPECT_GT(integral(solver, "kinetic_energy"), 1) << "something moved";
}

TEST_IN_2D_AND_3D("one thread and three give the same bits") {
    const auto scene = two_phase_scene(collapse<D>());
    TwoPhase<D> one(scene), three(scene);
    set_threads(1);
    run(one, 5);
    set_threads(3);
    run(three, 5);
    set_threads(1);
    EXPECT_TRUE(same_bits(one, three));
}

TEST_IN_2D_AND_3D("a run that is saved and restored continues bit for bit") {
    const auto scene = two_phase_scene(collapse<D>());
    TwoPhase<D> whole(scene), first(scene), second(scene);
    run(whole, 11);
    run(first, 7);  // not a multiple of the orders of sweeps
    Checkpoint checkpoint;
    first.save(checkpoint);
    second.restore(checkpoint);
    EXPECT_EQ(second.time(), first.time());
    run(second, 4);
    EXPECT_TRUE(same_bits(whole, second));
}

// Multigrid visits cells in another order: the solve's tolerance 1e-10, over ten steps.
TEST_IN_2D_AND_3D("a mirrored collapse is the mirror image") {
    auto text = collapse<D>();
    TwoPhase<D> left(two_phase_scene(text));
    const auto at = text.find("min = [0.0"), to = text.find("max = [0.41");
    text.replace(to, 11, "max = [1.00");
    text.replace(at, 10, "min = [0.59");
    TwoPhase<D> right(two_phase_scene(text));
    run(left, 10);
    run(right, 10);
    const int n = left.fraction().extent()[0];
    EXPECT_LT(difference(left, right, [&](Index<D> I) { return I[0] = n - 1 - I[0], I; }), 1e-7);
}

// A drop that flies along x and one along y, with sweeps in the other order.
TEST("a turned flight is the turned image") {
    const auto flight = [](const char* velocity, int order) {
        const std::string more =
            std::string("initial.liquid_velocity = ") + velocity + "\neffects = { surface_tension = { sigma = 10.0 } }";
        return std::make_unique<TwoPhase<2>>(two_phase_scene(drop<2>(24, more)), Partition{}, Experiment{.first_order_of_sweeps = order});
    };
    const auto along_x = flight("[1.0, 0.0]", 0), along_y = flight("[0.0, 1.0]", 1);
    run(*along_x, 12);
    run(*along_y, 12);
    EXPECT_LT(difference(*along_x, *along_y, [](Index<2> I) { return std::swap(I[0], I[1]), I; }), 1e-7);
}

TEST_IN_2D_AND_3D("a flight shifted by whole cells in a periodic box is the shifted image") {
    const int n = D == 2 ? 24 : 16;
    auto text = drop<D>(n, "initial.liquid_velocity = " + list({"1.0", "0.5", "0.2"}, D));
    TwoPhase<D> here(two_phase_scene(text));
    text.replace(text.find("centre = [0.5"), 13, D == 2 ? "centre = [0.75" : "centre = [0.75");
    TwoPhase<D> there(two_phase_scene(text));
    run(here, 10);
    run(there, 10);
    EXPECT_LT(difference(here, there, [&](Index<D> I) { return I[0] = (I[0] + n / 4) % n, I; }), 1e-7);
}

namespace {

/// A drop of radius 0.15 m flies at 1 m/s through gas at rest, for half a length of its periodic box.
struct Flight {
    real rise = 0, energy = 1, aspect = 0;  // largest rise of energy in a step; at the end; length of the drop over its width
    bool failed = false;
    explicit Flight(const Experiment& experiment) {
        const auto scene = two_phase_scene(drop<2>(n, "initial.liquid_velocity = [1.0, 0.0]"), {{"liquid[0].radius", "0.15"}});
        TwoPhase<2> solver(scene, {}, experiment);
        const real start = integral(solver, "kinetic_energy");
        try {
            while (solver.time() < 0.5) {
                solver.step(solver.advised_dt());
                const real now = integral(solver, "kinetic_energy") / start;
                rise = std::max(rise, now - energy);
                energy = now;
            }
        } catch (const NumericalFailure&) {
            failed = true;
        }
        measure(solver.fraction());
    }

private:
    static constexpr int n = 24;
    void measure(const Grid<real, 2>& f) {
        real sum = 0, c = 0, s = 0, y = 0, along = 0, across = 0;
        each(f, [&](real part, const Vec<2>& x) {
            const real angle = 2 * pi * x[0] / n;
            sum += part, c += part * std::cos(angle), s += part * std::sin(angle), y += part * x[1];
        });
        const real middle = std::atan2(s, c) * n / (2 * pi);
        each(f, [&](real part, const Vec<2>& x) {
            const real dx = std::remainder(x[0] - middle, n), dy = x[1] - y / sum;
            along += part * dx * dx, across += part * dy * dy;
        });
        aspect = std::sqrt(along / across);
    }
    template <class F>
    static void each(const Grid<real, 2>& f, F&& visit) {
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) visit(f({{i, j}}), Vec<2>{{i + 0.5, j + 0.5}});
    }
};

}  // namespace

// Without viscosity and tension energy changes by the limited slopes only, which dissipate; what is left is the tolerance of the pressure.
// The pressure of the gas at the front flattens the drop: 0.94 to 0.96 by measurement.
TEST("a drop that is flung through gas keeps its shape and gains no energy") {
    const Flight flight{Experiment{}};
    EXPECT_FALSE(flight.failed);
    EXPECT_GT(flight.aspect, 0.93);
    EXPECT_LT(flight.rise, 1e-5);
}

// What one density and one flux are for.
TEST("with velocity advected by itself the drop is squeezed; with another density in the pressure than in the momentum it gains energy") {
    EXPECT_LT(Flight(Experiment{.velocity_form = true}).aspect, 0.85);
    const Flight mean(Experiment{.mean_density = true});
    EXPECT_TRUE(mean.failed || mean.rise > 1e-4) << mean.rise;  // ten times what is allowed above
}

}  // namespace property_tests
