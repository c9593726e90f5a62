// What is true on every backend of ice that moves among particles. A file that includes this says first what heat_bodies.hpp asks for.
#pragma once
#include "pbf/reference_solver.hpp"
#include "pbf/solver.hpp"
#include "shared/needs_backend.hpp"
#include "shared/sph_reference.hpp"

namespace weir::test {
namespace {  // every file that includes this has its own

/// A box of 12 x 16 [x 12] spacings of 1/8 m with the liquid and the places of ice (a formula) given. Nothing conducts.
template <int D>
scene::Scene ice_scene(const std::string& solver, const std::string& on, const std::string& liquid, const std::string& ice,
                       const std::string& more = "", const std::string& of_pbf = "") {
    const std::string scheme = solver == "sph" ? "sound_speed = 30.0" : "iterations = 4" + of_pbf;
    const std::string text = fmt::format(
        "solver = \"{}\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime = {{ end = 10.0, max_dt = 0.001 }}\nfluid.density = 1000.0\n"
        "liquid = [{}]\nscheme = {{ backend = \"{}\", kernel = \"wendland\", support = 3.0, {} }}\n"
        "substance = {{ name = \"own\", triple = [300.0, 1000.0], critical = [800.0, 5e6], fusion = 3e4, vaporisation = 2e6, solid = {{ "
        "density = 917.0, heat_capacity = 2000.0, conductivity = 0.0 }}, liquid = {{ density = 1000.0, heat_capacity = 4000.0, "
        "conductivity = 0.0 }}, vapour = {{ heat_capacity = 2000.0 }} }}\n"
        "heat.frozen = \"free\"\ninitial.temperature = {{ name = \"formula\", value = \"310 - 20 * ({})\" }}\n{}\n",
        solver, D, D == 2 ? "[12, 16]" : "[12, 16, 12]", D == 2 ? "[1.5, 2.0]" : "[1.5, 2.0, 1.5]", liquid, on, scheme, ice, more);
    return scene::parse(text, "test.toml", {sph::kind().schema, pbf::kind().schema});
}
template <int D>
std::string block(const Vec<3>& lo, const Vec<3>& hi) {
    return fmt::format("{{ shape = \"box\", min = {}, max = {} }}", list<D>(lo[0], lo[1], lo[2]), list<D>(hi[0], hi[1], hi[2]));
}

/// f(solver type, reference type, name)
template <int D, class Run>
void with_both_solvers(Run&& run) {
    run(std::type_identity<Sph<D>>{}, std::type_identity<sph::ReferenceSphSolver<D>>{}, "sph");
    run(std::type_identity<Pbf<D>>{}, std::type_identity<pbf::ReferencePbfSolver<D>>{}, "pbf");
}

template <int D>
bool is_ice(const particles::Fluid<D>& fluid, int i) {
    return fluid.enthalpy[static_cast<std::size_t>(i)] < -15000;  // half of the latent heat below the liquid at 300 K
}

/// Mass, then linear momentum, then angular momentum about the middle of the box; of ice alone or of all.
template <int D>
std::array<real, 7> momentum(const particles::Fluid<D>& fluid, bool ice_alone) {
    std::array<real, 7> sum{};
    for (int i = 0; i < fluid.count(); ++i) {
        if (ice_alone && !is_ice(fluid, i)) continue;
        Vec<3> x{}, v{};
        for (int a = 0; a < D; ++a) x[a] = (fluid.position(i) - fluid.domain.centre())[a], v[a] = fluid.velocity(i)[a];
        sum[0] += fluid.mass;
        for (int a = 0; a < 3; ++a) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            sum[static_cast<std::size_t>(1 + a)] += fluid.mass * v[a];
            sum[static_cast<std::size_t>(4 + a)] += fluid.mass * (x[b] * v[c] - x[c] * v[b]);
        }
    }
    return sum;
}

}  // namespace
}  // namespace weir::test

using namespace weir;
using particles::Fluid;

TEST_IN_2D_AND_3D("a piece of ice in free flight keeps its momentum, its spin and its shape") {
    NEEDS_BACKEND;
    test::with_both_solvers<D>([&](auto here, auto, const char* name) {
        const std::string ice = test::block<D>({{0.4, 0.7, 0.5}}, {{0.95, 1.5, 0.9}});
        typename decltype(here)::type solver(test::ice_scene<D>(name, test::backend, ice, "1"));
        Fluid<D>& start = solver.fluid();
        for (int i = 0; i < start.count(); ++i) {
            const Vec<D> r = start.position(i) - start.domain.centre();
            Vec<D> v{};
            v[0] = 0.5 - 2 * r[1], v[1] = -1 + 2 * r[0];
            if (D == 3) v[1] -= 0.3 * r[D - 1], v[D - 1] = 0.3 * r[1];
            Fluid<D>::put(start.v, i, v);
        }
        const Fluid<D> before = start;
        const auto moved = test::momentum(before, true);
        constexpr int steps = 100;
        for (int s = 0; s < steps; ++s) solver.step(0.001);
        const Fluid<D>& after = solver.fluid();
        const auto now = test::momentum(after, true);
        // What particles of a piece do to each other cancels but for single precision: positions of up to 1 m are rounded to 2^-24 m in
        // each of PBF's four iterations, over a step of 1 ms; as they add at random, six times their spread.
        const real n = before.count(), each = std::pow(2, -24) / std::sqrt(12.0) / 0.001;
        const real rounding = 6 * each * std::sqrt(4.0 * steps * n) * before.mass;
        EXPECT_EQ(now[0], moved[0]);
        for (std::size_t k = 1; k < 7; ++k) EXPECT_NEAR(now[k], moved[k], rounding) << name << k;
        std::vector<int> place(after.id.size());  // where the arrays have gone
        for (int i = 0; i < after.count(); ++i) place[static_cast<std::size_t>(after.id[static_cast<std::size_t>(i)])] = i;
        const auto at = [&](int i) { return after.position(place[static_cast<std::size_t>(before.id[static_cast<std::size_t>(i)])]); };
        EXPECT_GT(norm(at(0) - before.position(0)), 0.04) << name;
        for (int i = 1; i < before.count(); ++i)
            EXPECT_NEAR(norm(at(i) - at(0)), norm(before.position(i) - before.position(0)), 1e-12) << name;
    });
}

TEST_IN_2D_AND_3D("ice and water in the air exchange momentum, and none is lost") {
    NEEDS_BACKEND;
    test::with_both_solvers<D>([&](auto here, auto, const char* name) {
        const std::string drop = test::block<D>({{0.3, 0.5, 0.3}}, {{1.2, 1.5, 1.2}});
        typename decltype(here)::type solver(test::ice_scene<D>(name, test::backend, drop, "(abs(x - 0.7) < 0.3) * (abs(y - 1) < 0.2)"));
        Fluid<D>& start = solver.fluid();
        for (int i = 0; i < start.count(); ++i)
            if (!test::is_ice(start, i)) {
                Vec<D> v{};
                v[0] = 1 - 0.5 * start.position(i)[1], v[1] = start.position(i)[0];
                Fluid<D>::put(start.v, i, v);
            }
        const auto moved = test::momentum(start, false), ice = test::momentum(start, true);
        constexpr int steps = 20;
        for (int s = 0; s < steps; ++s) solver.step(0.001);
        const auto now = test::momentum(solver.fluid(), false), ice_now = test::momentum(solver.fluid(), true);
        const real n = start.count(), each = std::pow(2, -24) / std::sqrt(12.0) / 0.001;
        const real rounding = 6 * each * std::sqrt(4.0 * steps * n) * start.mass;  // as above
        for (std::size_t k = 1; k < 4; ++k) EXPECT_NEAR(now[k], moved[k], rounding) << name << k;
        EXPECT_GT(std::abs(ice_now[1] - ice[1]), 0.1 * ice[0] * 0.1) << name;
    });
}

TEST_IN_2D_AND_3D("a step of water with ice in it agrees with the double reference; what has frozen to a cold wall stays") {
    NEEDS_BACKEND;
    const std::string more =
        "effects.gravity.g = " + test::list<D>(3, -9.81, 0) + "\nsides.y_min = { kind = \"wall\", temperature = 290.0 }\n";
    test::with_both_solvers<D>([&](auto here, auto there, const char* name) {
        const std::string as_given = ", settle = 0";  // what it leaves is known to 1e-4
        const std::string water = test::block<D>({{0, 0, 0}}, {{1.5, 1, 1.5}}),
                          places = "(y < 0.3) * (x < 0.5) + (abs(y - 0.8) < 0.2) * (abs(x - 0.9) < 0.3)";
        typename decltype(here)::type solver(test::ice_scene<D>(name, test::backend, water, places, more, as_given));
        typename decltype(there)::type reference(test::ice_scene<D>(name, "reference", water, places, more, as_given));
        test::shake(solver.fluid(), 0.05), test::shake(reference.fluid(), 0.05);
        const Fluid<D> before = reference.fluid();
        solver.step(0.001), reference.step(0.001);
        const Fluid<D>& a = solver.fluid();
        const Fluid<D>& b = reference.fluid();
        int held = 0, pieces = 0;
        real worst = 0;
        for (int i = 0; i < before.count(); ++i) {
            worst = std::max(worst, norm(a.position(i) - b.position(i)));
            if (!test::is_ice(before, i)) continue;
            const bool low = before.position(i)[1] < 0.45;
            EXPECT_EQ(low, norm(b.position(i) - before.position(i)) < 1e-14) << name;
            EXPECT_EQ(low, a.position(i) == before.position(i)) << name;
            ++(low ? held : pieces);
        }
        EXPECT_LE(worst, 1e-5 * 3 * before.domain.spacing) << name;  // as without ice, of the support
        EXPECT_GT(held, 5) << name;
        EXPECT_GT(pieces, 5) << name;
    });
}

TEST_IN_2D_AND_3D("ice that moves repeats to the last bit, through a change of order and a restart") {
    NEEDS_BACKEND;
    const std::string more = "effects.gravity.g = " + test::list<D>(3, -9.81, 0) + "\n";
    test::with_both_solvers<D>([&](auto here, auto, const char* name) {
        using S = typename decltype(here)::type;
        const auto solver = [&](int count) {
            set_threads(count);
            return std::make_unique<S>(test::ice_scene<D>(name, test::backend, test::block<D>({{0, 0, 0}}, {{1.5, 1, 1.5}}),
                                                          "(abs(y - 0.8) < 0.2) * (abs(x - 0.9) < 0.3)", more));
        };
        auto through = solver(1);
        for (int s = 0; s < 22; ++s) through->step(0.001);
        auto first = solver(2);
        for (int s = 0; s < 17; ++s) first->step(0.001);
        Checkpoint saved;
        first->save(saved);
        auto second = solver(2);
        second->restore(saved);
        for (int s = 17; s < 22; ++s) second->step(0.001);
        set_threads(0);
        EXPECT_EQ(through->fluid().x, second->fluid().x) << name;
        EXPECT_EQ(through->fluid().v, second->fluid().v) << name;
    });
}
