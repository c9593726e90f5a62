// Energy of waves and of a rolling body: nothing puts any in.
#include "support.hpp"

namespace weir::test::energy_tests {
namespace {

using water::Water;

/// A tank whose water stands aslope: the first standing wave of a metre, steep enough to be far from linear.
scene::Scene sloshing(const std::string& transfer, const std::string& time = "end = 12.0") {
    return water_scene(fmt::format(R"(solver = "mac_water"
dim = 2
grid = {{ cells = [32, 24], size = [1.0, 0.75] }}
time = {{ {} }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "plane", point = [0.5, 0.4], normal = [-0.2, 1.0] }} ]
effects.gravity.g = [0.0, -9.81]
scheme = {{ transfer = "{}" }}
)",
                                   time, transfer));
}

/// Of motion and of the surface above where its volume stands at rest [J/m].
real wave_energy(const Solver& solver) {
    const real volume = integral(solver, "volume");
    return integral(solver, "kinetic_energy") + integral(solver, "potential_energy") - 0.5 * 1000 * 9.81 * volume * volume;
}

constexpr real bar = 0.02;
/// Kinetic and potential.
real total(const Solver& solver) { return integral(solver, "kinetic_energy") + integral(solver, "potential_energy"); }

/// Of the only body.
real body_angle(const Solver& solver) {
    for (const auto& field : solver.fields().fields)
        if (field.name == "angle") return field.data[0][0];
    ADD_FAILURE() << "no body";
    return 0;
}

/// ρ g s²/24 for a slope of s over a metre, where ρ g ∫ η² dx / 2 is that: what a part-filled cell holds counts where it is. Surface cells
/// cut the plane exactly, so that round-off is left.
TEST("the potential energy of water with a plane surface is exact") {
    Water<2> water(sloshing("flip"));
    EXPECT_NEAR(wave_energy(water), 1000 * 9.81 * 0.04 / 24, 1e-3);  // the plane ends at walls, where fractions are continued: 1e-4 of it
}

/// A cup half a metre wide whose floor is `up` and whose left wall is `right` above and beside grid lines, filled 0.25 m deep; its walls
/// are two cells thick, wherever liquid is continued in them.
template <int D>
scene::Scene cup(real up, real right) {
    const real x = 0.25 + right, y = 0.25 + up;
    const auto box = [&](real left, real low, real width, real height) {
        return fmt::format(R"({{ shape = "box", min = {}, max = {} }})", list({fmt::format("{}", left), fmt::format("{}", low), "-0.1"}, D),
                           list({fmt::format("{}", left + width), fmt::format("{}", low + height), "0.35"}, D));
    };
    return water_scene(fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {} ]
solids = [ {}, {}, {} ]
effects = {{ gravity = {{ g = {} }} }}
)",
                                   D, list({"16", "16", "4"}, D), list({"1.0", "1.0", "0.25"}, D), box(x, y, 0.5, 0.25),
                                   box(x - 0.125, y - 0.125, 0.75, 0.125), box(x - 0.125, y, 0.125, 0.4), box(x + 0.5, y, 0.125, 0.4),
                                   list({"0.0", "-9.81", "0.0"}, D)));
}

/// Moved between −h/2 and h/2 against the grid, and at rest a quarter of a second later too. The volume V weighs in its middle but for
/// cells where two walls meet: the plane through their corners may misplace a quarter of a cell there, at V/W below where V/W more would
/// go, and of cells that a wall cuts, where it leaves α of h: the middle is α(1 − α)h/2 ≤ h/8 off. Liquid that is continued in the walls
/// weighs 8%.
template <int D>
void check_cup() {
    const real h = 1.0 / 16, deep = D == 2 ? 1 : 0.25, weight = 1000 * 9.81 * deep, width = 0.5, corners = 2 * h * h / 4;
    for (const real up : {0.0, 0.01 * h, 0.5 * h, -0.01 * h})
        for (const real right : {0.0, 0.01 * h, -0.5 * h}) {
            Water<D> water(cup<D>(up, right));
            const real volume = integral(water, "volume") / deep, depth = volume / width;
            const real slack = weight * (corners * depth + width * h * h / 8), wanted = weight * volume * (0.25 + up + 0.5 * depth);
            EXPECT_NEAR(volume, 0.125, corners + 2e-3 * width);  // and one of two slivers of a hundredth of a cell
            EXPECT_NEAR(integral(water, "potential_energy"), wanted, slack) << up << " " << right;
            while (water.time() < 0.25) water.step(water.advised_dt());
            EXPECT_NEAR(total(water), wanted, slack) << up << " " << right;
        }
}

TEST("the potential energy of water in a cup is of the water alone, wherever the cup stands between grid lines") { check_cup<2>(); }
TEST("the potential energy of water in a cup in 3D") { check_cup<3>(); }

/// A floor between grid lines below a tank: cells that it cuts hold liquid above it alone, whose middle is half the open part below the
/// next grid line. No cell is cut by two planes: exact. The middle of the floor's part in its place is 1e-3 off.
template <int D>
void check_floor() {
    for (const real up : {0.3, 0.8}) {
        const real h = 1.0 / 16, floor = (4 + up) * h, level = 0.5, deep = D == 2 ? 1 : 0.25;
        Water<D> water(water_scene(fmt::format(
            "solver = \"mac_water\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime.end = 1.0\nfluid.density = 1000.0\n"
            "liquid = [ {{ shape = \"box\", min = {}, max = {} }} ]\nsolids = [ {{ shape = \"box\", min = {}, max = {} }} ]\n"
            "effects.gravity.g = {}\n",
            D, list({"16", "16", "4"}, D), list({"1.0", "1.0", "0.25"}, D), list({"0.0", "0.0", "0.0"}, D), list({"1.0", "0.5", "0.25"}, D),
            list({"-0.2", "-0.2", "-0.2"}, D), list({"1.2", fmt::format("{:.17g}", floor), "0.5"}, D), list({"0.0", "-9.81", "0.0"}, D))));
        const real wanted = 1000 * 9.81 * deep * (level * level - floor * floor) / 2;
        EXPECT_NEAR(integral(water, "volume"), deep * (level - floor), 1e-12) << up;
        EXPECT_NEAR(integral(water, "potential_energy"), wanted, 1e-9 * wanted) << up;
    }
}

TEST("the potential energy of water above a floor between grid lines is exact") {
    check_floor<2>();
    check_floor<3>();
}

/// The column of a dam break ends at 0.4 m, six tenths of a cell beyond a grid line, and is 0.6 m high. Distances to a box are exact;
/// volumes of cells at its edges, which the level set then follows in 3D, are of second order: a hundredth of a cell.
TEST_IN_2D_AND_3D("front and top of a column are where the scene puts them") {
    const Water<D> water(water_scene(dam_break<D>()));
    EXPECT_NEAR(integral(water, "front_x"), 0.4, 0.01 / 16);
    EXPECT_NEAR(integral(water, "top"), 0.6, 0.01 / 16);
}

const std::vector<std::string> transfers{"flip", "apic", "pic", "grid"};

/// Forces and surface are centred on one another, however long steps are. The bar is 2% of all energy, which here is a wave as high as the
/// start's and its like again: where the level set follows the liquid parts of cells, waves of medium slope swing by up to 14% of their own
/// energy (APIC).
TEST("no wave gains energy by any transfer") {
    for (const auto& transfer : transfers) {
        Water<2> water(sloshing(transfer));
        const real start = wave_energy(water);
        real most = 0;
        while (water.time() < 12) {
            water.step(water.advised_dt());
            most = std::max(most, wave_energy(water));
        }
        EXPECT_LT(most, start + bar * total(water)) << transfer;
    }
}

/// Steps that swing with the wave feed it by ω² δdt/4 a second where a force acts for the step that it ends: steps of a tenth more and less
/// than 0.027 s, shortest where the wave is fastest, 2% a second here.
TEST("no wave gains energy from steps that follow it") {
    for (const auto& transfer : transfers) {
        Water<2> water(sloshing(transfer));
        const real start = wave_energy(water);
        const real omega = std::sqrt(9.81 * pi * std::tanh(0.4 * pi));
        real most = 0;
        while (water.time() < 12) {
            water.step(0.027 * (1 + 0.1 * std::cos(2 * omega * water.time())));
            most = std::max(most, wave_energy(water));
        }
        EXPECT_LT(most, start + bar * total(water)) << transfer;
    }
}

/// After k steps of dt all liquid falls by g t²/2 and at g t: a first step without the force of its start would leave it dt/2 behind.
TEST("a drop falls as far and as fast as it should in steps of any length") {
    const scene::Scene scene = water_scene(R"(solver = "mac_water"
dim = 2
grid = { cells = [16, 32], size = [1.0, 2.0] }
time = { end = 1.0 }
fluid = { density = 1000.0 }
liquid = [ { shape = "sphere", centre = [0.5, 1.5], radius = 0.25 } ]
effects.gravity.g = [0.0, -9.81]
)");
    Water<2> water(scene);
    const real top = integral(water, "top");
    for (const real dt : {0.02, 0.03, 0.01, 0.02, 0.025, 0.02}) {
        water.step(dt);
        const real t = water.time(), mass = 1000 * integral(water, "volume");
        EXPECT_NEAR(integral(water, "momentum_y"), -9.81 * t * mass, 1e-3 * 9.81 * t * mass);
        EXPECT_NEAR(integral(water, "top"), top - 0.5 * 9.81 * t * t, 2e-3);  // a thirtieth of a cell: of interpolation. dt g t/2 is 10 mm
    }
}

/// A box that floats half immersed and rolls loses by waves what it has. Counted from a velocity that the body does not know, FLIP gives
/// the liquid beside it at every step what stands in its way, the more the shorter steps are: swings grow by a tenth each.
TEST("no swing of a rolling box exceeds the first by FLIP at short steps") {
    const scene::Scene scene = water_scene(R"(solver = "mac_water"
dim = 2
grid = { cells = [40, 20], size = [1.6, 0.8] }
time = { end = 5.0 }
fluid = { density = 1000.0 }
liquid = [ { shape = "plane", point = [0.8, 0.5], normal = [0.0, 1.0] } ]
bodies = [ { shape = "box", min = [0.65, 0.4], max = [0.95, 0.6], density = 500.0, spin = [0.5] } ]
effects.gravity.g = [0.0, -9.81]
scheme.transfer = "flip"
)");
    Water<2> water(scene);
    real first = 0, most = 0;
    while (water.time() < 5) {
        water.step(std::min(0.005, water.advised_dt()));
        const real angle = std::abs(body_angle(water));
        (water.time() < 0.6 ? first : most) = std::max(water.time() < 0.6 ? first : most, angle);
    }
    EXPECT_LT(most, first);
}

}  // namespace
}  // namespace weir::test::energy_tests
