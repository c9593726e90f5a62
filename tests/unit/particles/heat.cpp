// What enthalpy means to particles, and the sums over a lattice by which conduction is divided.
#include "particles/heat/heat.hpp"
#include "particles/state/flow.hpp"
#include "sph/reference_solver.hpp"
#include "sph/solver.hpp"
#include "support/test.hpp"
#include "thermo/scene_substance.hpp"

#include <fmt/format.h>

namespace weir::heat_tests {
namespace {

using particles::LatticeSums;
using particles::Smoothing;
using thermo::State;

template <int D>
LatticeSums sums(Smoothing kernel, real support, real spacing) {
    particles::Scheme scheme;
    scheme.smoothing = kernel, scheme.support = support;
    return particles::lattice_sums<D>(scheme, spacing);
}

TEST("the moment of a lattice is that of the published sums, whatever the spacing") {
    struct Row {
        int dim;
        Smoothing kernel;
        real support, moment;
    };
    // sum V (-W'/r) x^2 to the digits of 16_sph_conduction_lattice
    for (const Row& row :
         {Row{2, Smoothing::cubic, 2, 1.013099}, Row{2, Smoothing::cubic, 3, 1.006725}, Row{2, Smoothing::wendland, 2, 0.976231},
          Row{2, Smoothing::wendland, 3, 0.997399}, Row{2, Smoothing::muller, 2, 0.886462}, Row{2, Smoothing::muller, 4, 0.985020},
          Row{3, Smoothing::cubic, 2, 1.020042}, Row{3, Smoothing::cubic, 2.6, 0.993484}, Row{3, Smoothing::wendland, 4, 0.999413},
          Row{3, Smoothing::muller, 2, 0.956289}})
        for (const real spacing : {1.0, 0.013}) {
            const auto ours = row.dim == 2 ? sums<2>(row.kernel, row.support, spacing) : sums<3>(row.kernel, row.support, spacing);
            EXPECT_NEAR(ours.moment, row.moment, 1e-6) << row.dim << ' ' << row.support;
        }
}

/// A step of conduction on a lattice is stable up to 2 over the largest eigenvalue; the diagonal's inverse is never longer.
TEST("the step in which no particle of a lattice becomes warmer than its neighbours is one that is stable") {
    struct Row {
        int dim;
        Smoothing kernel;
        real support, most;
    };
    for (const Row& row :
         {Row{2, Smoothing::cubic, 2, 0.36652}, Row{2, Smoothing::wendland, 3, 0.68992}, Row{2, Smoothing::muller, 4, 1.09846},
          Row{3, Smoothing::cubic, 2, 0.33078}, Row{3, Smoothing::wendland, 4, 1.15025}}) {
        const auto ours = row.dim == 2 ? sums<2>(row.kernel, row.support, 1) : sums<3>(row.kernel, row.support, 1);
        EXPECT_LT(1 / ours.diagonal, row.most * ours.moment);
        EXPECT_GT(1 / ours.diagonal, 0.4 * row.most * ours.moment);
    }
}

/// Conducts as a solid as it does as a liquid.
const std::string wax =
    "substance = { name = \"own\", triple = [280.0, 1000.0], critical = [800.0, 5e6], fusion = 3e5, vaporisation = 2e6, "
    "solid = { density = 1000.0, heat_capacity = 4000.0, conductivity = 0.6 }, "
    "liquid = { density = 1000.0, heat_capacity = 4000.0, conductivity = 0.6 }, vapour = { heat_capacity = 2000.0 } }\n";

/// A column of a liquid whose lowest row stands at the wall, all as warm as each other, and the wall warmer by one.
template <int D>
real first_step_at_a_wall(Smoothing kernel, real support, real height) {
    const std::string cells = D == 2 ? "[6, 6]" : "[6, 6, 6]", size = D == 2 ? "[0.6, 0.6]" : "[0.6, 0.6, 0.6]";
    const auto scene = scene::parse(
        fmt::format(
            "solver = \"sph\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime.end = 1.0\nfluid.density = 1000.0\n"
            "liquid = [{{ shape = \"box\", min = {}, max = {} }}]\nscheme = {{ backend = \"reference\", density = "
            "\"summation\", kernel = \"{}\", support = {}, sound_speed = 1e-9 }}\n"
            "initial.temperature = {{ name = \"constant\", value = 300.0 }}\nsides.x_min = {{ kind = \"wall\", temperature = 301.0 }}\n{}",
            D, cells, size, D == 2 ? "[0, 0]" : "[0, 0, 0]", size,
            kernel == Smoothing::muller  ? "muller"
            : kernel == Smoothing::cubic ? "cubic"
                                         : "wendland",
            support, wax),
        "test.toml", {sph::kind().schema});
    sph::ReferenceSphSolver<D> solver(scene);
    particles::Fluid<D>& fluid = solver.fluid();
    for (int i = 0; i < fluid.count(); ++i) {
        Vec<D> x = fluid.position(i);
        x[0] += height - 0.05;
        particles::Fluid<D>::put(fluid.x, i, x);
    }
    const particles::Heat<D> heat(scene, fluid.domain);
    solver.step(heat.stable_dt());
    real warmest = 0;
    for (const real h : fluid.enthalpy) warmest = std::max(warmest, particles::heat_temperature(h, 0, &heat.states()));
    return warmest - 300;
}

TEST("particles at a wall become as warm as it in the longest step, where it lets them, and no warmer") {
    const std::pair<Smoothing, real> schemes[] = {
        {Smoothing::muller, 3}, {Smoothing::cubic, 2}, {Smoothing::wendland, 2}, {Smoothing::wendland, 3}, {Smoothing::cubic, 3}};
    for (const auto& [kernel, support] : schemes)
        for (const real height : {1e-7, 0.01, 0.05}) {
            EXPECT_LE(first_step_at_a_wall<2>(kernel, support, height), 1 + 1e-6) << support << height;
            EXPECT_LE(first_step_at_a_wall<3>(kernel, support, height), 1 + 1e-6) << support << height;
            // a quarter of a spacing above, where all once stood, cubic splines of support 3 reach 0.66
            if (height < 0.01) {
                EXPECT_GT(first_step_at_a_wall<2>(kernel, support, height), 0.75) << support;
            }
        }
}

TEST("temperatures and shares are those of the substance's curve, through both latent heats and back") {
    const auto water = thermo::water();
    for (const real p : {2e4, 101325.0, 5e5}) {
        const auto curve = water->heat_curve(p);
        const auto states = particles::heat_states(curve, {2.2, 0.6, 0.025});
        for (real h = -4e5; h < 4e6; h += 12345.6) {
            const auto warmth = curve.warmth(h);
            EXPECT_NEAR(particles::heat_temperature(h, 0, &states), warmth.T, 1e-12 * warmth.T);
            EXPECT_NEAR(1 - particles::heat_melted(h, &states), curve.share(State::solid, warmth), 1e-12);
            EXPECT_NEAR(particles::heat_vapour(h, 0, &states), curve.share(State::vapour, warmth), 1e-12);
        }
        // Kirchhoff's integral of the conductivity
        const real T = curve.begins_at(1), boils = curve.begins_at(2);
        EXPECT_NEAR(particles::heat_theta(curve.enthalpy(T - 20), 0, &states), -20 * 2.2, 1e-9);
        EXPECT_NEAR(particles::heat_theta(curve.enthalpy(T + 20), 0, &states), 20 * 0.6, 1e-9);
        EXPECT_NEAR(particles::heat_theta(curve.enthalpy(boils + 20), 0, &states), (boils - T) * 0.6 + 20 * 0.025, 1e-9);
        EXPECT_EQ(particles::heat_theta(0.5 * (curve.highest(0) + curve.lowest(1)), 0, &states), 0);  // ice and water together
    }
}

TEST("above the critical pressure the state beyond the liquid stands in the vapour's place, and nothing else is written over") {
    const auto curve = thermo::water()->heat_curve(3e7);
    const auto states = particles::heat_states(curve, {2.2, 0.6, 0.025});
    const real h = curve.enthalpy(260);
    EXPECT_NEAR(particles::heat_temperature(h, 0, &states), 260, 1e-9);
    EXPECT_NEAR(particles::heat_theta(h, 0, &states), 2.2 * (260 - curve.begins_at(1)), 1e-9);
    EXPECT_NEAR(particles::heat_temperature(curve.enthalpy(700), 0, &states), 700, 1e-9);
}

scene::Scene pot(const std::string& more, const std::string& surface = "0.5") {
    return scene::parse(
        "solver = \"sph\"\ndim = 2\ngrid = { cells = [8, 20], size = [0.4, 1.0] }\ntime.end = 1.0\nfluid.density = 1000.0\n"
        "liquid = [{ shape = \"box\", min = [0, 0], max = [0.4, " +
            surface +
            "] }]\nscheme.density = \"summation\"\nsubstance = \"water\"\n"
            "initial.temperature = { name = \"constant\", value = 300.0 }\n" +
            more,
        "test.toml", {sph::kind().schema});
}

TEST("a liquid boils at the saturation temperature of the pressure at its depth, and expands by its volumes") {
    for (const real p : {2e4, 101325.0, 5e5}) {
        const auto scene = pot(
            fmt::format("heat = {{ pressure = {}, vapour = {{ name = \"own\", density = 10.0 }} }}\neffects.gravity.g = [0, -9.81]\n", p));
        auto fluid = particles::initial_fluid<2>(scene);
        const particles::Heat<2> heat(scene, fluid.domain);
        const auto water = thermo::water();
        const auto& states = heat.states();
        fluid.enthalpy.assign(fluid.enthalpy.size(), 0.5 * (states.liquid_end + states.vapour_begin));  // all of it boils
        heat.place(fluid);
        for (int i = 0; i < fluid.count(); ++i) {
            const real d = 0.5 - fluid.position(i)[1];
            // the table's straight pieces of 1/128 m and water's own second derivative: 1e-6 K at 20 kPa
            EXPECT_NEAR(particles::heat_temperature(fluid.enthalpy[static_cast<std::size_t>(i)], heat.shift(i), &states),
                        water->temperature(thermo::Boundary::saturation, p + 1000 * 9.81 * d), 1e-4)
                << p << ' ' << d;
            const real share = particles::heat_vapour(fluid.enthalpy[static_cast<std::size_t>(i)], heat.shift(i), &states);
            EXPECT_NEAR(heat.vapour()->rest(i), 1 / (1 - share + share * 100), 1e-12);
        }
    }
}

TEST("where the pressure of the surroundings changes, a liquid boils at the saturation temperature of the moment") {
    const std::string falling =
        "heat = { vapour = { name = \"own\", density = 10.0 }, ambient.keyframes = [ { t = 0.0, pressure = 101325.0 }, "
        "{ t = 1.0, pressure = 20000.0 } ] }\neffects.gravity.g = [0, -9.81]\n";
    const auto scene = pot(falling);
    auto fluid = particles::initial_fluid<2>(scene);
    const particles::Heat<2> heat(scene, fluid.domain);
    const auto water = thermo::water();
    const auto& states = heat.states();
    fluid.enthalpy.assign(fluid.enthalpy.size(), 0.5 * (states.liquid_end + states.vapour_begin));  // all of it boils
    for (const real t : {0.0, 0.25, 1.0, 2.0, 0.5}) {
        const real p = 101325 - std::min<real>(t, 1) * (101325 - 20000);
        fluid.time = t;
        heat.place(fluid);
        for (int i = 0; i < fluid.count(); ++i) {
            const real d = 0.5 - fluid.position(i)[1];
            EXPECT_NEAR(particles::heat_temperature(fluid.enthalpy[static_cast<std::size_t>(i)], heat.shift(i), &states),
                        water->temperature(thermo::Boundary::saturation, p + 1000 * 9.81 * d), 1e-4)  // as at constant pressure
                << t << ' ' << d;
        }
    }
}

TEST("a liquid starts as warm as the pressure at the start lets it be, however low that will fall") {
    const auto start = [](const std::string& first, real T) {
        auto scene = pot("heat = { vapour = { name = \"own\", density = 10.0 }, ambient.keyframes = [ { t = 0.0, pressure = " + first +
                         " }, { t = 1.0, pressure = 20000.0 } ] }\neffects.gravity.g = [0, -9.81]\n");
        auto fluid = particles::initial_fluid<2>(scene);
        particles::Heat<2> heat(scene, fluid.domain);
        fluid.time = 0;
        fluid.enthalpy.assign(fluid.enthalpy.size(), heat.start_enthalpy(T));
        heat.place(fluid);
        return particles::heat_temperature(fluid.enthalpy[0], heat.shift(0), &heat.states());
    };
    for (const real T : {300.0, 333.0, 334.0, 371.0, 373.1}) EXPECT_NEAR(start("101325.0", T), T, 1e-9) << T;
    EXPECT_THROW(start("101325.0", 374.0), BadInput);
    EXPECT_THROW(start("30000.0", 371.0), BadInput);
}

TEST("depth is the weight above over the area, whatever way gravity points and whether it is liquid or vapour") {
    for (const char* g : {"[0, 9.81]", "[-9.81, 0]", "[9.81, 1]"}) {
        const auto scene = pot(std::string("heat.vapour = { name = \"own\", density = 10.0 }\neffects.gravity.g = ") + g + "\n", "1.0");
        auto fluid = particles::initial_fluid<2>(scene);
        const particles::Heat<2> heat(scene, fluid.domain);
        EXPECT_FALSE(heat.place(fluid));  // nothing boils, and nothing needs to know
        fluid.enthalpy[0] = heat.states().vapour_begin;
        EXPECT_TRUE(heat.place(fluid));
        const auto water = thermo::water();
        const auto& states = heat.states();
        for (int i = 0; i < fluid.count(); ++i) {
            const Vec<2> x = fluid.position(i);
            const real d = g[1] == '0' ? x[1] : g[1] == '-' ? 0.4 - x[0] : x[0];
            const real boils = particles::heat_temperature(states.liquid_end + heat.shift(i), heat.shift(i), &states);
            EXPECT_NEAR(boils, water->temperature(thermo::Boundary::saturation, 101325 + 9810 * d), 1e-4) << g;
        }
    }
}

TEST("no heat passes between two that are as warm as each other, in whatever state and at whatever depth") {
    const auto scene = pot("heat.vapour = { name = \"own\", density = 10.0 }\neffects.gravity.g = [0, -9.81]\n");
    auto fluid = particles::initial_fluid<2>(scene);
    const particles::Heat<2> heat(scene, fluid.domain);
    fluid.enthalpy[0] = heat.states().vapour_begin;  // something boils
    heat.place(fluid);
    const auto& s = heat.states();
    for (const real T : {280.0, 372.0, 373.5, 374.0, 400.0}) {
        std::vector<real> thetas;
        for (int i = 0; i < fluid.count(); ++i) {  // the enthalpy that has this temperature there
            real lo = -1e6, hi = 4e6;
            for (int k = 0; k < 100; ++k) {
                const real h = 0.5 * (lo + hi);
                (particles::heat_temperature(h, heat.shift(i), &s) < T ? lo : hi) = h;
            }
            thetas.push_back(heat.theta(i, hi));
        }
        for (const real theta : thetas) EXPECT_NEAR(theta, thetas[0], 1e-9 * std::abs(thetas[0]));
    }
}

// Kirchhoff 1894: theta is the integral of k dT from where the liquid begins. The liquid's conductivity lasts up to where it boils at the
// deepest place of the domain, 1 m below its top (heat_state.inl); from there on the conductivity is the vapour's, for water 1/25 of the
// liquid's.
TEST("the integral of the conductivity of a liquid that boils goes on with the vapour's conductivity") {
    const auto scene = pot("heat.vapour = { name = \"own\", density = 10.0 }\neffects.gravity.g = [0, -9.81]\n");
    auto fluid = particles::initial_fluid<2>(scene);
    const particles::Heat<2> heat(scene, fluid.domain);
    fluid.enthalpy[0] = heat.states().vapour_begin;  // something boils
    heat.place(fluid);
    const auto water = thermo::water();
    const auto& s = heat.states();
    const auto k = [&](State state) { return water->conduction(state).conductivity; };
    const real begins = water->temperature(thermo::Boundary::melting, 101325),
               boils = water->temperature(thermo::Boundary::saturation, 101325 + 1000 * 9.81 * 1.0);
    ASSERT_LT(k(State::vapour), 0.1 * k(State::liquid));
    for (const real T : {250.0, 300.0, 374.0, 380.0, 400.0, 600.0}) {
        const real exact = T < begins ? k(State::solid) * (T - begins)
                                      : k(State::liquid) * (std::min(T, boils) - begins) + k(State::vapour) * std::max<real>(0, T - boils);
        real lo = -1e6, hi = 4e6;  // the enthalpy that has this temperature
        for (int bisection = 0; bisection < 100; ++bisection) {
            const real h = 0.5 * (lo + hi);
            (particles::heat_temperature(h, heat.shift(0), &s) < T ? lo : hi) = h;
        }
        // the boiling temperature from a table of straight pieces, 1e-4 K as above, times a conductivity of less than 1 W/(m K)
        EXPECT_NEAR(heat.theta(0, hi), exact, 1e-4) << T;
    }
}

/// Steady between surroundings and a wall that is held: how far from the straight line of an exchange and a slab one after the other [K].
real off_the_line(int cells) {
    const auto scene = scene::parse(
        fmt::format(
            "solver = \"sph\"\ndim = 2\ngrid = {{ cells = [{}, 4], size = [1.0, {}] }}\ntime.end = 1e9\nfluid.density = 1000.0\n"
            "liquid = [{{ shape = \"box\", min = [0, 0], max = [1, 1] }}]\nscheme = {{ density = \"summation\", sound_speed = 1e-12 }}\n"
            "initial.temperature = {{ name = \"constant\", value = 310.0 }}\nsides.x_max = {{ kind = \"wall\", temperature = 310.0 }}\n"
            "sides.x_min = {{ kind = \"wall\", exchange = 2.0 }}\nheat.ambient.temperature = 330.0\n{}",
            cells, 4.0 / cells, wax),
        "test.toml", {sph::kind().schema});
    sph::SphSolver<2> solver(scene);
    for (int i = 0; i < 40; ++i) solver.step(1e6);  // six times L^2 rho c/k
    const particles::Heat<2> heat(scene, solver.fluid().domain);
    const real flux = 20 / (1 / 2.0 + 1 / 0.6);
    real worst = 0;
    for (int i = 0; i < solver.fluid().count(); ++i) {
        const real T = particles::heat_temperature(solver.fluid().enthalpy[static_cast<std::size_t>(i)], 0, &heat.states());
        worst = std::max(worst, std::abs(T - 310 - flux * (1 - solver.fluid().position(i)[0]) / 0.6));
    }
    return worst;
}

TEST("a wall that exchanges heat and the slab behind it resist one after the other, at first order in the spacing") {
    const real coarse = off_the_line(16), fine = off_the_line(32);
    EXPECT_LT(fine, 0.25 / 32 * 20) << "two rows take up the flux, of which the upper one's quarter skips a spacing";
    EXPECT_LT(fine, 0.6 * coarse);  // 0.5, less what is of higher order
}

}  // namespace
}  // namespace weir::heat_tests
