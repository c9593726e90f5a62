// What `weir plan` reads between the entries of the published tables: an entry that is left out is predicted by its neighbours.
#include "validation/cost/recommend.hpp"
#include "core/error.hpp"
#include "support/test.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace weir::validation::recommend_tests {
namespace {

CostCurve line(const std::string& name, std::vector<Priced> points, bool iterations = false) {
    return {name, iterations, std::move(points)};
}

double factor(double a, double b) { return std::max(a / b, b / a); }

}  // namespace

TEST("a power of the resolution, and a constant factor an iteration, are read exactly") {
    const CostCurve grid = line("grid", {{16, 0.16, 1, 10}, {64, 0.01, 16, 160}});
    const auto half = predict(grid, 32);
    ASSERT_TRUE(half);
    EXPECT_NEAR(half->error, 0.04, 1e-12);  // second order: a quarter of 0.16
    EXPECT_NEAR(half->ms_per_step, 40, 1e-9);
    EXPECT_NEAR(half->seconds_per_second, 4, 1e-9);
    const CostCurve solve = line("solve", {{2, 1, 1, 3}, {6, 1.0 / 16, 1, 7}}, true);
    const auto four = predict(solve, 4);
    ASSERT_TRUE(four);
    EXPECT_NEAR(four->error, 0.25, 1e-12);  // half an iteration
    EXPECT_NEAR(four->ms_per_step, 5, 1e-12);
}

TEST("nothing is said of what lies beyond the table, nor across a fall to round-off") {
    const CostCurve curve = line("m", {{1, 1, 1, 1}, {4, 1e-3, 1, 1}, {16, 1e-14, 1, 1}}, true);
    EXPECT_FALSE(predict(curve, 0.5));
    EXPECT_FALSE(predict(curve, 17));
    EXPECT_TRUE(predict(curve, 2));
    EXPECT_FALSE(predict(curve, 8));
}

TEST("of what is good enough and within the budget the cheapest is taken; where nothing is, the nearest two are named") {
    const std::vector<CostCurve> curves{line("coarse", {{10, 0.1, 0.1, 1}, {20, 0.05, 0.4, 2}}), line("fine", {{10, 0.01, 2, 4}})};
    const Budget budget{.seconds = 0.016, .error = 0.06, .frame = 1.0 / 60};
    const auto r = recommend(curves, Price::second, budget);
    ASSERT_TRUE(r.take);
    EXPECT_EQ(r.take->curve->method, "coarse");
    EXPECT_EQ(r.take->at.setting, 20) << "of what was measured";
    ASSERT_TRUE(r.between) << "17 or 18 cells are enough, and cheaper than 20";
    EXPECT_LE(r.between->at.error, 0.06);
    EXPECT_LT(r.between->seconds, r.take->seconds);
    const auto none = recommend(curves, Price::second, {.seconds = 0.016, .error = 0.02, .frame = 1.0 / 60});
    EXPECT_FALSE(none.take) << "fine takes 33 ms a frame";
    ASSERT_EQ(none.nearest.size(), 2u);
    EXPECT_EQ(none.nearest[0].at.setting, 20) << "the most accurate within the budget";
    EXPECT_EQ(none.nearest[1].curve->method, "fine") << "the cheapest that is good enough";
    EXPECT_NEAR(seconds_of({10, 0, 0.001, 50}, Price::second, budget), 0.05, 1e-12) << "a frame takes at least a step";
}

TEST("a budget alone buys the most accurate, an error alone is had as cheaply as can be; what the reference cannot tell is alike") {
    const std::vector<CostCurve> curves{line("coarse", {{10, 0.1, 0.1, 1}, {20, 0.05, 0.4, 2}}), line("fine", {{10, 0.01, 2, 4}})};
    const auto taken = [&](const Budget& budget) { return recommend(curves, Price::second, budget).take.value().at; };
    EXPECT_EQ(taken({.seconds = 0.016}).error, 0.05);
    EXPECT_EQ(taken({.seconds = 1}).error, 0.01);
    EXPECT_EQ(taken({.error = 0.02}).error, 0.01);
    EXPECT_EQ(taken({.error = 0.2}).error, 0.1);
    EXPECT_EQ(taken({.seconds = 1, .known_to = 0.06}).error, 0.05) << "0.05 and 0.01 are alike to it, and the first is cheaper";
    EXPECT_EQ(taken({.error = 0.001, .known_to = 0.06}).error, 0.05) << "0.05 cannot be distinguished from that";
}

TEST("what can be recommended is what recommend() names for some budget and some error, and nothing else") {
    const std::vector<CostCurve> curves{line("a", {{1, 0.5, 1, 1}, {2, 0.3, 3, 1}, {3, 0.31, 4, 1}, {4, 0.001, 40, 1}}),
                                        line("b", {{1, 0.4, 2, 1}, {2, 0.3, 3, 1}, {3, 0.2, 9, 1}, {4, 0.0005, 60, 1}})};
    for (const real known_to : {0.0, 0.01, 0.35}) {
        std::set<const Priced*> named, listed;
        const auto entry = [&](const Choice& c) {
            for (const Priced& p : c.curve->points)
                if (p.setting == c.at.setting) return &p;
            return static_cast<const Priced*>(nullptr);
        };
        const auto note = [&](const Recommendation& r) {
            if (r.take) named.insert(entry(*r.take));
            for (const Choice& c : r.nearest) named.insert(entry(c));
        };
        for (const double seconds : {0.001, 0.02, 0.04, 0.06, 0.1, 0.2, 0.7, 1.0, 2.0, double(infinity)})
            for (const real error : {1e-4, 6e-4, 0.002, 0.25, 0.3, 0.305, 0.35, 0.45, 0.6, infinity})
                note(recommend(curves, Price::second, {.seconds = seconds, .error = error, .known_to = known_to}));
        for (const Choice& c : recommendable(curves, Price::second, {.known_to = known_to})) listed.insert(entry(c));
        EXPECT_EQ(named, listed) << known_to;
    }
}

TEST("what is recommended between two entries can be asked for: cells that keep a grid's proportions, time steps of two digits") {
    const auto taken = [](CostCurve curve, real grain, real error) {
        curve.grain = grain;
        return recommend({curve}, Price::second, {.seconds = 1, .error = error, .frame = 1}).between.value().at.setting;
    };
    const real cells = taken(line("432 x 90", {{48, 0.16, 0.1, 1}, {72, 0.07, 0.2, 1}, {144, 0.01, 0.4, 1}}), 24, 0.03);
    EXPECT_TRUE(cells == 96 || cells == 120) << cells << ": of 432 x 90 only multiples of 24 are whole along both axes";
    const real dt = taken(line("steps", {{1e-3, 0.001, 0.4, 1}, {4e-3, 0.016, 0.1, 1}}), 0, 0.005);
    EXPECT_GT(dt, 1e-3);
    EXPECT_LT(dt, 4e-3);
    EXPECT_NEAR(dt * 1e4, std::round(dt * 1e4), 1e-6) << "two digits";
    const std::filesystem::path tables = std::filesystem::path(WEIR_SOURCE_DIR) / "results" / "cost";
    const Study water = read_study(WEIR_SOURCE_DIR "/cases/dam_break_martin_moyce", Size::ci);
    for (const CostCurve& curve : read_cost_table(water, tables)) EXPECT_EQ(curve.grain, 24) << curve.method;
}

TEST("what grows with a number of entries is predicted along a line, from none of them on") {
    CostCurve bodies = line("bodies", {{0, 0.010, 0.40, 1}, {10, 0.012, 0.60, 1}});
    bodies.counts = true, bodies.grain = 1;
    const auto five = predict(bodies, 5);
    ASSERT_TRUE(five);
    EXPECT_DOUBLE_EQ(five->seconds_per_second, 0.5);
    EXPECT_NEAR(five->error, std::sqrt(0.010 * 0.012), 1e-12);
}

TEST("a budget and an error are read with their units, or refused") {
    EXPECT_DOUBLE_EQ(parse_seconds("16ms"), 0.016);
    EXPECT_DOUBLE_EQ(parse_seconds("0.5 s"), 0.5);
    EXPECT_DOUBLE_EQ(parse_error("2%"), 0.02);
    EXPECT_DOUBLE_EQ(parse_error("0.03"), 0.03);
    for (const char* wrong : {"16", "ms", "-1ms", "16 apples"}) EXPECT_THROW((void)parse_seconds(wrong), BadInput) << wrong;
    for (const char* wrong : {"", "two", "0", "2 apples"}) EXPECT_THROW((void)parse_error(wrong), BadInput) << wrong;
}

// Between two entries nothing can be left out.
TEST("every ready study has a method with three settings or more at ci size, so that its table can be held against itself") {
    for (const auto& folder : find_studies(WEIR_SOURCE_DIR "/cases")) {
        const Study study = read_study(folder, Size::ci);
        const auto enough = [](const Variant& v) { return v.runs() >= 3; };
        EXPECT_TRUE(std::any_of(study.methods.begin(), study.methods.end(), enough)) << study.name;
    }
}

// Factors 1.5 in time and 2 in error: what a recommendation may be off by and still be of use. A power or a factor between two entries
// cannot be worse than the root of what separates them; a table with wide steps fails here, and wants more entries. Errors below what a
// reference is known to are alike.
TEST("an entry left out of a published table is predicted within a factor 1.5 in time and 2 in error") {
    const std::filesystem::path tables = std::filesystem::path(WEIR_SOURCE_DIR) / "results" / "cost", cases = WEIR_SOURCE_DIR "/cases";
    int predicted = 0, declined = 0;
    for (const auto& entry : std::filesystem::directory_iterator(tables / "csv")) {
        const Study study = read_study(cases / entry.path().stem(), Size::ci);
        for (const CostCurve& curve : read_cost_table(study, tables))
            for (std::size_t i = 1; i + 1 < curve.points.size(); ++i) {
                CostCurve rest = curve;
                const Priced left_out = rest.points[i];
                rest.points.erase(rest.points.begin() + static_cast<std::ptrdiff_t>(i));
                const auto found = predict(rest, left_out.setting);
                if (!found) {
                    ++declined;
                    continue;
                }
                ++predicted;
                const std::string name = study.name + " " + curve.method + " " + std::to_string(left_out.setting);
                EXPECT_LT(factor(found->ms_per_step, left_out.ms_per_step), 1.5) << name;
                EXPECT_LT(factor(found->seconds_per_second, left_out.seconds_per_second), 1.5) << name;
                EXPECT_LT(factor(study.told(found->error), study.told(left_out.error)), 2) << name;
            }
    }
    EXPECT_GT(predicted, declined) << "a table that declines most of its own entries recommends nothing";
}

}  // namespace weir::validation::recommend_tests
