// Heat, melting and freezing of the solver "mac": what it keeps, what ice stops, and what its loops compute with.
#include "smoke/heat.hpp"

#include "core/parallel.hpp"
#include "support/grid_solvers.hpp"
#include "support/test.hpp"
#include "thermo/substance.hpp"

#include <numbers>
#include <random>

namespace weir::smoke::heat_tests {

namespace {

/// A substance that melts at 300 K, of one density.
const std::string wax =
    "[substance]\nname = \"own\"\ntriple = [300.0, 1000.0]\ncritical = [800.0, 5e6]\nfusion = 3.34e5\nvaporisation = 2.2e6\n"
    "solid = { density = 1000.0, heat_capacity = 2000.0, conductivity = 2.0 }\n"
    "liquid = { density = 1000.0, heat_capacity = 4000.0, conductivity = 0.6 }\nvapour = { heat_capacity = 2000.0 }\n";

/// Ice at the left of water that is the warmer the farther from it, so that it turns, with a warm wall, a heater and a source of heat in
/// another wall: all terms.
std::string stirred(int dim, const std::string& more = "") {
    const std::string d = std::to_string(dim), box = test::list(dim, "0.03"), cells = test::list(dim, "12");
    return "solver = \"mac\"\ndim = " + d + "\ngrid = { cells = " + cells + ", size = " + box +
           " }\ntime = { end = 1.0 }\nfluid = { density = 1000.0, viscosity = 1e-6 }\n"
           "sides = { x_min = { kind = \"wall\", slip = \"no\", temperature = 310.0 }, x_max = { kind = \"wall\", heat_flux = 300.0 } }\n"
           "initial = { temperature = { name = \"linear\", value = 299.0, gradient = " +
           (dim == 2 ? "[1000.0, 0.0]" : "[1000.0, 0.0, 0.0]") + ", at = " + test::list(dim, "0.01") +
           " } }\nheaters = [ { shape = \"sphere\", centre = " + test::list(dim, "0.024") +
           ", radius = 0.003, power = 1.0 } ]\neffects = { viscosity = {}, buoyancy = { beta = 3e-3, ambient = 300.0 } }\n"
           "scheme = { advection = \"conservative\", flux = \"central\" }\n" +
           more + wax;
}

template <int D>
real integral_of(const FlowSolver<D>& flow, const std::string& name) {
    for (const auto& integral : flow.integrals())
        if (integral.name == name) return integral.value;
    return std::nan("");
}

}  // namespace

TEST("temperature and share of liquid are those of the substance's curve") {
    const auto curve = thermo::water()->heat_curve(101325);
    Melting m;
    m.T = curve.begins_at(1), m.h_solid = curve.highest(0), m.h_liquid = curve.lowest(1);
    m.c_solid = curve.heat_capacity(0), m.c_liquid = curve.heat_capacity(1);
    for (real h = -5e5; h < 4e5; h += 313.7) {
        const auto warmth = curve.warmth(h);
        EXPECT_NEAR(m.temperature(h), warmth.T, 1e-12 * warmth.T);  // some roundings
        EXPECT_NEAR(m.liquid(h), curve.share(thermo::State::liquid, warmth), 1e-15);
        EXPECT_NEAR(m.temperature(m.enthalpy(warmth.T)), warmth.T, 1e-12 * warmth.T);
    }
}

TEST_IN_2D_AND_3D("heat in the box is what was there and what sides and heaters gave, through a flow that melts ice") {
    set_threads(1);
    for (const char* conduction : {"stages", "explicit"}) {
        FlowSolver<D> flow(test::mac_scene(stirred(D, "heat = { pressure = 1e5, conduction = \"" + std::string(conduction) + "\" }\n")));
        const real heat = integral_of(flow, "heat"), liquid = integral_of(flow, "liquid_volume");
        for (int i = 0; i < 20; ++i) flow.step(0.02);
        const real added = integral_of(flow, "heat_added");
        EXPECT_GT(std::abs(added), 0.1 * (D == 2 ? 1 : 0.03)) << conduction;
        // Of the sums of up to 1728 cells with 3e5 J/kg each, every step rounds once a cell: 1e-16 times the steps and a few terms.
        EXPECT_NEAR(integral_of(flow, "heat"), heat + added, 1e-13 * std::abs(heat) * 20) << conduction;
        EXPECT_NE(integral_of(flow, "liquid_volume"), liquid) << conduction;
    }
}

TEST_IN_2D_AND_3D("a heater gives its power while it works, and a wall its flux times its area") {
    set_threads(1);
    const auto heat_after_a_second = [](const std::string& more) {
        const auto scene = test::mac_scene(
            "solver = \"mac\"\ndim = " + std::to_string(D) + "\ngrid = { cells = " + (D == 2 ? "[6, 9]" : "[6, 9, 6]") +  // no cubes
            ", size = " + test::list(D, "0.3") + " }\ntime = { end = 1.0, max_dt = 0.21 }\n" +
            "fluid = { density = 1000.0 }\ninitial = { temperature = { name = \"constant\", value = 310.0 } }\n" + more + wax);
        FlowSolver<D> flow(scene);
        const real before = integral_of(flow, "heat");
        while (flow.time() < 1 - 1e-9) flow.step(std::min({0.21, flow.advised_dt(), 1 - flow.time()}));
        return integral_of(flow, "heat") - before;
    };
    const std::string ball = "heaters = [ { shape = \"sphere\", centre = " + test::list(D, "0.1") + ", radius = 0.1, ";
    // Sums of 216 cells at 1e5 J/kg lose digits of 1e-16 of 1e6 J.
    EXPECT_NEAR(heat_after_a_second(ball + "power = 10.0 } ]\n"), 10, 1e-6);
    EXPECT_NEAR(heat_after_a_second(ball + "power = 10.0, start = 0.25, end = 0.75 } ]\n"), 5, 1e-6);
    EXPECT_NEAR(heat_after_a_second("sides.y_max = { kind = \"wall\", heat_flux = 200.0 }\n"), 200 * std::pow(0.3, D - 1), 1e-6);
    // Half of what it covers is solid: all of its power goes to the other half.
    const std::string half =
        "solids = [ { shape = \"box\", min = " + test::list(D, "0.0") + ", max = " + (D == 2 ? "[0.1, 0.3]" : "[0.1, 0.3, 0.3]");
    EXPECT_NEAR(heat_after_a_second(ball + "power = 10.0 } ]\n" + half + " } ]\n"), 10, 1e-6);
}

TEST_IN_2D_AND_3D("where all is ice nothing moves, and the flow around it is free of divergence") {
    set_threads(1);
    FlowSolver<D> flow(test::mac_scene(stirred(D)));
    StepReport report;
    for (int i = 0; i < 10; ++i) report = flow.step(0.02);
    const auto& s = flow.state();
    const auto fields = flow.fields();
    const auto liquid = fields.find("liquid")->data[0];
    const auto at = [&](const Index<D>& I) { return liquid[s.p.linear(I)]; };
    real fastest = 0;
    int frozen = 0;
    for (int a = 0; a < D; ++a)
        for_each_in(e<D>(a), s.extent(), [&](const Index<D>& I) {
            fastest = std::max(fastest, std::abs(s.u[a](I)));
            if (std::min(at(I), at(I - e<D>(a))) > 0) return;
            ++frozen;
            EXPECT_EQ(s.u[a](I), 0);
        });
    EXPECT_GT(frozen, 10);
    EXPECT_GT(fastest, 1e-4);
    // The pressure's residual times dt/rho, and the rounding of u beside weak faces.
    EXPECT_LT(report.max_divergence, 0.02 / 1000 * report.residual_max + 1e-12 * fastest / s.u.h[0]);
}

TEST_IN_2D_AND_3D("ice warms by its own heat capacity, and water by its own") {
    set_threads(1);
    for (const real begin : {280.0, 310.0}) {
        const real capacity = begin < 300 ? 2000 : 4000, power = 1e4 * std::pow(0.1, D - 1);
        FlowSolver<D> flow(test::mac_scene(
            "solver = \"mac\"\ndim = " + std::to_string(D) + "\ngrid = { cells = " + test::list(D, "4") +
            ", size = " + test::list(D, "0.1") +
            " }\ntime = { end = 1e9 }\nfluid = { density = 1000.0 }\ninitial = { temperature = { name = \"constant\", value = " +
            std::to_string(begin) + " } }\nheaters = [ { shape = \"box\", min = " + test::list(D, "-1.0") +
            ", max = " + test::list(D, "1.0") + ", power = " + std::to_string(power) + " } ]\n" + wax));
        for (int i = 0; i < 4; ++i) flow.step(20);
        const auto fields = flow.fields();
        // All is heated alike, so that nothing flows and nothing is conducted: T = T0 + P t / (m c), here by 4 K or 2 K. Enthalpies of
        // 1e5 J/kg round at 1e-11.
        const real warmer = power * 80 / (1000 * std::pow(0.1, D) * capacity);
        EXPECT_LT(warmer, 10);
        EXPECT_GT(warmer, 1);
        for (const real T : fields.find("temperature")->data[0]) ASSERT_NEAR(T, begin + warmer, 1e-9);
    }
}

TEST("conduction gets through steps of any length, to the lever rule's end") {
    set_threads(1);
    for (const real dt : {1.0, 10.0, 100.0, 1000.0}) {
        FlowSolver<2> flow(test::mac_scene(
            "solver = \"mac\"\ndim = 2\ngrid = { cells = [32, 32], size = [0.01, 0.01] }\ntime = { end = 1.0 }\nfluid = { density = 1000.0 "
            "}\n"
            "initial = { temperature = { name = \"ball\", centre = [0.005, 0.005], radius = 0.003, value = 290.0, outside = 315.0 } }\n" +
            wax));
        const real heat = integral_of(flow, "heat"), volume = 1e-4, water = integral_of(flow, "liquid_volume") / volume;
        for (real t = 0; t < 4000; t += dt) flow.step(dt);
        EXPECT_NEAR(integral_of(flow, "heat"), heat, 1e-12 * std::abs(heat)) << dt;
        // What the water gives until it is at 300 K, less what the ice takes to be, melts ice. The slowest
        // difference falls to less than a fifth of itself in a step of any length: to below 1e-6 of it in four of the longest.
        const real melts = (water * 4000 * 15 - (1 - water) * 2000 * 10) / 3.34e5;
        EXPECT_NEAR(integral_of(flow, "liquid_volume") / volume, water + melts, 1e-6) << dt;
    }
}

TEST("conduction in one stage and in several melts alike where steps are short") {
    set_threads(1);
    const auto melted = [](const char* conduction) {
        FlowSolver<2> flow(
            test::mac_scene("solver = \"mac\"\ndim = 2\ngrid = { cells = [32, 1], size = [0.032, 0.001] }\ntime = { end = 1.0 }\n"
                            "fluid = { density = 1000.0 }\nsides = { x_min = { kind = \"wall\", temperature = 320.0 } }\n"
                            "initial = { temperature = { name = \"constant\", value = 295.0 } }\nheat = { pressure = 1e5, conduction = \"" +
                            std::string(conduction) + "\" }\n" + wax));
        for (int i = 0; i < 1500; ++i) flow.step(0.1);
        return integral_of(flow, "liquid_volume");
    };
    const real a = melted("explicit"), b = melted("stages");
    EXPECT_GT(a, 2e-6);
    EXPECT_NEAR(a / b, 1, 2e-3);  // both are of first order in a step that is a thousandth of the time
}

TEST("a liquid is lighter than where it melts by the integral of its expansion, and a solid by nothing") {
    const auto scene = [](const std::string& more) {
        return test::mac_scene(
            "solver = \"mac\"\ndim = 2\ngrid = { cells = [4, 4], size = [1.0, 1.0] }\ntime = { end = 1.0 }\n"
            "fluid = { density = 1000.0 }\n" +
            more);
    };
    std::string expanding = wax;
    expanding.replace(expanding.find("conductivity = 0.6"), 18, "conductivity = 0.6, expansion = 2e-4");
    const thermo::Lightness light(scene(expanding)), water(scene("substance = \"water\"\n"));
    for (const real T : {250.0, 300.0, 303.7, 340.0}) EXPECT_NEAR(light(T), 2e-4 * std::max(T - 300, 0.0), 1e-15) << T;
    // Water is heaviest at 277.13 K, by 1.3e-4 (IAPWS; the formula of its saturated liquid has 277.1 K).
    EXPECT_LT(water(277.13), -1.2e-4);
    EXPECT_GT(water(277.13), -1.4e-4);
    EXPECT_GT(water(274), water(277));
    EXPECT_GT(water(283), water(278));
    EXPECT_EQ(water(260), 0);
}

// β = −d ln ρ/dT, so that its integral is the logarithm of a ratio of densities. Simpson's rule errs by h⁴ β‴/2880 per step of a sixth of a
// kelvin, 1e-9 at most in all; linear interpolation between table entries errs by h² β′/8, 6e-8.
TEST("the lightness of water is the logarithm of the ratio of its densities at melting and now") {
    const thermo::Lightness water(
        test::mac_scene("solver = \"mac\"\ndim = 2\ngrid = { cells = [4, 4], size = [1.0, 1.0] }\ntime = { end = 1.0 }\n"
                        "fluid = { density = 1000.0 }\nsubstance = \"water\"\n"));
    const auto density = [](real T) { return thermo::water()->colder_density(thermo::Boundary::saturation, T); };
    const real melts = thermo::melting_at(*thermo::water(), 101325).T, begins = thermo::water()->triple()->T;
    const real below = thermo::water()->expansion(begins) * (begins - melts);  // as at the triple point, 0.01 K warmer
    for (const real T : {275.0, 277.0, 285.0, 300.0, 330.0, 372.0})
        EXPECT_NEAR(water(T), below + std::log(density(begins) / density(T)), 3e-7) << T;
}

TEST_IN_2D_AND_3D("melt that is warmer rises, and ice does not") {
    set_threads(1);
    std::string expanding = stirred(D, "heat = { pressure = 1e5, lift = 10.0 }\n");
    expanding.replace(expanding.find("conductivity = 0.6"), 18, "conductivity = 0.6, expansion = 3e-4");
    std::string beta = stirred(D);
    const std::string effect = ", buoyancy = { beta = 3e-3, ambient = 300.0 }";
    expanding.erase(expanding.find(effect), effect.size());
    FlowSolver<D> a((test::mac_scene(expanding))), b((test::mac_scene(beta)));
    for (int i = 0; i < 10; ++i) a.step(0.02), b.step(0.02);
    real most = 0, apart = 0;
    for_each_cell(a.state().u[1].extent(), [&](const Index<D>& I) {
        most = std::max(most, std::abs(b.state().u[1](I)));
        apart = std::max(apart, std::abs(a.state().u[1](I) - b.state().u[1](I)));
    });
    EXPECT_GT(most, 1e-4);
    EXPECT_LT(apart, 0.01 * most);  // in ice, where beta lifts what is colder than 300 K as well, the drag holds both
}

TEST_IN_2D_AND_3D("a warm cell warms its neighbours and no cell leaves the range of temperatures, whatever the step") {
    set_threads(1);
    const thermo::Melting m{.T = 100, .h_liquid = 10, .c_solid = 1, .c_liquid = 1, .k_solid = 1, .k_liquid = 1};
    const Extent<D> n(Index<D>::constant(17));
    const Grid<poisson::Cell, D> cells(n, poisson::Cell::fluid);
    const Grid<real, D> none;
    for (const real fourier : {0.1, 0.3, 0.5, 1.0, 3.0, 30.0}) {
        Conduction<D> conduction(m, n, Vec<D>::constant(1), 1, {});
        Grid<real, D> h(n, m.enthalpy(300));
        h(Index<D>::constant(8)) = m.enthalpy(400);
        EXPECT_EQ(conduction.step(h, {cells, false, none}, fourier), 0);
        real lowest = infinity;
        for (const real value : h.values()) lowest = std::min(lowest, m.temperature(value));
        EXPECT_GT(lowest, 300 - 1e-10) << fourier;
        EXPECT_LT(m.temperature(h(Index<D>::constant(8))), 400) << fourier;
    }
}

TEST("a step of many stages has an eighth of z^2 for its error, z = -(pi/L)^2 alpha dt") {
    set_threads(1);
    const thermo::Melting m{.T = 100, .h_liquid = 10, .c_solid = 1, .c_liquid = 1, .k_solid = 1, .k_liquid = 1};
    const Extent<2> n(Index<2>{64, 1});
    const Grid<poisson::Cell, 2> cells(n, poisson::Cell::fluid);
    const Grid<real, 2> none;
    Conduction<2> conduction(m, n, {1.0, 1.0}, 1, {});
    Grid<real, 2> h(n);
    const real pi = std::numbers::pi, wave = std::sin(pi / 128) * 2;
    const auto shape = [&](int i) { return std::cos(pi * (i + 0.5) / 64); };
    for (int i = 0; i < 64; ++i) h({i, 0}) = m.enthalpy(300 + shape(i));
    const real dt = 60, z = -wave * wave * dt;  // 19 stages
    conduction.step(h, {cells, false, none}, dt);
    // Of s stages the coefficient of z^2 is 3/8 (1 - 4/(s (s + 5)) ...) by (s - 1)(s + 6)/(s (s + 5)) of 3/8.
    const real s = 19, expected = 1 + z + 3.0 / 8 * z * z * ((s - 1) * (s + 6)) / (s * (s + 5));
    for (int i = 0; i < 64; ++i) EXPECT_NEAR((m.temperature(h({i, 0})) - 300) / shape(i), expected, std::abs(z * z * z) / 6) << i;
}

namespace {

/// A step of conduction in `stages` stages as the formula has it, cell by cell, in a box without solids.
template <int D>
void plain_conduction(const thermo::Melting& m, const Vec<D>& h, real rho, const mac::Boundary<D>& boundary,
                      const Grid<poisson::Cell, D>& cells, const Grid<real, D>& source, real dt, int stages, Grid<real, D>& H) {
    using Kind = mac::EndRule::Kind;
    const Extent<D> n = H.extent();
    const auto conductivity = [&](real at) {
        const real f = m.liquid(at);
        return std::pair{m.conductivity(f), f > 0 && f < 1};
    };
    const Grid<real, D> start = H;
    const auto rate = [&](const Grid<real, D>& at, const Index<D>& I) {
        real sum = source.empty() ? 0 : source(I);
        const auto [k, mixed] = conductivity(start(I));
        for (int a = 0; a < D; ++a)
            for (int end = 0; end < 2; ++end) {
                Index<D> J = I;
                J[a] += end == 0 ? -1 : 1;
                const auto& rule = boundary.end[static_cast<std::size_t>(a)][static_cast<std::size_t>(end)];
                real g = k, beyond = 0;
                if (J[a] >= 0 && J[a] < n[a])
                    beyond = m.temperature(at(J));
                else if (rule.kind == Kind::periodic)
                    J[a] = (J[a] + n[a]) % n[a], beyond = m.temperature(at(J));
                else if (rule.kind == Kind::dirichlet)
                    J = I, beyond = 2 * rule.value - m.temperature(at(I));
                else
                    continue;
                if (cells(J) != poisson::Cell::fluid) continue;
                const auto [other, other_mixed] = conductivity(start(J));
                g = mixed == other_mixed ? 2 * k * other / (k + other) : mixed ? other : k;
                sum += g / (h[a] * h[a]) * (beyond - m.temperature(at(I)));
            }
        return sum;
    };
    Grid<real, D> now(n), older(n);
    for (int j = 1; j <= stages; ++j) {
        Grid<real, D> at = start, next(n);
        for_each_cell(n, [&](const Index<D>& I) { at(I) += now(I); });
        for_each_cell(n, [&](const Index<D>& I) {
            if (cells(I) != poisson::Cell::fluid) return;
            const real w = 6.0 / (stages * (stages + 5));
            next(I) = (2.0 * j + 3) / (j + 4) * (now(I) + w * dt / rho * rate(at, I)) - (j - 1.0) / (j + 4) * older(I);
        });
        older = now, now = next;
    }
    for_each_cell(n, [&](const Index<D>& I) { H(I) += now(I); });
}

}  // namespace

TEST_IN_2D_AND_3D("conduction in passes of several stages, by rows and by planes, is the formula's cell by cell") {
    using Kind = mac::EndRule::Kind;
    const thermo::Melting m{.T = 300, .h_liquid = 3000, .c_solid = 2, .c_liquid = 4, .k_solid = 2.2, .k_liquid = 0.6};
    Extent<D> n(Index<D>::constant(5));
    n[0] = 150, n[D - 1] = 31;  // more than a block of a row; slabs of planes for two threads
    Vec<D> h = Vec<D>::constant(1);
    h[1] = 0.5;
    std::mt19937 random(5);
    std::uniform_real_distribution<real> unit(0, 1);
    for (const Kind last : {Kind::dirichlet, Kind::neumann, Kind::periodic})
        for (const char* what : {"liquid", "melting", "melting, solids and a source"})
            for (const int stages : {1, 2, 14}) {
                const bool liquid = what == std::string("liquid"), solids = !liquid && what != std::string("melting");
                mac::Boundary<D> boundary;
                boundary.end[D - 1] = {mac::EndRule{last, 330, {}}, mac::EndRule{last, 310, {}}};
                boundary.end[0][1] = {Kind::dirichlet, 320, {}};
                Grid<poisson::Cell, D> cells(n, poisson::Cell::fluid);
                Grid<real, D> H(n), source;
                if (solids) source = Grid<real, D>(n);
                for_each_cell(n, [&](const Index<D>& I) {
                    const bool frozen = !liquid && I[0] > 60 && I[1] < 4;
                    H(I) = m.enthalpy(frozen ? 280 + 10 * unit(random) : 305 + 20 * unit(random));
                    if (frozen && I[0] < 63) H(I) = 3000 * unit(random);
                    if (solids && I[0] % 50 == 40) cells(I) = poisson::Cell::solid;
                    if (solids && cells(I) == poisson::Cell::fluid) source(I) = unit(random) - 0.3;
                });
                real most = 0;  // as much as a step of so many stages may conduct
                for (int a = 0; a < D; ++a) most += 2 * 2.2 / (h[a] * h[a]);
                const real dt = 0.99 * stages * (stages + 5) / 6.0 * 2 * 1.5 / most * (liquid ? 2 * 2.2 / 0.6 : 1);
                Grid<real, D> plain = H;
                std::array<Grid<real, D>, 2> fast{H, H};
                std::array<real, 2> added{};
                for (const int team : {1, 2}) {
                    set_threads(team);
                    Conduction<D> conduction(m, n, h, 1.5, boundary);
                    // one stage for steps that need one, and as many as there must be for those that need more
                    added[static_cast<std::size_t>(team - 1)] =
                        stages == 1 ? conduction.euler_step(fast[static_cast<std::size_t>(team - 1)], {cells, false, source}, dt)
                                    : conduction.step(fast[static_cast<std::size_t>(team - 1)], {cells, false, source}, dt);
                }
                set_threads(1);
                int taken = 1;  // stages of step(): by the theory in conduction.cpp
                if (stages > 1) {
                    real fastest = 0;
                    for_each_cell(n, [&](const Index<D>& I) {
                        real out = 0;
                        for (int a = 0; a < D; ++a)
                            for (const int by : {-1, 1}) {
                                Index<D> J = I;
                                J[a] += by;
                                const bool inside = J[a] >= 0 && J[a] < n[a];
                                if (!inside && boundary.end[static_cast<std::size_t>(a)][0].kind == Kind::periodic)
                                    J[a] = (J[a] + n[a]) % n[a];
                                else if (!inside)
                                    J = I;
                                if (cells(I) != poisson::Cell::fluid || cells(J) != poisson::Cell::fluid) continue;
                                const auto k = [&](const Index<D>& K) { return m.conductivity(m.liquid(H(K))); };
                                const auto mixed = [&](const Index<D>& K) { return m.liquid(H(K)) > 0 && m.liquid(H(K)) < 1; };
                                const real g = mixed(I) == mixed(J) ? 2 * k(I) * k(J) / (k(I) + k(J)) : mixed(I) ? k(J) : k(I);
                                out += g / (h[a] * h[a]);
                            }
                        fastest = std::max(fastest, out);
                    });
                    const real euler = dt * fastest / (1.5 * (liquid ? 4 : 2));
                    taken = std::max(1, static_cast<int>(std::ceil((std::sqrt(25 + 24 * euler) - 5) / 2)));
                    EXPECT_GT(taken, 1);
                }
                plain_conduction(m, h, 1.5, boundary, cells, source, dt, taken, plain);
                real change = 0;
                for (std::size_t c = 0; c < plain.size(); ++c) change = std::max(change, std::abs(plain[c] - H[c]));
                EXPECT_GT(change, 1);
                const auto where = std::string(what) + ", " + std::to_string(taken) + " stages";
                for (std::size_t c = 0; c < plain.size(); ++c) {
                    ASSERT_NEAR(fast[0][c], plain[c], 1e-12 * 3200 * taken) << where;  // some roundings of H a stage
                    ASSERT_EQ(fast[0][c], fast[1][c]) << where;
                }
                real grown = 0;
                for (std::size_t c = 0; c < plain.size(); ++c) grown += fast[0][c] - H[c];
                real volume = 1.5;
                for (int a = 0; a < D; ++a) volume *= h[a];
                EXPECT_NEAR(added[0], volume * grown, 1e-13 * 3200 * static_cast<real>(plain.size())) << where;
                EXPECT_EQ(added[0], added[1]) << where;
            }
}

TEST_IN_2D_AND_3D("the same bits with one and with three threads, and after a restart") {
    const auto scene = test::mac_scene(stirred(D));
    set_threads(1);
    FlowSolver<D> one(scene), restarted(scene);
    for (int i = 0; i < 2; ++i) one.step(0.02);
    Checkpoint checkpoint;
    one.save(checkpoint);
    restarted.restore(checkpoint);
    for (int i = 0; i < 2; ++i) one.step(0.02), restarted.step(0.02);
    set_threads(3);
    FlowSolver<D> three(scene);
    for (int i = 0; i < 4; ++i) three.step(0.02);
    set_threads(1);
    EXPECT_TRUE(test::same_bits(one, three));
    EXPECT_TRUE(test::same_bits(one, restarted));
    EXPECT_EQ(integral_of(one, "heat_added"), integral_of(restarted, "heat_added"));
}

namespace {

/// A slab of the substance's liquid, one metre long and of 8 cells.
std::string slab(const std::string& more) {
    return "solver = \"mac\"\ndim = 2\ngrid = { cells = [8, 2], size = [1.0, 0.25] }\ntime = { end = 1e9 }\nfluid = { density = 1000.0 }\n"
           "initial = { temperature = { name = \"constant\", value = 310.0 } }\n" +
           more + wax;
}

}  // namespace

TEST("a temperature starts from a formula of the place") {
    set_threads(1);
    auto text = slab("");
    const std::string constant = "{ name = \"constant\", value = 310.0 }";
    text.replace(text.find(constant), constant.size(), "{ name = \"formula\", value = \"310 + 8*x - y^2\" }");
    FlowSolver<2> flow(test::mac_scene(text));
    const auto& T = *flow.state().find("temperature");
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 2; ++j) {
            const real x = (i + 0.5) / 8, y = (j + 0.5) / 8;
            EXPECT_NEAR(T({i, j}), 310 + 8 * x - y * y, 1e-9);
        }
}

TEST("a wall that exchanges heat and the slab behind it resist one after the other") {
    set_threads(1);
    FlowSolver<2> flow(
        test::mac_scene(slab("sides = { x_min = { kind = \"wall\", exchange = 2.0 }, x_max = { kind = \"wall\", temperature = 310.0 } }\n"
                             "heat = { pressure = 1e5, ambient = { temperature = 330.0 } }\n")));
    for (int i = 0; i < 40; ++i) flow.step(4e6);  // L^2 rho c/k = 6.7e6 s
    const real flux = 20 / (1 / 2.0 + 1 / 0.6);
    const auto& T = *flow.state().find("temperature");
    for (int i = 0; i < 8; ++i) EXPECT_NEAR(T({i, 0}), 310 + flux * (1 - (i + 0.5) / 8) / 0.6, 1e-9) << i;
    const real before = integral_of(flow, "heat_added");
    flow.step(1000);
    EXPECT_NEAR(integral_of(flow, "heat_added"), before, 1e-6);  // as much leaves as comes
}

TEST("surroundings follow their keyframes, and a step ends at each") {
    set_threads(1);
    FlowSolver<2> flow(
        test::mac_scene(slab("sides.x_min = { kind = \"wall\", exchange = 1e-3 }\n"
                             "heat = { pressure = 1e5, ambient = { keyframes = [ { t = 10.0, temperature = 300.0 }, { t = 30.0, "
                             "temperature = 400.0 } ] } }\n")));
    const real passes = 1 / (1 / 1e-3 + 0.0625 / 0.6);  // the exchange and half a cell
    EXPECT_EQ(flow.advised_dt(), 10);
    flow.step(10);
    EXPECT_NEAR(integral_of(flow, "heat_added"), passes * 0.25 * 10 * -10, 1e-6);
    EXPECT_NEAR(flow.advised_dt(), 20, 1e-9);
    flow.step(20);  // 350 K in the mean
    EXPECT_NEAR(integral_of(flow, "heat_added"), passes * 0.25 * (-100 + 20 * 40), 1e-5);
    flow.step(10);
    EXPECT_NEAR(integral_of(flow, "heat_added"), passes * 0.25 * (-100 + 800 + 10 * 90), 1e-5);
}

TEST("ice melts under pressure, and takes the heat for it from itself") {
    set_threads(1);
    FlowSolver<2> flow(test::mac_scene(
        "solver = \"mac\"\ndim = 2\ngrid = { cells = [4, 4], size = [1.0, 1.0] }\ntime = { end = 1.0 }\nfluid = { density = 1000.0 }\n"
        "substance = \"water\"\ninitial = { temperature = { name = \"constant\", value = 272.9 } }\n"
        "heat = { ambient = { keyframes = [ { t = 0.0, pressure = 1e5 }, { t = 1.0, pressure = 2e7 } ] } }\n"));
    EXPECT_EQ(integral_of(flow, "liquid_volume"), 0);
    const real heat = integral_of(flow, "heat");
    flow.step(1);
    const auto curve = thermo::water()->heat_curve(2e7);
    EXPECT_NEAR((*flow.state().find("temperature"))({1, 1}), curve.begins_at(1), 1e-9);
    EXPECT_GT(integral_of(flow, "liquid_volume"), 0.005);  // 1.2 K of ice's heat capacity over the heat of fusion: 0.8%
    EXPECT_LT(integral_of(flow, "liquid_volume"), 0.01);
    EXPECT_EQ(integral_of(flow, "heat"), heat);
}

TEST("without a substance no face has a mobility and no field is derived") {
    FlowSolver<2> flow(test::mac_scene(test::unit_box(2, 8, "effects = { buoyancy = { beta = 0.1 } }\n")));
    EXPECT_TRUE(flow.state().mobility[0].empty());
    for (const auto& field : flow.state().fields) EXPECT_FALSE(field.derived);
}

}  // namespace weir::smoke::heat_tests
