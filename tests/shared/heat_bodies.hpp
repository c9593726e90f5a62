// What is true on every backend of particles that carry heat. A file that includes this says first, in namespace weir::test: `backend` (as
// a scene names it), Sph<D> and Pbf<D> (types of solvers) and missing() (why this machine cannot run them; empty where it can).
#pragma once
#include "pbf/reference_solver.hpp"
#include "pbf/solver.hpp"
#include "shared/needs_backend.hpp"
#include "shared/sph_reference.hpp"
#include "thermo/scene_substance.hpp"

namespace weir::test {
namespace {  // every file that includes this has its own

/// Ice and water that conduct so well that a step of 2 ms moves heat, in a box of 8 x 12 [x 8] spacings of 1/8 m.
template <int D>
scene::Scene heat_scene(const std::string& solver, const std::string& on, const std::string& more, const std::string& scheme = "") {
    const std::string text = fmt::format(
        "solver = \"{}\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime = {{ end = 10.0, dt = 0.002 }}\nfluid.density = "
        "1000.0\nliquid = [{{ shape = \"box\", min = {}, max = {} }}]\nscheme = {{ backend = \"{}\"{} }}\n"
        "substance = {{ name = \"own\", triple = [300.0, 1000.0], critical = [800.0, 5e6], fusion = 3e4, vaporisation = 2e6, solid = {{ "
        "density = 1000.0, heat_capacity = 2000.0, conductivity = 2e6 }}, liquid = {{ density = 1000.0, heat_capacity = 4000.0, "
        "conductivity = 1e6 }}, vapour = {{ heat_capacity = 2000.0, conductivity = 1e5 }} }}\n"
        "initial.temperature = {{ name = \"linear\", value = 300.0, gradient = {}, at = {} }}\n{}\n",
        solver, D, D == 2 ? "[8, 12]" : "[8, 12, 8]", D == 2 ? "[1, 1.5]" : "[1, 1.5, 1]", D == 2 ? "[0, 0]" : "[0, 0, 0]",
        D == 2 ? "[1, 1]" : "[1, 1, 1]", on, scheme.empty() ? "" : ", " + scheme, list<D>(20, 30, 10), list<D>(0.5, 0.5, 0.5), more);
    return scene::parse(text, "test.toml", {sph::kind().schema, pbf::kind().schema});
}

/// What may stand around it: nothing, walls at temperatures and with a flux and a heater, sides that repeat and a wall to surroundings.
template <int D>
std::vector<std::string> warm_places() {
    const std::string heater = fmt::format(
        "heaters = [ {{ shape = \"sphere\", centre = {}, radius = 0.3, power = 1e8, start = 0.001 }} ]\n", list<D>(0.5, 0.4, 0.5));
    return {"",
            "sides.x_min = { kind = \"wall\", temperature = 330.0 }\nsides.y_min = { kind = \"wall\", temperature = 280.0 }\n"
            "sides.x_max = { kind = \"wall\", heat_flux = 1e8 }\n" +
                heater,
            "sides.x_min = \"periodic\"\nsides.x_max = \"periodic\"\nsides.y_min = { kind = \"wall\", exchange = 1e7 }\nheat.ambient = { "
            "keyframes = [ { t = 0.0, temperature = 320.0 }, { t = 0.002, temperature = 310.0 } ] }\n"};
}

/// Each kernel and each place, not all of both: a device compiles a program for each.
template <int D, class Run>
void on_both(Run&& run) {
    const auto places = warm_places<D>();
    const std::pair<const char*, std::string> scenes[] = {
        {"muller", places[1]}, {"cubic", places[1]}, {"cubic", places[2]}, {"wendland", places[0]}};
    for (const auto& [kernel, place] : scenes) {
        const std::string scheme = fmt::format("kernel = \"{}\", support = 2.0", kernel);
        run(std::type_identity<Sph<D>>{}, std::type_identity<sph::ReferenceSphSolver<D>>{}, "sph", place,
            scheme + ", density = \"summation\"");
        run(std::type_identity<Pbf<D>>{}, std::type_identity<pbf::ReferencePbfSolver<D>>{}, "pbf", place,
            scheme + ", settle = 0");  // what it leaves is known to 1e-4
    }
}

real sum_of(const std::string& name, const Solver& solver) {
    for (const auto& i : solver.integrals())
        if (i.name == name) return i.value;
    return not_applicable;
}

}  // namespace
}  // namespace weir::test

using namespace weir;
using particles::Fluid;

TEST_IN_2D_AND_3D("a step of heat agrees with the double reference to 1e-5 of what it moves, in every place and with every kernel") {
    NEEDS_BACKEND;
    test::on_both<D>([&](auto here, auto there, const char* name, const std::string& place, const std::string& scheme) {
        typename decltype(here)::type solver(test::heat_scene<D>(name, test::backend, place, scheme));
        typename decltype(there)::type reference(test::heat_scene<D>(name, "reference", place, scheme));
        test::shake(solver.fluid(), 0.1), test::shake(reference.fluid(), 0.1);
        const std::vector<real> before = reference.fluid().enthalpy;
        solver.step(0.002), reference.step(0.002);
        const Fluid<D>& a = solver.fluid();
        const Fluid<D>& b = reference.fluid();
        real moved = 0, worst = 0;
        for (std::size_t i = 0; i < before.size(); ++i) {
            moved = std::max(moved, std::abs(b.enthalpy[i] - before[i]));
            worst = std::max(worst, std::abs(a.enthalpy[i] - b.enthalpy[i]));
        }
        EXPECT_GT(moved, 1000) << name << place;  // 1/4 K at least
        // 6e-8 in each position, which makes 1e-6 of the distance of a near pair and so of a term; and in each temperature over those
        // between
        EXPECT_LE(worst, 2e-5 * moved) << name << " " << scheme << " " << place;
        EXPECT_NEAR(test::sum_of("heat_added", solver), test::sum_of("heat_added", reference), 1e-5 * moved * b.mass * b.count());
    });
}

TEST_IN_2D_AND_3D("no heat is lost: what is there is what was there and was added, to round-off; over a seam to single precision") {
    NEEDS_BACKEND;
    test::on_both<D>([&](auto here, auto, const char* name, const std::string& place, const std::string& scheme) {
        typename decltype(here)::type solver(test::heat_scene<D>(name, test::backend, place, scheme));
        test::shake(solver.fluid(), 0.1);
        const real before = test::sum_of("heat", solver);
        real size = 0;
        for (const real h : solver.fluid().enthalpy) size += solver.fluid().mass * std::abs(h);
        for (int s = 0; s < 10; ++s) solver.step(0.002);
        const real after = test::sum_of("heat", solver), added = test::sum_of("heat_added", solver);
        const bool seam = place.find("periodic") != std::string::npos;
        // both ends of a pair get the same bits with the other sign, but over a seam, where one of them stands at a rounded place
        EXPECT_NEAR(after - added, before, (seam ? 1e-6 : 1e-13) * (size + std::abs(added))) << name << " " << scheme << " " << place;
        EXPECT_TRUE(place.empty() || std::abs(added) > 1e-3 * size) << name << place;
    });
}

TEST_IN_2D_AND_3D("no particle becomes warmer than the warmest or colder than the coldest, wherever particles stand") {
    NEEDS_BACKEND;
    test::on_both<D>([&](auto here, auto, const char* name, const std::string& place, const std::string& scheme) {
        if (place.find("flux") != std::string::npos) return;
        typename decltype(here)::type solver(test::heat_scene<D>(name, test::backend, place, scheme));
        test::shake(solver.fluid(), 0.3);
        const auto ends = [&] {
            const auto& h = solver.fluid().enthalpy;
            return std::pair{*std::min_element(h.begin(), h.end()), *std::max_element(h.begin(), h.end())};
        };
        const auto [cold, warm] = ends();
        for (int s = 0; s < 10; ++s) {
            solver.step(0.002);
            const auto [c, w] = ends();
            EXPECT_GE(c, cold - 1e-6 * std::abs(cold)) << name << scheme;  // of temperatures in single precision
            EXPECT_LE(w, warm + 1e-6 * std::abs(warm)) << name << scheme;
        }
    });
}

TEST_IN_2D_AND_3D("a run with heat repeats to the last bit, through a change of order and a restart") {
    NEEDS_BACKEND;
    test::on_both<D>([&](auto here, auto, const char* name, const std::string& place, const std::string& scheme) {
        if (scheme.find("cubic") == std::string::npos) return;
        using S = typename decltype(here)::type;
        const auto solver = [&] {
            auto s = std::make_unique<S>(test::heat_scene<D>(name, test::backend, place, scheme));
            test::shake(s->fluid(), 0.1);
            return s;
        };
        auto through = solver(), first = solver(), second = solver();
        for (int s = 0; s < 20; ++s) through->step(0.001);
        for (int s = 0; s < 13; ++s) first->step(0.001);
        Checkpoint saved;
        first->save(saved);
        second->restore(saved);
        for (int s = 13; s < 20; ++s) second->step(0.001);
        EXPECT_EQ(through->fluid().enthalpy, second->fluid().enthalpy) << name << place;
        EXPECT_EQ(test::sum_of("heat_added", *through), test::sum_of("heat_added", *second)) << name << place;
    });
}

TEST_IN_2D_AND_3D("what is frozen stays where it is to the bit and the rest moves; the reference holds the same particles") {
    NEEDS_BACKEND;
    const std::string falls = "effects.gravity.g = " + test::list<D>(3, -9.81, 0) + "\n";
    const auto run = [&](auto here, auto there, const char* name, const std::string& scheme) {
        typename decltype(here)::type solver(test::heat_scene<D>(name, test::backend, falls, scheme));
        typename decltype(there)::type reference(test::heat_scene<D>(name, "reference", falls, scheme));
        test::shake(solver.fluid(), 0.1), test::shake(reference.fluid(), 0.1);
        const Fluid<D> before = reference.fluid();
        solver.step(0.002), reference.step(0.002);
        const Fluid<D>& a = solver.fluid();
        const Fluid<D>& b = reference.fluid();
        int held = 0, moved = 0;
        for (int i = 0; i < before.count(); ++i) {
            const bool frozen = before.enthalpy[static_cast<std::size_t>(i)] < -15000;  // half of the latent heat below the liquid at 300 K
            EXPECT_LE(norm(a.position(i) - b.position(i)), 2e-5) << name;
            EXPECT_EQ(frozen, a.position(i) == before.position(i)) << name;
            ++(frozen ? held : moved);
        }
        EXPECT_GT(held, before.count() / 10);
        EXPECT_GT(moved, before.count() / 10);
        EXPECT_NE(solver.concern().find("frozen"), std::string::npos) << name;
    };
    run(std::type_identity<test::Sph<D>>{}, std::type_identity<sph::ReferenceSphSolver<D>>{}, "sph",
        "kernel = \"cubic\", support = 2.0, density = \"summation\"");
    run(std::type_identity<test::Pbf<D>>{}, std::type_identity<pbf::ReferencePbfSolver<D>>{}, "pbf",
        "kernel = \"cubic\", support = 2.0, settle = 0");
}

TEST("an emitter lets in particles of its temperature, on every backend") {
    NEEDS_BACKEND;
    const std::string jet =
        "effects.gravity.g = [0, -9.81]\nemitters = [ { shape = \"box\", min = [0.1, 1.15], max = [0.2, 1.4], velocity = [8, 0], "
        "temperature = 310.0 } ]\n";
    for (const char* name : {"sph", "pbf"}) {
        const auto scene = test::heat_scene<2>(name, test::backend, jet);
        std::unique_ptr<Solver> solver;
        if (std::string(name) == "sph")
            solver = std::make_unique<test::Sph<2>>(scene);
        else
            solver = std::make_unique<test::Pbf<2>>(scene);
        const auto before = test::sum_of("particles", *solver);
        solver->step(0.002);
        const auto set = solver->fields();
        const auto& T = set.find("temperature")->data[0];
        const auto& id = set.find("id")->data[0];
        int born = 0;
        for (std::size_t i = 0; i < T.size(); ++i)
            if (id[i] >= before) {
                EXPECT_NEAR(T[i], 310, 0.1);  // one step of conduction is over
                ++born;
            }
        EXPECT_EQ(born, 2) << name;
    }
}

namespace weir::test {
namespace {

/// A block that boils: enthalpies that rise with the height of a scene of heat_scene(), from the warm liquid at its bottom to half vapour.
template <int D>
void heat_through(Fluid<D>& fluid, real lowest, real highest) {
    for (int i = 0; i < fluid.count(); ++i)
        fluid.enthalpy[static_cast<std::size_t>(i)] = lowest + (highest - lowest) * fluid.position(i)[1];
}

template <int D, class Run>
void on_both_boiling(Run&& run) {
    const std::string place = "heat.vapour = { name = \"own\", density = 400.0 }\neffects.gravity.g = " + list<D>(0, -9.81, 0) +
                              "\nsides.x_min = { kind = \"wall\", temperature = 600.0 }\n";
    const std::string scheme = "kernel = \"cubic\", support = 3.0";
    run(std::type_identity<Sph<D>>{}, std::type_identity<sph::ReferenceSphSolver<D>>{}, "sph", place, scheme + ", density = \"summation\"");
    run(std::type_identity<Pbf<D>>{}, std::type_identity<pbf::ReferencePbfSolver<D>>{}, "pbf", place, scheme + ", settle = 0");
}

}  // namespace
}  // namespace weir::test

TEST_IN_2D_AND_3D("a step of a liquid that boils agrees with the double reference, in its places and in its heat") {
    NEEDS_BACKEND;
    test::on_both_boiling<D>([&](auto here, auto there, const char* name, const std::string& place, const std::string& scheme) {
        typename decltype(here)::type solver(test::heat_scene<D>(name, test::backend, place, scheme));
        typename decltype(there)::type reference(test::heat_scene<D>(name, "reference", place, scheme));
        for (Fluid<D>* fluid : {&solver.fluid(), &reference.fluid()}) test::shake(*fluid, 0.1), test::heat_through(*fluid, 4e5, 2e6);
        const Fluid<D> before = reference.fluid();
        const auto left = solver.step(0.0005), wanted = reference.step(0.0005);
        EXPECT_NEAR(left.max_density_error, wanted.max_density_error, 1e-5 * (1 + wanted.max_density_error)) << name;
        const Fluid<D>& a = solver.fluid();
        const Fluid<D>& b = reference.fluid();
        real moved = 0, apart = 0, warmed = 0, worst = 0;
        for (int i = 0; i < before.count(); ++i) {
            const auto at = static_cast<std::size_t>(i);
            moved = std::max(moved, norm(b.position(i) - before.position(i)));
            apart = std::max(apart, norm(a.position(i) - b.position(i)));
            warmed = std::max(warmed, std::abs(b.enthalpy[at] - before.enthalpy[at]));
            worst = std::max(worst, std::abs(a.enthalpy[at] - b.enthalpy[at]));
        }
        EXPECT_GT(moved, 1e-4) << name;  // what boils drives apart
        EXPECT_GT(warmed, 100) << name;
        EXPECT_LE(apart, 1e-3 * moved) << name;  // single precision's 6e-8 of sums of some 30 terms that are up to 100 times their sum
        EXPECT_LE(worst, 1e-4 * warmed) << name;
        EXPECT_NEAR(test::sum_of("vapour_mass", solver), test::sum_of("vapour_mass", reference), 1e-5 * b.mass * b.count()) << name;
        EXPECT_GT(test::sum_of("vapour_mass", solver), 0.1 * b.mass * b.count()) << name;
        EXPECT_NE(solver.concern().find("not the physical one"), std::string::npos) << name;
    });
}

TEST_IN_2D_AND_3D("a liquid that boils keeps its heat to round-off, and goes on from a checkpoint to the last bit") {
    NEEDS_BACKEND;
    test::on_both_boiling<D>([&](auto here, auto, const char* name, const std::string& place, const std::string& scheme) {
        using S = typename decltype(here)::type;
        const auto solver = [&] {
            auto s = std::make_unique<S>(test::heat_scene<D>(name, test::backend, place, scheme));
            test::shake(s->fluid(), 0.1), test::heat_through(s->fluid(), 4e5, 2e6);
            return s;
        };
        auto through = solver(), first = solver(), second = solver();
        const real before = test::sum_of("heat", *through);
        for (int s = 0; s < 20; ++s) through->step(0.0005);
        EXPECT_NEAR(test::sum_of("heat", *through) - test::sum_of("heat_added", *through), before, 1e-13 * std::abs(before)) << name;
        for (int s = 0; s < 13; ++s) first->step(0.0005);
        Checkpoint saved;
        first->save(saved);
        second->restore(saved);
        for (int s = 13; s < 20; ++s) second->step(0.0005);
        EXPECT_EQ(through->fluid().enthalpy, second->fluid().enthalpy) << name;
        EXPECT_EQ(through->fluid().x, second->fluid().x) << name;
    });
}

/// What a thousand times as much heat than moves in a step would do to the order of temperatures is seen in ten steps.
TEST_IN_2D_AND_3D("what boils becomes no warmer than the warmest and no colder than the coldest, at any depth") {
    NEEDS_BACKEND;
    test::on_both_boiling<D>([&](auto here, auto, const char* name, const std::string& place, const std::string& scheme) {
        typename decltype(here)::type solver(test::heat_scene<D>(name, test::backend, place, scheme));
        test::shake(solver.fluid(), 0.1), test::heat_through(solver.fluid(), 1e5, 3e6);
        const auto ends = [&] {
            const auto set = solver.fields();
            const auto& T = set.find("temperature")->data[0];
            return std::pair{*std::min_element(T.begin(), T.end()), *std::max_element(T.begin(), T.end())};
        };
        const auto [cold, warm] = ends();
        EXPECT_GT(warm, cold + 100) << name;
        for (int s = 0; s < 10; ++s) {
            solver.step(0.0005);
            const auto [c, w] = ends();
            EXPECT_GE(c, cold - 1e-5 * cold) << name;  // of thetas in single precision, over the conductivities' ratio
            EXPECT_LE(w, std::max(warm, 600.0) * (1 + 1e-5)) << name;
        }
    });
}

/// Nothing but the pressure changes: what is warmer than it boils at becomes vapour, by as much as its surplus of heat pays for.
TEST_IN_2D_AND_3D("where the pressure of the surroundings falls, a liquid boils at that of the moment") {
    NEEDS_BACKEND;
    test::on_both_boiling<D>([&](auto here, auto there, const char* name, const std::string&, const std::string& scheme) {
        const std::string place = "heat.vapour = { name = \"own\", density = 400.0 }\neffects.gravity.g = " + test::list<D>(0, -9.81, 0) +
                                  "\nheat.ambient.keyframes = [ { t = 0.001, pressure = 100000.0 }, { t = 0.003, pressure = 20000.0 } ]\n";
        const auto scene = test::heat_scene<D>(name, test::backend, place, scheme);
        typename decltype(here)::type solver(scene);
        typename decltype(there)::type reference(test::heat_scene<D>(name, "reference", place, scheme));
        const auto substance = thermo::substance_of(scene);
        const auto boils = [&](real p) { return substance->temperature(thermo::Boundary::saturation, p); };
        const particles::Heat<D> heat(scene, solver.fluid().domain);
        const real warm = boils(60000), h = heat.start_enthalpy(warm);
        for (Fluid<D>* fluid : {&solver.fluid(), &reference.fluid()}) std::fill(fluid->enthalpy.begin(), fluid->enthalpy.end(), h);
        for (int s = 0; s < 3; ++s) solver.step(0.0005), reference.step(0.0005);
        EXPECT_EQ(test::sum_of("vapour_mass", solver), 0) << name;  // 80 kPa
        for (int s = 0; s < 4; ++s) solver.step(0.0005), reference.step(0.0005);
        // Under no depth and under twice the water's: the block may be pressed together.
        const real least = boils(20000), most = boils(20000 + 1000 * 9.81 * 2),
                   latent = heat.states().vapour_begin - heat.states().liquid_end;
        const Fluid<D>& fluid = solver.fluid();
        const auto set = solver.fields();
        for (const real T : set.find("temperature")->data[0]) {
            EXPECT_GE(T, least - 1e-6) << name;
            EXPECT_LE(T, most + 1e-6) << name;
        }
        const real mass = fluid.mass * fluid.count();
        EXPECT_LE(test::sum_of("vapour_mass", solver), 4000 * (warm - least) / latent * mass) << name;
        EXPECT_GE(test::sum_of("vapour_mass", solver), 4000 * (warm - most) / latent * mass) << name;
        EXPECT_NEAR(test::sum_of("vapour_mass", solver), test::sum_of("vapour_mass", reference), 1e-4 * mass) << name;  // depths as cells
        EXPECT_NEAR(test::sum_of("heat", solver), mass * h, 1e-13 * std::abs(mass * h)) << name;
    });
}
