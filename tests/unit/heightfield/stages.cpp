// The fast stage against the plain one, and its bits for any number of threads.
#include "core/parallel.hpp"
#include "heightfield/effects.hpp"
#include "heightfield/reference.hpp"
#include "support/test.hpp"
#include "unit/heightfield/support.hpp"

#include <cmath>

namespace stages_tests {

using namespace weir;
using namespace weir::heightfield;

namespace {

const std::vector<std::string>& side_lines() {
    static const std::vector<std::string> lines{
        "", "grid.periodic = [\"x\"]\n", "sides.x_min = \"outflow\"\n",
        "sides = { x_min = { kind = \"discharge\", discharge = 0.05 }, x_max = { kind = \"level\", level = 0.2 } }\n"};
    return lines;
}
std::string side_line(int dim, std::size_t which) {
    if (dim == 2 || which != 1) return side_lines()[which];
    return "grid.periodic = [\"x\", \"z\"]\n";
}

struct Copy {
    Field h, qx, qz;
    explicit Copy(const State& s) : h(s.h), qx(s.qx), qz(s.qz) {}
    Water water() { return {h.data(), qx.data(), qz.data()}; }
};

real difference(const Field& a, const Field& b) {
    real most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

}  // namespace

TEST_IN_2D_AND_3D("both stages are the plain ones, for each limiter and all sides") {
    for (const Limiter limiter : {Limiter::none, Limiter::minmod, Limiter::van_leer, Limiter::mc})
        for (std::size_t side = 0; side < side_lines().size(); ++side) {
            const scene::Scene scene = test::height_scene(D, test::rough_water(D) + side_line(D, side), 37);
            const State state(scene);
            Rows rows(state.plane, limiter);
            std::vector<RowReport> reports(static_cast<std::size_t>(state.plane.nz));
            Copy from(state), fast(state), plain(state);
            for (const bool second : {false, true}) {
                rows.stage({state, from.water(), fast.water(), 1e-3, second}, reports);
                reference_stage({state, from.water(), plain.water(), 1e-3, second}, limiter);
                // round-off of a momentum flux of 1 m^3/s^2 over a column of 0.03 m, times the step: 1e-17; velocities of films of 1e-6 m
                // magnify it
                EXPECT_LE(difference(fast.h, plain.h), 1e-14) << static_cast<int>(limiter) << ' ' << side;
                EXPECT_LE(difference(fast.qx, plain.qx), 1e-14) << static_cast<int>(limiter) << ' ' << side;
                EXPECT_LE(difference(fast.qz, plain.qz), 1e-14) << static_cast<int>(limiter) << ' ' << side;
                EXPECT_GT(difference(fast.h, state.h), 1e-6);
            }
        }
}

TEST_IN_2D_AND_3D("the same bits for any number of threads") {
    std::vector<real> first;
    for (const int count : {1, 2, 3}) {
        set_threads(count);
        const auto solver = test::height_solver(test::height_scene(D, test::rough_water(D), 70));
        for (int i = 0; i < 8; ++i) solver->step(solver->advised_dt());
        std::vector<real> all;
        for (const auto& f : static_cast<const Solver&>(*solver).fields().fields)
            for (const auto& c : f.data) all.insert(all.end(), c.begin(), c.end());
        for (const auto& integral : solver->integrals()) all.push_back(integral.value);
        if (first.empty()) first = all;
        EXPECT_EQ(all, first) << count;
    }
    set_threads(0);
}

TEST_IN_2D_AND_3D("what was saved goes on bit for bit, with solids that move and rain that stops") {
    const std::string list = D == 2 ? "[0.3, -0.2], max = [0.5, 0.3]" : "[0.3, -0.2, 0.3], max = [0.5, 0.3, 0.6]";
    const std::string zero = D == 2 ? "[0.1, 0.0]" : "[0.1, 0.0, 0.1]";
    const scene::Scene scene = test::height_scene(
        D, test::rough_water(D) + "solids = [ { shape = \"box\", min = " + list + ", motion = { kind = \"constant\", velocity = " + zero +
               " } } ]\neffects.rain = { rate = 0.01, end = 0.01 }\neffects.friction.n = 0.03\ngrid.origin = " +
               (D == 2 ? "[0.0, -0.3]\n" : "[0.0, -0.3, 0.0]\n"));
    const auto whole = test::height_solver(scene), half = test::height_solver(scene), rest = test::height_solver(scene);
    for (int i = 0; i < 12; ++i) whole->step(0.0015);
    for (int i = 0; i < 5; ++i) half->step(0.0015);
    Checkpoint saved;
    half->save(saved);
    rest->restore(saved);
    for (int i = 0; i < 7; ++i) rest->step(0.0015);
    const FieldSet a = static_cast<const Solver&>(*whole).fields(), b = static_cast<const Solver&>(*rest).fields();
    for (std::size_t f = 0; f < a.fields.size(); ++f)
        for (std::size_t c = 0; c < a.fields[f].data.size(); ++c)
            EXPECT_TRUE(std::equal(a.fields[f].data[c].begin(), a.fields[f].data[c].end(), b.fields[f].data[c].begin()))
                << a.fields[f].name;
    for (std::size_t i = 0; i < whole->integrals().size(); ++i) EXPECT_EQ(whole->integrals()[i].value, rest->integrals()[i].value);
}

TEST_IN_2D_AND_3D("water is kept to round-off: what is there is what was there and what was poured in") {
    const scene::Scene scene = test::height_scene(D, test::rough_water(D) + side_line(D, 3) + "effects.rain.rate = 0.01\n", 40);
    const auto solver = test::height_solver(scene);
    const auto value = [&](const std::string& name) {
        for (const auto& i : solver->integrals())
            if (i.name == name) return i.value;
        return std::nan("");
    };
    const real before = value("volume");
    for (int i = 0; i < 200; ++i) solver->step(solver->advised_dt());
    EXPECT_GT(std::abs(value("poured_volume")), 1e-3);
    EXPECT_NEAR(value("volume"), before + value("poured_volume"), 1e-12 * before);
    EXPECT_EQ(value("raised_depth"), 0);
}

TEST("friction slows a film and never turns it around, however long the step") {
    for (const std::string law : {"law = \"manning\", n = 0.1", "law = \"quadratic\", c = 0.5"})
        for (const real dt : {1e-3, 1.0, 1e3}) {
            const scene::Scene scene = test::height_scene(2,
                                                          "initial = { surface = \"0.01\", velocity = { name = \"formula\", x = \"1\" } }\n"
                                                          "grid.periodic = [\"x\"]\neffects.friction = { " +
                                                              law + " }\n");
            State state(scene);
            const auto effects = make_effects(scene, state, "");
            Passes passes;
            effects.apply(Stage::implicit, state, dt, passes);
            EXPECT_GT(state.qx[3], 0);
            EXPECT_LT(state.qx[3], 0.01);
            // dq/dt = -k q^2/h^2, taken at the end of the step, solves q1 + dt k q1^2/h^2 = q0
            const real k = law[7] == 'm' ? 9.81 * 0.01 / std::cbrt(0.01) : 0.5, q1 = state.qx[3];
            EXPECT_NEAR(q1 + dt * k * q1 * q1 / 1e-4, 0.01, 1e-14);
        }
}

}  // namespace stages_tests
