// Norms of fields and statistics of series on records made by hand.
#include "validation/harness/generic_metrics.hpp"

#include "support/test.hpp"

namespace generic_metrics_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// A record with one face field of n x n cells on the unit square, u = (x^2, 0) + offset, and a cell field p = 5 + x.
struct Sample {
    std::vector<real> u, v, p;
    RunRecord run;
    explicit Sample(int n, real offset) {
        const real h = 1.0 / n;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i <= n; ++i) u.push_back(i * h * i * h + offset);
        v.assign(static_cast<std::size_t>(n * (n + 1)), 0);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) p.push_back(5 + (i + 0.5) * h);
        run.fields.grid = {.dim = 2, .cells = {n, n, 1}, .origin = {0, 0, 0}, .spacing = {h, h, 0}};
        run.fields.fields = {{"velocity", "m/s", Where::face, "", {u, v}}, {"pressure", "Pa", Where::cell, "", {p}}};
    }
    Sample(const Sample&) = delete;
};

Reference exact() {
    Reference r;
    r.vectors["velocity"] = [](const Vec<3>& x, real) { return Vec<3>{{x[0] * x[0], 0, 0}}; };
    r.scalars["pressure"] = [](const Vec<3>& x, real) { return x[0]; };
    return r;
}

}  // namespace

TEST("the error of an exact field is zero at faces, and an offset of one component is its norm") {
    const Sample right(8, 0), wrong(8, 0.25);
    for (const char* norm : {"velocity.l1", "velocity.l2", "velocity.linf"}) {
        EXPECT_NEAR(measure(norm, right.run, exact()), 0, 1e-15) << norm;
        EXPECT_NEAR(measure(norm, wrong.run, exact()), 0.25, 1e-14) << norm;
    }
    EXPECT_NEAR(measure("velocity.max", wrong.run, {}), 1.25, 1e-15);
}

TEST("a relative norm divides by that of the reference, whose mean of x^4 is 1/5 by the trapezoidal rule") {
    const Sample wrong(64, 0.25);
    EXPECT_NEAR(measure("velocity.l2_relative", wrong.run, exact()), 0.25 / std::sqrt(0.2), 1e-3);  // trapezoid error h^2/3 = 8e-5
}

TEST("a field known up to a constant is compared without its mean, and only where the reference holds") {
    const Sample s(8, 0);
    Reference r = exact();
    EXPECT_NEAR(measure("pressure.linf", s.run, r), 5, 1e-14);
    r.up_to_a_constant.insert("pressure");
    EXPECT_NEAR(measure("pressure.linf", s.run, r), 0, 1e-14);
    r.up_to_a_constant.clear();
    r.scalars["pressure"] = [](const Vec<3>& x, real) { return x[0] < 0.5 ? 5 + x[0] : 1e9; };
    r.covers = [](const Vec<3>& x, real) { return x[0] < 0.5; };
    EXPECT_NEAR(measure("pressure.linf", s.run, r), 0, 1e-14);
}

TEST("one NaN sample makes every norm NaN") {
    Sample s(8, 0);
    s.u[7] = std::nan("");
    for (const char* norm : {"velocity.l1", "velocity.l2", "velocity.linf", "velocity.max"})
        EXPECT_TRUE(std::isnan(measure(norm, s.run, exact()))) << norm;
}

TEST("series give last, extremes, drift and change; one NaN among them gives NaN") {
    Sample s(4, 0);
    s.run.integrals = {{"volume", "m^2", 3}};
    s.run.history = {
        {.step = 0, .time = 0, .integrals = {2}}, {.step = 1, .time = 0.1, .integrals = {4}}, {.step = 2, .time = 0.2, .integrals = {3}}};
    s.run.history[1].report.max_divergence = 0.5, s.run.history[2].report.max_divergence = 0.25;
    const auto value = [&](const char* name) { return measure(name, s.run, {}); };
    EXPECT_EQ(value("volume"), 3);
    EXPECT_EQ(value("volume.max"), 4);
    EXPECT_EQ(value("volume.min"), 2);
    EXPECT_EQ(value("volume.mean"), 3);
    EXPECT_EQ(value("volume.drift"), 1);
    EXPECT_EQ(value("volume.change"), 0.5);
    EXPECT_EQ(value("divergence.max"), 0.5);
    EXPECT_EQ(value("steps"), 2);
    s.run.history[1].integrals[0] = std::nan("");
    for (const char* name : {"volume", "volume.max", "volume.min", "volume.mean", "volume.drift"})
        EXPECT_TRUE(std::isnan(value(name))) << name;
}

TEST("a probe is a series by its name, its first column, or by the name of a column; one that is not there is refused") {
    Sample s(4, 0);
    s.run.probes = {{.name = "behind", .columns = {"velocity_x [m/s]", "velocity_y [m/s]"}, .times = {0, 1}, .values = {{3, -1}, {2, 5}}}};
    EXPECT_EQ(measure("probe.behind", s.run, {}), 2);
    EXPECT_EQ(measure("probe.behind.velocity_y", s.run, {}), 5);
    EXPECT_EQ(measure("probe.behind.velocity_y.min", s.run, {}), -1);
    EXPECT_EQ(measure("probe.behind.mean", s.run, {}), 2.5);
    EXPECT_NO_THROW(check_metric("probe.behind.velocity_y.max", s.run, {}));
    EXPECT_THROW(check_metric("probe.before", s.run, {}), BadInput);
    EXPECT_THROW(check_metric("probe.behind.velocity_z", s.run, {}), BadInput);
}

TEST("quantities with a window or an event are metrics of any run") {
    Sample s(4, 0);
    s.run.probes = {{.name = "right", .columns = {"height [m]"}, .times = {0, 1, 2}, .values = {{3}, {2}, {4}}}};
    s.run.integrals = {{"volume", "m^2", 3}};
    s.run.history = {{.step = 0, .time = 0, .integrals = {2}}, {.step = 1, .time = 2, .integrals = {4}}};
    EXPECT_EQ(measure("right.max@..1", s.run, {}), 3);
    EXPECT_EQ(measure("right.height@1.5", s.run, {}), 3);
    EXPECT_EQ(measure("probe.right.range", s.run, {}), 2);
    EXPECT_EQ(measure("right.time_of(<2.5)", s.run, {}), 0.5);
    EXPECT_EQ(measure("volume@1", s.run, {}), 3);
    EXPECT_EQ(unit_of("right.max@..1", s.run), "m");
    EXPECT_EQ(unit_of("right.time_of(<2.5)", s.run), "s");
    EXPECT_EQ(unit_of("volume@1", s.run), "m^2");
    EXPECT_EQ(unit_of("probe.right", s.run), "m");
    EXPECT_NO_THROW(check_metric("right.max@..1", s.run, {}));
    EXPECT_THROW(check_metric("left.max@..1", s.run, {}), BadInput);
    EXPECT_THROW(check_metric("right.max@1..x", s.run, {}), BadInput);
    EXPECT_THROW(check_metric("right.curve@1..", s.run, {}), BadInput);
}

TEST("a metric that the run or the reference cannot answer is refused by name") {
    const Sample s(4, 0);
    EXPECT_THROW(check_metric("nothing", s.run, exact()), BadInput);
    EXPECT_THROW(check_metric("temperature.l2", s.run, exact()), BadInput);
    EXPECT_THROW(check_metric("velocity.l3", s.run, exact()), BadInput);
    EXPECT_THROW(check_metric("velocity.l2", s.run, {}), BadInput);
    EXPECT_NO_THROW(check_metric("velocity.l2", s.run, exact()));
    EXPECT_NO_THROW(check_metric("divergence.max", s.run, {}));
}

}  // namespace generic_metrics_tests
