// Names of quantities, and statistics of series whose answers are known.
#include "validation/harness/named_quantity.hpp"

#include "core/error.hpp"
#include "support/test.hpp"

namespace named_quantity_tests {

using namespace weir;
using namespace weir::validation;

namespace {

real value(const Curve& series, const std::string& name) { return statistic_of(series, parse_quantity(name)); }

/// sin(2 pi t / 2 s) over 6 s, at uneven times.
Curve wave() {
    Curve c;
    for (int i = 0; i <= 600; ++i) {
        const real s = i / 600.0, t = 6 * (s + 0.05 * std::sin(2 * pi * s) / (2 * pi));
        c.x.push_back(t), c.y.push_back(std::sin(pi * t));
    }
    return c;
}

void expect_refused(const std::string& name, const std::string& why) {
    try {
        parse_quantity(name);
        ADD_FAILURE() << name << " was accepted";
    } catch (const BadInput& wrong) {
        EXPECT_NE(std::string(wrong.what()).find(why), std::string::npos) << wrong.what();
        EXPECT_NE(std::string(wrong.what()).find(name), std::string::npos) << wrong.what();
    }
}

}  // namespace

TEST("a name is a series, a statistic and a window") {
    const NamedQuantity q = parse_quantity("right.height.max@0.8..");
    EXPECT_EQ(q.series, "right.height");
    EXPECT_EQ(q.kind, Statistic::max);
    EXPECT_EQ(q.when.first, 0.8);
    EXPECT_EQ(q.when.last, infinity);
    EXPECT_EQ(parse_quantity("velocity.velocity_x#3").series, "velocity.velocity_x#3");
    EXPECT_EQ(parse_quantity("velocity.velocity_x#3").kind, Statistic::end);
    EXPECT_EQ(parse_quantity("probe.right.end").series, "right");  // as metrics of cases name probes
    EXPECT_EQ(parse_quantity("e.rms@1..2").when.last, 2);
    EXPECT_EQ(parse_quantity("e.rms@..2").when.first, -infinity);
    EXPECT_TRUE(parse_quantity("e@2.5").when.one_time());
    const NamedQuantity event = parse_quantity("front.time_of(<-0.4,3)@1..");
    EXPECT_EQ(event.series, "front");
    EXPECT_FALSE(event.crossing.above);
    EXPECT_EQ(event.crossing.level, -0.4);
    EXPECT_EQ(event.crossing.number, 3);
}

TEST("wrong names say what is allowed") {
    expect_refused("front.time_of(0.4)", "(>LEVEL)");
    expect_refused("front.time_of(>x)", ">x is no level");
    expect_refused("front.time_of(>0.4,0)", "whole number from 1");
    expect_refused("front.time_of(>0.4", "')' is missing");
    expect_refused("e@2..1", "empty interval");
    expect_refused("e@-1", "is no time");
    expect_refused("pressure.picture@1..2", "a picture is of one time");
    expect_refused("e.max@2", "of one time means nothing");
    expect_refused("@2", "the name is missing");
    expect_refused(".max", "the name is missing");
}

TEST("statistics of a sine") {
    const Curve c = wave();
    // Samples are 0.01 s apart: linear interpolation and the trapezoidal rule are wrong by (pi dt)^2/8 = 1.4e-4 at most.
    EXPECT_NEAR(value(c, "s.max"), 1, 2e-4);
    EXPECT_NEAR(value(c, "s.min"), -1, 2e-4);
    EXPECT_NEAR(value(c, "s.range"), 2, 4e-4);
    EXPECT_NEAR(value(c, "s.mean"), 0, 2e-4);
    EXPECT_NEAR(value(c, "s.mean@0..1"), 2 / pi, 2e-4);
    EXPECT_NEAR(value(c, "s.rms"), std::sqrt(0.5), 2e-4);
    EXPECT_NEAR(value(c, "s@0.5"), 1, 2e-4);
    EXPECT_NEAR(value(c, "s.end@..2.5"), 1, 2e-4);
    EXPECT_NEAR(value(c, "s.period"), 2, 1e-4);
    // A parabola through three samples of a maximum: wrong by far less than a sample.
    EXPECT_NEAR(value(c, "s.time_of_max@0..1.5"), 0.5, 1e-4);
    EXPECT_NEAR(value(c, "s.time_of_max@2..3"), 2.5, 1e-4);
    EXPECT_NEAR(value(c, "s.time_of_min@0..2"), 1.5, 1e-4);
    EXPECT_NEAR(value(c, "s.time_of(>0.5)"), 1.0 / 6, 1e-4);
    EXPECT_NEAR(value(c, "s.time_of(>0.5,2)"), 2 + 1.0 / 6, 1e-4);
    EXPECT_NEAR(value(c, "s.time_of(<0.5)@0.5.."), 5.0 / 6, 1e-4);
}

TEST("the mean is over time, not over rows") {
    const Curve c{.x = {0, 1, 1.1, 1.2, 2}, .y = {1, 1, 1, 3, 3}};
    EXPECT_NEAR(value(c, "s.mean"), (1.1 * 1 + 0.1 * 2 + 0.8 * 3) / 2, 1e-15);
}

TEST("drift and change are relative to the first value of the window") {
    const Curve c{.x = {0, 1, 2, 3}, .y = {-2, 2, 1, 4}};
    EXPECT_EQ(value(c, "s.change"), 3);
    EXPECT_EQ(value(c, "s.drift"), 3);
    EXPECT_EQ(value(c, "s.change@1.."), 1);
    EXPECT_EQ(value(c, "s.drift@1..2"), 0.5);
}

TEST("a series that begins beyond a level crosses it at its first time") {
    const Curve c{.x = {0, 1, 2}, .y = {2, 0, 2}};
    EXPECT_EQ(value(c, "s.time_of(>1)"), 0);
    EXPECT_EQ(value(c, "s.time_of(>1,2)"), 1.5);
    EXPECT_EQ(value(c, "s.time_of(<1)"), 0.5);
}

TEST("what a run does not say is not a number") {
    const Curve c{.x = {0, 1, 2}, .y = {0, 1, 2}};
    EXPECT_EQ(value(c, "s@2.5"), 2) << "the next row would be at 3: the end of the run may lie between";
    for (const char* name : {"s.time_of(>3)", "s.time_of(>1,2)", "s.period", "s@3", "s.max@1..3", "s.mean@3.5.."})
        EXPECT_TRUE(std::isnan(value(c, name))) << name;
    const Curve broken{.x = {0, 1, 2}, .y = {0, std::nan(""), 2}};
    EXPECT_TRUE(std::isnan(value(broken, "s.max"))) << "max would step over it";
    EXPECT_TRUE(std::isnan(value(broken, "s.mean")));
    EXPECT_TRUE(std::isnan(value({}, "s.max")));
}

TEST("units of times and ratios") {
    EXPECT_EQ(unit_of(parse_quantity("a.max"), "m"), "m");
    EXPECT_EQ(unit_of(parse_quantity("a.time_of(>1)"), "m"), "s");
    EXPECT_EQ(unit_of(parse_quantity("a.period"), "m"), "s");
    EXPECT_EQ(unit_of(parse_quantity("a.drift"), "m"), "");
}

}  // namespace named_quantity_tests
