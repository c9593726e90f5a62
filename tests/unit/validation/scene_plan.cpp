// Bounds of grids and the advice that follows, on ladders made by hand.
#include "validation/uncertainty/scene_plan.hpp"

#include "core/error.hpp"
#include "sim/registry.hpp"
#include "support/test.hpp"
#include "validation/uncertainty/other_influences.hpp"

namespace scene_plan_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// Grids of 10, 20 and 40 cells whose probe "a" ends with these values, at 1, 4 and 16 ms per frame.
MethodStudy study_of(const std::vector<real>& values, const std::string& name = "mac_water") {
    MethodStudy study{.method = {.name = name, .solver = "mac_water", .formal_order = 1}};
    real n = 10, ms = 1;
    for (const real value : values) {
        GridRun run{.grid = {.number = static_cast<int>(n), .cells = {static_cast<int>(n), 1}, .h = 1 / n}};
        run.run = {.series = {{"a.height", "m", false, {.label = "a", .x = {0, 1}, .y = {0, value}}}},
                   .ms_per_step = ms,
                   .seconds_per_second = 0,
                   .steps = 1,
                   .end = 1};
        study.grids.push_back(run);
        n *= 2, ms *= 4;
    }
    return study;
}

ScenePlan plan_of(std::vector<MethodStudy> studies, const std::string& error) {
    ScenePlan plan;
    plan.asked = parse_asked({"a.height"});
    if (!error.empty()) plan.wishes = {parse_wish(error)};
    for (MethodStudy& study : studies) {
        assess(study, plan.asked);
        plan.methods.push_back({.study = std::move(study)});
    }
    return plan;
}

}  // namespace

TEST("the bound of a coarser grid is its distance to the finest and the finest's band") {
    MethodStudy study = study_of({1.4, 1.2, 1.1});  // order 1: the limit is 1, and the finest is .1 off
    const auto asked = parse_asked({"a.height"});
    assess(study, asked);
    const QuantityStudy& q = study.quantities.at(0);
    EXPECT_NEAR(q.width, 0.15, 1e-9);  // 1.5 times the error
    EXPECT_NEAR(q.error.at(0), 0.45, 1e-9);
    EXPECT_NEAR(q.error.at(1), 0.25, 1e-9);
    EXPECT_NEAR(q.error.at(2), 0.15, 1e-9);
    study.quantities[0].step = 0.04, study.quantities[0].seeds = 0.08;  // on the coarsest grid, which is four times coarser
    assess(study, asked);
    EXPECT_NEAR(study.quantities[0].width, 0.15 + 0.01 + 0.02, 1e-9);
}

TEST("the cheapest grid is taken of which all finer ones meet the wish") {
    const auto taken = [](const ScenePlan& plan) {
        const auto choice = recommended(plan);
        return choice ? static_cast<int>(choice->grid) : -1;
    };
    const std::vector<real> values{1.04, 1.02, 1.01};
    EXPECT_EQ(taken(plan_of({study_of(values)}, "0.05")), 0);
    EXPECT_EQ(taken(plan_of({study_of(values)}, "0.03")), 1);
    EXPECT_EQ(taken(plan_of({study_of(values)}, "0.02")), 2);
    EXPECT_EQ(taken(plan_of({study_of(values)}, "0.01")), -1);
    // U = 2 x .05 on the finest grid, .15 on the next; the coarsest equals the finest by accident
    EXPECT_EQ(taken(plan_of({study_of({1.01, 1.06, 1.01})}, "0.125")), 2);
    ScenePlan plan = plan_of({study_of(values)}, "");
    plan.limits.budget = 5e-3;
    EXPECT_EQ(taken(plan), 1) << "without a wish: the most accurate within the budget";
    plan = plan_of({study_of(values)}, "0.03");
    plan.limits.budget = 2e-3;
    EXPECT_EQ(taken(plan), -1);
}

TEST("methods of other equations and values that are refused are not recommended") {
    ScenePlan plan = plan_of({study_of({1.04, 1.02, 1.01}), study_of({1.001, 1.001, 1.001}, "shallow_water")}, "0.025");
    EXPECT_EQ(recommended(plan)->method, 1u);
    plan.methods[1].apart = Apart{.distance = 2, .bands = 1};
    EXPECT_EQ(recommended(plan)->method, 0u);
    plan.methods[0].study.grids[1].run.balanced = false;
    EXPECT_EQ(recommended(plan)->grid, 2u);
    plan.methods[0].study.quantities[0].refused = "chaotic";
    EXPECT_FALSE(recommended(plan).has_value());
}

TEST("a band wider than a fifth of the scale and a value that one grid does not know are refused") {
    MethodStudy wide = study_of({1.8, 1.4, 1.2});  // U = .3 of a range of 1.2
    const auto asked = parse_asked({"a.height"});
    assess(wide, asked);
    EXPECT_NE(wide.quantities[0].refused.find("25% of its range"), std::string::npos) << wide.quantities[0].refused;
    assess(wide, asked, {parse_wish("0.4")});
    EXPECT_EQ(wide.quantities[0].refused, "") << "an absolute error decides by itself";
    MethodStudy unknown = study_of({1.4, std::nan(""), 1.1});
    assess(unknown, asked);
    EXPECT_NE(unknown.quantities[0].refused.find("not known on 20 x 1 cells"), std::string::npos) << unknown.quantities[0].refused;
    MethodStudy few = study_of({1.4, 1.2});
    assess(few, asked);
    EXPECT_NE(few.quantities[0].refused.find("fewer than three"), std::string::npos);
    EXPECT_THROW(value_of(few.grids[0].run, parse_asked({"b"})[0], 0), BadInput);
}

TEST("after chaos single values are refused, and earlier ones stay") {
    MethodStudy study = study_of({1.04, 1.02, 1.01});
    assess(study, parse_asked({"a.height@0.5"}));
    study.chaotic_after = 0.6, study.twin = "gravity changed by one millionth";
    EXPECT_FALSE(refuse_after_chaos(study));
    EXPECT_EQ(study.quantities[0].refused, "");
    assess(study, parse_asked({"a.height"}));
    EXPECT_TRUE(refuse_after_chaos(study));
    EXPECT_NE(study.quantities[0].refused.find("chaotic after t = 0.6 s"), std::string::npos);
}

TEST("the mean of a chaotic flow gets the interval of its six parts") {
    MethodStudy study = study_of({1, 1, 1});
    for (GridRun& g : study.grids) {
        Curve& c = g.run.series[0].curve;
        c.x.clear(), c.y.clear();
        for (int i = 0; i <= 60; ++i) c.x.push_back(i / 60.0), c.y.push_back(i / 60.0);  // means of the parts: 1/12, 3/12, .. 11/12
    }
    assess(study, parse_asked({"a.height.mean"}));
    study.chaotic_after = 0.1;
    EXPECT_FALSE(refuse_after_chaos(study));
    const real deviation = std::sqrt((25 + 9 + 1) * 2 / 144.0 / 5);
    EXPECT_NEAR(study.quantities[0].width, 2.571 * deviation / std::sqrt(6.0), 1e-9);
    EXPECT_NE(study.quantities[0].refused.find("take a longer window"), std::string::npos);
}

TEST("a series at the level of round-off is measured by the largest of its unit") {
    MethodStudy study = study_of({1e-14, -3e-14, 2e-14});
    for (GridRun& g : study.grids) g.run.series.push_back({"b.height", "m", false, {.label = "b", .x = {0, 1}, .y = {0, 2}}});
    assess(study, parse_asked({"a.height"}));
    EXPECT_EQ(study.quantities[0].finest().scale, 2);
    EXPECT_EQ(study.quantities[0].refused, "");
}

TEST("a curve has values at all its times: the last one is not after the end by round-off") {
    for (const real end : {0.1, 0.3, 0.7, 1.1, 1.3, 2.9}) {
        RecordedRun run = study_of({1}).grids[0].run;
        run.series[0].curve.x = {0.01 * end, end};
        EXPECT_EQ(value_of(run, parse_asked({"a.height.curve"})[0], 0).unknown, "") << end;
    }
}

TEST("a plan of which methods fail, on any grid, is printed") {
    MethodStudy fails{.method = {.name = "waves", .solver = "waves"}, .solver_fails = "no waves"};
    MethodStudy first = study_of({1.4});
    first.grids[0].run.failure = "not finished after 1 s of computing";
    ScenePlan plan = plan_of({study_of({1.8, 1.4, 1.2}), first}, "0.1%");
    plan.methods.push_back({.study = fails});
    const std::string text = plan_text(plan);
    EXPECT_NE(text.find("waves: no waves"), std::string::npos) << text;
    EXPECT_NE(text.find("not finished after 1 s"), std::string::npos) << text;
    EXPECT_NE(text.find("no configuration of the ladder meets this"), std::string::npos) << text;
    EXPECT_NO_THROW(plan_json(plan));
}

TEST("a finest grid that exceeds the time limit is left out, and the coarser ones keep their bounds; a numerical failure stays") {
    const auto asked = parse_asked({"a.height"});
    const auto ends = [&](double seconds, std::vector<real> values) {
        MethodStudy study = study_of(values);
        RecordedRun& finest = study.grids.back().run;
        finest.failure = "not finished", finest.seconds = seconds;
        const bool left_out = leave_out_unfinished(study, 120);
        assess(study, asked);
        EXPECT_EQ(left_out, !study.left_out.empty());
        return study;
    };
    const MethodStudy slow = ends(121, {1.4, 1.2, 1.1, 7});
    ASSERT_EQ(slow.grids.size(), 3U);
    EXPECT_EQ(slow.left_out, "80 x 1 cells: not finished");
    EXPECT_NEAR(slow.quantities.at(0).width, 0.15, 1e-9) << "that of the three grids before";
    const MethodStudy broken = ends(119, {1.4, 1.2, 1.1, 7});
    EXPECT_EQ(broken.grids.size(), 4U);
    EXPECT_NE(broken.quantities.at(0).refused, "");
    EXPECT_EQ(ends(121, {1.4, 1.2, 1.1}).grids.size(), 3U) << "two grids have no band";
}

TEST("wishes are parts of a scale or have a unit") {
    const Value height{.samples = {0.4}, .unit = "m", .scale = 0.1};
    EXPECT_NEAR(absolute(parse_wish("5%"), height), 0.005, 1e-15);
    EXPECT_NEAR(absolute(parse_wish("2mm"), height), 0.002, 1e-15);
    EXPECT_NEAR(absolute(parse_wish("0.02"), height), 0.02, 1e-15);
    EXPECT_THROW(absolute(parse_wish("2ms"), height), BadInput);
    EXPECT_THROW(parse_wish("-1%"), BadInput);
    for (const char* wrong : {"wide", "5%%", "1,5%", "2mm,3mm", "inf", "nan"}) EXPECT_THROW(parse_wish(wrong), BadInput) << wrong;
    EXPECT_EQ(text_with_unit(0.3468, "m", 0.0017), "346.8 mm");
    EXPECT_EQ(text_with_unit(1.2, "m", 0.01), "1.200 m");
    EXPECT_EQ(text_with_unit(23456, "Pa", 100), "23.46 kPa");
}

TEST("a kept run is read back as it was") {
    RecordedRun run = study_of({1.5}).grids[0].run;
    run.series[0].curve.y[0] = std::nan("");
    run.cells = {10, 1}, run.failure = "no", run.measured["x"] = 2.5, run.warnings = {"w"}, run.balanced = false;
    const RecordedRun back = run_from_json(to_json(run));
    EXPECT_EQ(to_json(back), to_json(run));
    EXPECT_TRUE(std::isnan(back.series[0].curve.y[0]));
    EXPECT_EQ(back.series[0].curve.y[1], 1.5);
    EXPECT_THROW(run_from_json("{}"), BadInput);
    EXPECT_THROW(run_from_json("nonsense"), BadInput);
}

}  // namespace scene_plan_tests
