// Methods ranked at an error along their curves, on curves whose crossings are known exactly: powers of the price.
#include "validation/cost/rank.hpp"
#include "support/test.hpp"
#include "validation/cost/tables.hpp"

#include <cmath>

namespace weir::validation::rank_tests {
namespace {

/// A method whose error is scale / price^power, measured at these prices.
Envelope power(const std::string& label, real scale, real power, const std::vector<double>& prices) {
    Envelope e{.label = label, .points = {}};
    for (const double t : prices) e.points.push_back({t, scale / std::pow(t, power)});
    return e;
}

CostPoint point(const std::string& method, real error, double seconds) {
    return {.method = method, .error = error, .seconds_per_second = seconds, .ms_per_step = 1};
}

}  // namespace

TEST("a price is read exactly where the error is a power of it, wherever the settings lie, and so is an error") {
    const Envelope a = power("a", 0.4, 0.5, {1, 4, 16, 64}), uneven = power("uneven", 0.4, 0.5, {1, 1.7, 30, 64});
    for (const real error : {0.3, 0.2, 0.11, 0.06})
        for (const Envelope* curve : {&a, &uneven}) {
            const auto at = price_at(*curve, error);
            ASSERT_TRUE(at);
            EXPECT_FALSE(at->at_most);
            EXPECT_NEAR(at->price, (0.4 / error) * (0.4 / error), 1e-12 * at->price) << curve->label;
            EXPECT_NEAR(error_at(*curve, at->price), error, 1e-14);
        }
}

// A threshold between two settings made of this anything from 1 to 16: whichever setting came after it.
TEST("a method that needs four times the time at every error is four times as expensive at each, whatever settings were measured") {
    const Envelope a = power("a", 0.4, 0.5, {1, 4, 16, 64}), b = power("b", 0.8, 0.5, {3, 11, 47, 200, 900});
    for (const real error : {0.35, 0.21, 0.2, 0.19, 0.101, 0.1, 0.06}) {
        const Ranking r = rank({b, a}, error, 0);
        ASSERT_EQ(r.reached.size(), 2u);
        EXPECT_EQ(r.reached[0].label, "a");
        EXPECT_NEAR(r.reached[1].times, 4, 1e-12) << error;
        EXPECT_FALSE(r.reached[1].alike);
    }
}

TEST("curves that cross are ranked by the side of the crossing on which the error lies") {
    const Envelope first = power("first", 0.1, 1, {0.5, 2, 8, 32}), second = power("second", 0.2, 2, {0.5, 2, 8, 32});
    // 0.1 / t = 0.2 / t^2 at t = 2, where both have 0.05
    EXPECT_EQ(rank({first, second}, 0.06, 0).reached[0].label, "first");
    EXPECT_EQ(rank({first, second}, 0.04, 0).reached[0].label, "second");
    EXPECT_NEAR(rank({first, second}, 0.05, 0).reached[1].times, 1, 1e-12);
}

TEST("nothing is read beyond what was measured: a bound where the cheapest setting is good enough, no place where none is") {
    const Envelope coarse = power("coarse", 0.4, 0.5, {1, 4}), fine = power("fine", 0.01, 0.5, {9, 30});
    const Ranking r = rank({coarse, fine}, 0.1, 0);
    ASSERT_EQ(r.reached.size(), 1u);
    EXPECT_EQ(r.missing, std::vector<std::string>{"coarse"}) << "its best is 0.2";
    EXPECT_TRUE(r.reached[0].at.at_most) << "a coarser setting of it might do";
    EXPECT_EQ(r.reached[0].at.price, 9);
    const Envelope round_off{.label = "solve", .points = {{1, 1e-2}, {2, 1e-14}}};
    EXPECT_TRUE(price_at(round_off, 1e-5)->at_most) << "how it fell to round-off is not known";
    EXPECT_EQ(price_at(round_off, 1e-5)->price, 2);
}

TEST("settings that a cheaper one of the same method beats, and those that failed, are no part of its curve") {
    StudyResult result{.study = {.name = "s", .error = "e"}};
    result.points = {point("m", 0.4, 1), point("m", 0.5, 2), point("m", 0.1, 16), point("m", 0.2, 20), point("m", 0, 0.1)};
    result.points.back().failure = "diverged";
    const auto curves = envelopes(result);
    ASSERT_EQ(curves.size(), 1u);
    ASSERT_EQ(curves[0].points.size(), 2u);
    EXPECT_NEAR(price_at(curves[0], 0.2)->price, 4, 1e-12);
}

TEST("methods whose errors differ by less than the reference is known to are not told apart, and the text says so") {
    const Envelope a = power("a", 0.4, 0.5, {1, 4, 16, 64}), b = power("b", 0.44, 0.5, {1, 4, 16, 64});
    // at error 0.1 a takes 16; there b has 0.11
    EXPECT_NEAR(rank({a, b}, 0.1, 0.0).reached[1].times, 1.21, 1e-12);
    EXPECT_FALSE(rank({a, b}, 0.1, 0.0099).reached[1].alike);
    EXPECT_TRUE(rank({a, b}, 0.1, 0.0101).reached[1].alike);
    const Envelope expensive = power("expensive", 0.4, 0.5, {20, 60});
    EXPECT_FALSE(rank({a, expensive}, 0.1, 0.0101).reached[1].alike) << "it has no setting that is as cheap";
    StudyResult result{.study = {.name = "s", .error = "e", .good_enough = 0.1, .known_to = 0.02, .known_why = "w"}};
    for (const Envelope* curve : {&a, &b})
        for (const auto& p : curve->points) result.points.push_back(point(curve->label, p.error, p.price));
    mark_front(result.points, result.study);
    EXPECT_EQ(advice(result)[1],
              "Interpolated along each method's curve at e = 0.1, in units of the time of a: b 1.21. Not distinguishable from a, because "
              "at its cost their errors differ by less than the reference uncertainty of 0.02: b."
              "");
}

}  // namespace weir::validation::rank_tests
