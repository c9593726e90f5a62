// Sentences about a study at its limits: one method, one repeat, no reference, errors of zero, runs too short for the clock.
#include "support/test.hpp"
#include "validation/cost/rank.hpp"
#include "validation/cost/tables.hpp"

namespace weir::validation::advice_tests {
namespace {

CostPoint point(const std::string& method, real error, double seconds) {
    return {.method = method, .error = error, .seconds_per_second = seconds, .ms_per_step = 1, .repeats = 1};
}

StudyResult study(std::vector<CostPoint> points, real good_enough = 0) {
    StudyResult result{.study = {.name = "s", .error = "e", .good_enough = good_enough}, .points = std::move(points)};
    mark_front(result.points, result.study);
    return result;
}

TEST("an error of zero is not within the uncertainty of a reference that has none") {
    const auto sentences = advice(study({point("coarse", 0.5, 0.5), point("exact", 0, 0.75)}));
    ASSERT_EQ(sentences.size(), 2u) << "nothing about configurations that cannot be ranked";
    EXPECT_EQ(sentences[0],
              "2 of 2 configurations run in real time; the most accurate of them is exact: e = 0, for 12.5 ms of each 16.7 ms frame.");
    EXPECT_EQ(sentences[1],
              "From coarse, the cheapest, to exact, the most accurate, the error falls from 0.5 to zero for 1.5 times the time.");
}

TEST("a run too short for the clock has no factor of time: no text is infinite") {
    const auto result = study({point("instant", 0.5, 0), point("slow", 0.1, 0.5)}, 0.3);
    for (const std::string& s : advice(result)) {
        EXPECT_EQ(s.find("inf"), std::string::npos) << s;
        EXPECT_EQ(s.find("nan"), std::string::npos) << s;
    }
    const auto alone = advice(study({point("instant", 0.5, 0)}, 0.6));
    EXPECT_EQ(alone[0], "For e <= 0.6 take instant: 0 ms of each 16.7 ms frame.");
    const auto curves = envelopes(result);
    EXPECT_TRUE(price_at(curves.back(), 0.3).has_value());
    EXPECT_EQ(rank(curves, 0.5, 0).reached.front().times, 1);
}

TEST("a configuration that is slower than real time takes no part of a frame") {
    const auto sentences = advice(study({point("sph", 0.1, 8.94), point("pbf", 0.5, 2)}, 0.2));
    EXPECT_EQ(sentences[0], "For e <= 0.2 take sph: 149 ms per frame of 16.7 ms (0.112 times real time).");
    EXPECT_EQ(sentences[1], "No configuration runs in real time; the nearest is pbf with 33.3 ms per frame of 16.7 ms.");
}

TEST("a configuration that creates liquid is not recommended, and is named") {
    CostPoint leaks = point("cheap", 0.1, 0.1), holds = point("sure", 0.15, 0.5);
    leaks.also["volume.drift"] = -0.09, holds.also["volume.drift"] = 0.009;
    const auto sentences = advice(study({leaks, holds}, 0.2));
    EXPECT_EQ(sentences[0].substr(0, 23), "For e <= 0.2 take sure:");
    EXPECT_EQ(sentences[1], "The volume changes by more than 1% with cheap: by up to 9%. They are not recommended.");
}

TEST("one configuration is compared with no other, and one repeat has no spread") {
    const auto sentences = advice(study({point("", 0.1, 0.5)}));
    ASSERT_EQ(sentences.size(), 1u);
    EXPECT_EQ(sentences[0], "The only configuration runs in real time: 8.33 ms of each 16.7 ms frame.");
    EXPECT_EQ(advice(study({point("sph 64", 0.1, 2)}))[0], "sph 64 does not run in real time: 33.3 ms per frame of 16.7 ms.");
    const std::string table = cost_table(study({point("a", 0.1, 0.5)}));
    EXPECT_EQ(table.find("0%"), std::string::npos) << table;
}

}  // namespace
}  // namespace weir::validation::advice_tests
