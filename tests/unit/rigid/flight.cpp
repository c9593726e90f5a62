// Bodies on their own: along parabolas, and turning as Euler's equations say.
#include "support.hpp"

#include <random>

namespace flight_tests {

using namespace weir;
using namespace weir::rigid;
using namespace weir::test;

namespace {

Bodies<3> spinning_box(const std::string& spin) {
    return Bodies<3>(body_scene(
        3, "bodies = [ { shape = \"box\", min = [1.0, 1.2, 1.4], max = [3.0, 2.2, 1.9], density = 700.0, spin = " + spin + " } ]"));
}

}  // namespace

TEST("an asymmetric body that nothing turns keeps its energy to 1e-6 and its angular momentum to round-off over 100 turns") {
    // About the middle axis of inertia nearly: the one that tumbles.
    for (const char* spin : {"[0.01, 5.0, 0.02]", "[3.0, 1.0, 2.0]"}) {
        Bodies<3> bodies = spinning_box(spin);
        Body<3>& body = bodies[0];
        const real energy = body.kinetic_energy(), turn = 2 * pi / 5.0;
        const Vec<3> momentum = body.angular_momentum();
        real worst_energy = 0, worst_momentum = 0;
        for (int step = 0; step < 100 * 25; ++step) {  // steps as long as a twenty-fifth of a turn
            body.advance_free(turn / 25, {});
            worst_energy = std::max(worst_energy, std::abs(body.kinetic_energy() / energy - 1));
            worst_momentum = std::max(worst_momentum, norm(body.angular_momentum() - momentum) / norm(momentum));
        }
        EXPECT_LT(worst_energy, 1e-6) << spin;
        EXPECT_LT(worst_momentum, 1e-12) << spin;  // 2500 steps, some round-offs of 1e-16 each that add up like their number's root
        EXPECT_GT(worst_energy, 0) << "nothing turned";
    }
}

// Fourth order: half the step leaves a sixteenth of the error; second order would leave a quarter. A step of 1/60 rad is below 0.02 rad,
// the largest that is not divided.
TEST("the energy error of the splitting of a rotation falls with the fourth power of the step") {
    const auto missed = [](real turn) {
        Bodies<3> bodies = spinning_box("[3.0, 1.0, 2.0]");
        Body<3>& body = bodies[0];
        const real energy = body.kinetic_energy(), rate = std::sqrt(14.0);
        real worst = 0;
        for (real angle = 0; angle < 4; angle += turn) {
            body.advance_free(turn / rate, {});
            worst = std::max(worst, std::abs(body.kinetic_energy() / energy - 1));
        }
        return worst;
    };
    const real coarse = missed(1.0 / 60), fine = missed(1.0 / 120);
    EXPECT_GT(fine, 1e-14) << "round-off alone";
    EXPECT_GT(std::log2(coarse / fine), 3.5);
}

TEST("a top turns about its axis of symmetry, and that about the momentum, at the rates of the textbook") {
    // Symmetric top: ω_precession = L / I_across, exact (Landau & Lifshitz, Mechanics, § 33).
    Bodies<3> bodies(body_scene(3,
                                "bodies = [ { shape = \"cylinder\", from = [2.0, 1.5, 2.0], to = [2.0, 2.5, 2.0], radius = 0.8, density = "
                                "500.0, spin = [1.0, 4.0, 0.0] } ]"));
    Body<3>& body = bodies[0];
    const Vec<3> momentum = body.angular_momentum(), axis0{{0, 1, 0}};
    const real r = 0.8, length = 1.0, across = body.mass * (3 * r * r + length * length) / 12, rate = norm(momentum) / across;
    const int steps = 400;
    for (int i = 0; i < steps; ++i) body.advance_free(2 * pi / rate / steps, {});
    const auto rows = rotation<3>(body.orientation);
    Vec<3> axis{};
    for (int a = 0; a < 3; ++a) axis[a] = rows[static_cast<std::size_t>(a)][1];
    EXPECT_NEAR(norm(axis - axis0), 0, 1e-6);  // one precession: the axis is back
}

TEST_IN_2D_AND_3D("a thrown body flies along the parabola exactly, whatever the step") {
    Bodies<D> bodies(body_scene(
        D, D == 2 ? "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.2, density = 2.0, velocity = [1.0, 3.0] } ]"
                  : "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0, 1.0], radius = 0.2, density = 2.0, velocity = [1.0, "
                    "3.0, 0.5] } ]"));
    Body<D>& body = bodies[0];
    Vec<D> g{};
    g[1] = -9.81;
    real t = 0;
    for (const real dt : {0.1, 0.01, 0.03, 0.2, 0.05}) {
        body.advance_free(dt, g);
        body.velocity[1] += dt * g[1];
        t += dt;
        EXPECT_NEAR(body.at[0], 1 + t, 1e-14);
        EXPECT_NEAR(body.at[1], 1 + 3 * t - 0.5 * 9.81 * t * t, 1e-14);
    }
}

TEST("what a scene fixes stays: no way along an axis, no turning") {
    Bodies<2> bodies(
        body_scene(2,
                   "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.2, mass = 2.0, velocity = [1.0, 3.0], spin "
                   "= [2.0], fixed = [\"x\", \"turning\"] } ]"));
    bodies[0].advance_free(0.1, {});
    EXPECT_EQ(bodies[0].at[0], 1.0);
    EXPECT_EQ(bodies[0].orientation[0], 0.0);
    EXPECT_NEAR(bodies[0].at[1], 1.3, 1e-15);
}

}  // namespace flight_tests
