// The judges on fields that are known: the fields are those of the real solvers, by name, place and number, with exact values written over
// them, so that each number has an answer on paper.
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "support/test.hpp"
#include "validation/harness/generic_metrics.hpp"
#include "validation/metrics/samples.hpp"

#include <cmath>
#include <deque>

namespace judges_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// A finished run of `text` at its initial state, whose fields can be written over.
struct Made {
    std::deque<std::vector<real>> values;  // does not move what spans point to
    RunRecord run;

    explicit Made(const std::string& text) {
        run.simulation = std::make_shared<Simulation>(scene::parse(text, "judge.toml", sim::schemas()));
        run.scene = {run.simulation, &run.simulation->scene()};
        run.fields = run.simulation->fields();
        for (FieldView& field : run.fields.fields)
            for (auto& data : field.data) data = values.emplace_back(data.begin(), data.end());
    }
    std::vector<real>& data(std::string_view name, std::size_t component = 0) {
        const FieldView& field = run.field(name);
        for (auto& v : values)
            if (v.data() == field.data[component].data()) return v;
        throw BadInput("no such component");
    }
    template <class F>
    void fill(std::string_view name, std::size_t component, F&& f) {
        auto& to = data(name, component);
        const int axis = run.field(name).where == Where::face ? static_cast<int>(component) : -1;
        for_each_sample(run.fields.grid, axis, [&](const Vec<3>& x, real, std::size_t i) { to[i] = f(x); });
    }
    /// One integral at each of `times`.
    void history(const std::vector<real>& times, const std::map<std::string, std::vector<real>>& series) {
        run.history.resize(times.size());
        for (std::size_t i = 0; i < times.size(); ++i) run.history[i].step = static_cast<std::int64_t>(i), run.history[i].time = times[i];
        for (const auto& [name, y] : series) {
            run.integrals.push_back({.name = name, .unit = "", .value = y.back()});
            for (std::size_t i = 0; i < times.size(); ++i) run.history[i].integrals.push_back(y[i]);
        }
        run.time = times.back();
    }
};

/// As the case has it: 1 m of 32 cells, hot on the left, a diffusivity of 0.01 m^2/s.
Made heated() {
    return Made(
        "solver = \"mac\"\ndim = 2\ngrid = { cells = [32, 32], size = [1.0, 1.0] }\ntime = { end = 1.0 }\n"
        "sides = { x_min = { kind = \"wall\", temperature = 1.0 }, x_max = { kind = \"wall\", temperature = 0.0 } }\n"
        "effects = { diffusion = { temperature = 0.01 } }\n");
}

/// Error against a number that is `exact`: zero where the judge measures it.
real error(const Made& made, const char* metric, const char* number, real exact) {
    Reference ref;
    ref.numbers = {{number, exact}, {"speed_unit", 0.01}};
    return measure(metric, made.run, ref);
}

/// f at n even steps of [0, 1] and its ends.
std::vector<real> even(std::size_t n, const std::function<real(real)>& f) {
    std::vector<real> y;
    for (std::size_t i = 0; i <= n; ++i) y.push_back(f(static_cast<real>(i) / static_cast<real>(n)));
    return y;
}

}  // namespace

TEST(
    "Nusselt numbers: 1 of conduction alone, 1 - a of a parabola at the hot wall, and u L T / (alpha dT) more where a stream carries "
    "heat") {
    Made still = heated();
    still.fill("temperature", 0, [](const Vec<3>& x) { return 1 - x[0]; });
    EXPECT_NEAR(error(still, "nusselt.wall_error", "Nu_0", 1), 0, 1e-12);
    EXPECT_NEAR(error(still, "nusselt.mean_error", "Nu_mean", 1), 0, 1e-12);
    // T = 1 - x + a x (1 - x): -dT/dx is 1 - a at the hot wall, and 1 on the mean of all planes (by the trapezoid, which is exact for it).
    constexpr real a = 0.3;
    still.fill("temperature", 0, [](const Vec<3>& x) { return 1 - x[0] + a * x[0] * (1 - x[0]); });
    EXPECT_NEAR(error(still, "nusselt.wall_error", "Nu_0", 1 - a), 0, 1e-12);
    EXPECT_NEAR(error(still, "nusselt.mean_error", "Nu_mean", 1), 0, 1e-12);
    // u(y) = 0.02 (2 y - 1) with T = 1 - x carries nothing on the mean; with T = y it carries the mean of 0.02 (2 y - 1) y = 0.02 / 6 in
    // every plane inside, less (2 h)^2 / 12 of midpoint sums of y^2; on the walls T is theirs and u sums to zero.
    Made moving = heated();
    moving.fill("velocity", 0, [](const Vec<3>& x) { return 0.02 * (2 * x[1] - 1); });
    moving.fill("temperature", 0, [](const Vec<3>& x) { return 1 - x[0]; });
    EXPECT_NEAR(error(moving, "nusselt.mean_error", "Nu_mean", 1), 0, 1e-12);
    EXPECT_NEAR(error(moving, "nusselt.wall_error", "Nu_0", 1), 0, 1e-12);
    moving.fill("temperature", 0, [](const Vec<3>& x) { return 1 - x[0] + x[1]; });
    const real h = 1.0 / 32, carried = 0.02 * (1.0 / 6 - h * h / 6) / 0.01;
    // what T rises with y is a jump at both walls, of equal size and opposite sign: they cancel
    EXPECT_NEAR(error(moving, "nusselt.mean_error", "Nu_mean", 1 + carried * 31.0 / 32), 0, 1e-12);
}

TEST("the largest speed on a centreline is that of the cubic through the samples, not of the largest sample") {
    Made made = heated();
    // 0.04 y (1 - y) (1 + y): a cubic, so exact; its top is at y = 1/sqrt(3), between samples
    const auto profile = [](real s) { return 0.04 * s * (1 - s * s); };
    made.fill("velocity", 0, [&](const Vec<3>& x) { return profile(x[1]); });
    made.fill("velocity", 1, [&](const Vec<3>& x) { return profile(x[0]); });
    const real top = profile(1 / std::sqrt(3.0)) / 0.01;
    // the search takes 20 points a sample: it is off by at most (h / 40)^2 / 2 times the curvature 6 y 0.04
    const real off = std::pow(1.0 / 32 / 40, 2) / 2 * 0.24 / 0.01 / top;
    EXPECT_LT(error(made, "convection.u_max_error", "u_max", top), off);
    EXPECT_LT(error(made, "convection.v_max_error", "v_max", top), off);
}

TEST("areas of shapes: a plane shifted by 0.1 m leaves a tenth of the box different; a disk's area to its count of points") {
    const std::string text =
        "solver = \"transport\"\ndim = 2\ngrid = { cells = [40, 40], size = [1.0, 1.0] }\ntime = { end = 1.0, dt = 0.1 }\n"
        "flow = { name = \"rotation\", centre = [0.5, 0.5], rate = 1.0 }\n"
        "initial = { level_set = { name = \"slotted_disk\", centre = [0.5, 0.75], radius = 0.15, slot = 0.05, top = 0.1 } }\n";
    Made made(text);
    Reference ref;
    ref.scalars["level_set"] = [](const Vec<3>& x, real) { return x[0] - 0.5; };
    ref.numbers["area"] = 0.6;
    made.fill("level_set", 0, [](const Vec<3>& x) { return x[0] - 0.6; });  // linear: the interpolation is exact
    EXPECT_NEAR(measure("shape.symmetric_difference", made.run, ref), 0.1, 1e-12);
    EXPECT_NEAR(measure("shape.area_change", made.run, ref), 0, 1e-12);
    made.fill("level_set", 0, [](const Vec<3>& x) { return std::hypot(x[0] - 0.5, x[1] - 0.5) - 0.3; });
    ref.scalars["level_set"] = [](const Vec<3>& x, real) { return std::hypot(x[0] - 0.5, x[1] - 0.5) - 0.3; };
    ref.numbers["area"] = pi * 0.09;
    // 320 points a side: pi 0.3^2 320^2 = 28,953 inside; the count of lattice points in a circle of r = 96 of them is off by some r^(2/3),
    // and linear interpolation moves the circle outwards by h^2 / (8 R) = 0.00026 m at most, 0.17% of its area
    EXPECT_LT(measure("shape.area_change", made.run, ref), 0.0017 + std::pow(96.0, 2.0 / 3) / 28953);
    EXPECT_LT(measure("shape.symmetric_difference", made.run, ref), 0.00026 * 2 * pi * 0.3 + std::pow(96.0, 2.0 / 3) / 320 / 320);
}

TEST("impulse: what momentum changes by and no body has given, over the largest impulse") {
    Made made(
        "solver = \"mac\"\ndim = 2\ngrid = { cells = [8, 8], size = [1.0, 1.0], periodic = [\"x\"] }\ntime = { end = 1.0 }\n"
        "solids = [ { shape = \"sphere\", centre = [0.5, 0.5], radius = 0.2 } ]\n");
    // the body gives -I to the fluid: P = 5 + sin t, I = -0.9 sin t leaves 0.1 sin t unaccounted for, a ninth of the largest impulse
    const auto swing = [](real scale, real shift) { return even(100, [=](real t) { return shift + scale * std::sin(2 * pi * t); }); };
    std::vector<real> times = even(100, [](real t) { return t; });
    made.history(times, {{"momentum_x", swing(1, 5)}, {"solid_impulse_x", swing(-0.9, 0)}});
    EXPECT_NEAR(measure("impulse.balance_error", made.run, {}), 1.0 / 9, 1e-12);
    made.run.integrals.clear();
    for (auto& m : made.run.history) m.integrals.clear();
    made.history(times, {{"momentum_x", swing(1, 5)}, {"solid_impulse_x", swing(-1, 0)}});
    EXPECT_NEAR(measure("impulse.balance_error", made.run, {}), 0, 1e-12);
}

TEST("moments: the ellipse of a block has its sides over sqrt(3), exactly, for a mean square is side^2 / 12 with each particle's own") {
    Made made(
        "solver = \"sph\"\ndim = 2\ngrid = { cells = [64, 64], size = [2.0, 2.0], origin = [-1.0, -1.0] }\ntime = { end = 1.0 }\n"
        "fluid = { density = 1000.0 }\nliquid = [ { shape = \"box\", min = [-0.5, -0.25], max = [0.5, 0.25] } ]\n");
    Reference ref;
    ref.curves["a"] = {.x = {0, 1}, .y = {1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}};
    ref.curves["b"] = {.x = {0, 1}, .y = {0.5 / std::sqrt(3.0), 0.5 / std::sqrt(3.0)}};
    EXPECT_NEAR(measure("drop.a_error", made.run, ref), 0, 1e-12);
    EXPECT_NEAR(measure("drop.b_error", made.run, ref), 0, 1e-12);
    for (auto& x : made.data("position", 0)) x += 0.3;  // moments are about the mean
    EXPECT_NEAR(measure("drop.a_error", made.run, ref), 0, 1e-12);
    ref.curves["a"].y = {0.5, 0.5};
    EXPECT_NEAR(measure("drop.a_error", made.run, ref), 2 / std::sqrt(3.0) - 1, 1e-12);
}

TEST("the emptiest part: 1 where every sixteenth holds as many, 1/4 where one holds a quarter of its share, 0 where one is empty") {
    Made made(
        "solver = \"sph\"\ndim = 2\ngrid = { cells = [16, 16], size = [1.0, 1.0] }\ntime = { end = 1.0 }\nfluid = { density = 1000.0 }\n"
        "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [1.0, 1.0] } ]\n");
    const Metric* metric = nullptr;
    for (const Metric& m : metrics())
        if (m.name == "gas.emptiest_part") metric = &m;
    ASSERT_NE(metric, nullptr);
    const auto emptiest = [&] { return metric->observe(made.run.fields, *made.run.scene, 0); };
    auto &x = made.data("position", 0), &y = made.data("position", 1);
    ASSERT_EQ(x.size(), 256u);
    EXPECT_EQ(emptiest(), 1);
    std::size_t moved = 0;  // 12 of the 16 in the lower left go to the upper right
    for (std::size_t i = 0; i < x.size(); ++i)
        if (x[i] < 0.25 && y[i] < 0.25 && moved < 12) x[i] += 0.75, y[i] += 0.75, ++moved;
    EXPECT_EQ(emptiest(), 0.25);
    for (std::size_t i = 0; i < x.size(); ++i)
        if (x[i] < 0.25 && y[i] < 0.25) x[i] += 0.75, y[i] += 0.75;
    EXPECT_EQ(emptiest(), 0);
}

}  // namespace judges_tests
