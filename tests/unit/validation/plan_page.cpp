// The page of a plan: every configuration and the recommendation stand in it, and no text of a scene is HTML.
#include "validation/uncertainty/scene_plan.hpp"

#include <fmt/format.h>

#include "support/test.hpp"

namespace plan_page_tests {

using namespace weir;
using namespace weir::validation;

namespace {

const std::string hostile = "<script>alert('&\"')</script>";
const std::string harmless = "&lt;script&gt;alert('&amp;&quot;')&lt;/script&gt;";

/// Grids of 10, 20 and 40 cells whose probe "a" ends with 1.04, 1.02 and 1.01, at 1, 4 and 16 ms per frame.
MethodStudy study_of(const std::string& name) {
    MethodStudy study{.method = {.name = name, .solver = "mac_water", .formal_order = 1}};
    for (int i = 0; i < 3; ++i) {
        const int n = 10 << i;
        GridRun run{.grid = {.number = n, .cells = {n, 1}, .h = 1.0 / n}};
        run.run = {.series = {{"a.height", "m", false, {.label = "a", .x = {0, 1}, .y = {0, 1 + 0.04 / (1 << i)}}}},
                   .seconds = 0.5,
                   .ms_per_step = static_cast<double>(1 << 2 * i),
                   .steps = 1,
                   .end = 1};
        study.grids.push_back(run);
    }
    return study;
}

ScenePlan plan_of(const std::string& error, const std::string& name = "mac_water") {
    ScenePlan plan{.name = "tank", .file = "tank.toml", .title = "A tank", .command = "weir plan tank.toml"};
    plan.asked = parse_asked({"a.height"}), plan.wishes = {parse_wish(error)};
    plan.methods.push_back({.study = study_of(name)});
    plan.methods.push_back({.study = study_of("pbf")});
    for (PlannedMethod& m : plan.methods) assess(m.study, plan.asked);
    plan.methods[1].apart = Apart{.distance = 2, .bands = 1, .of = "a.height", .unit = "m"};
    plan.take = recommended(plan);
    return plan;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
    return n;
}

void expect_in(const std::string& page, const std::string& part) { EXPECT_NE(page.find(part), std::string::npos) << part; }

}  // namespace

TEST("the page of a plan has a row per configuration, the recommendation and the command that runs it") {
    ScenePlan plan = plan_of("0.03");  // 20 cells: .01 from the finest, whose band is .015
    const std::string page = plan_page(plan, "");
    for (const char* cells : {"10 x 1", "20 x 1", "40 x 1"}) EXPECT_EQ(count(page, fmt::format(">{}</td>", cells)), 2u) << cells;
    for (const char* value : {">1.040 m</td>", ">1.020 m</td>", ">1.010 m</td>"}) EXPECT_EQ(count(page, value), 2u) << value;
    EXPECT_EQ(count(page, ">recommended</span></td>"), 1u);
    EXPECT_EQ(count(page, "<tr class=\"front\"><td>mac_water</td><td class=\"n\" data-key=\"20\">20 x 1</td>"), 1u);
    EXPECT_EQ(count(page, ">error too large</span></td>"), 1u);
    EXPECT_EQ(count(page, ">meets the request</span></td>"), 1u);
    EXPECT_EQ(count(page, ">other equations</span></td>"), 3u);
    expect_in(page, "<p class=\"big pass\">mac_water, 20 x 1 cells</p>");
    expect_in(page, "<code>" + run_line(plan, *plan.take) + "</code>");
    expect_in(page, "<code>weir plan tank.toml</code>");
    plan.methods.push_back({.study = {.method = {.name = "waves"}, .solver_fails = "no waves\nat line 1"}});
    expect_in(plan_page(plan, ""), ">cannot run</span></td><td class=\"n\">–</td><td>no waves</td>");
}

TEST("a refused plan has its reason on the page, and no command that runs it") {
    const std::string page = plan_page(plan_of("0.001"), "");
    expect_in(page, "<p class=\"big no\">None</p>");
    expect_in(page, "mac_water a.height is known to 15 mm at 16 ms per frame");
    EXPECT_EQ(page.find("weir run"), std::string::npos);
    EXPECT_EQ(count(page, ">error too large</span></td>"), 3u);
}

TEST("texts of a scene are escaped wherever they stand on the page") {
    ScenePlan plan = plan_of("0.03", hostile);
    plan.title = plan.file = plan.command = hostile;
    plan.set = {{hostile, hostile}};
    plan.methods[0].study.left_out = plan.methods[0].study.twin = hostile;
    plan.methods[0].study.grids[0].run.warnings = {hostile}, plan.methods[0].study.grids[1].run.failure = hostile;
    plan.methods[0].study.quantities[0].not_refined = {hostile}, plan.methods[0].study.quantities[0].refused = hostile;
    plan.methods[1].study.quantities[0].values[0].unknown = hostile, plan.methods[1].apart->of = hostile;
    plan.methods.push_back({.study = {.method = {.name = "waves"}, .solver_fails = hostile}});
    for (const bool taken : {true, false}) {
        if (!taken) plan.take.reset();
        const std::string page = plan_page(plan, "");
        EXPECT_EQ(page.find("<script>alert"), std::string::npos) << page.substr(page.find("<script>alert") - 200, 300);
        EXPECT_GE(count(page, harmless), 20u);
    }
}

TEST("the page of a plan carries its figure, and loads no file from elsewhere") {
    const std::string page = plan_page(plan_of("0.03"), "<?xml?><svg><circle id='a'/></svg>");
    expect_in(page, "<svg><circle id='plan-a'/></svg>");
    for (const char* elsewhere : {"src=", "href=\"http", "@import", "<link rel=\"stylesheet\""})
        EXPECT_EQ(page.find(elsewhere), std::string::npos) << elsewhere;
}

TEST("the command of a plan quotes its words for the shell") {
    const ScenePlanOptions options{
        .scene = "my tank.toml", .set = {{"time.end", "1"}}, .of = {"a.height"}, .error = {"5%"}, .budget = "4ms"};
    EXPECT_EQ(plan_line(options), "weir plan 'my tank.toml' --of a.height --error 5% --budget 4ms --set time.end=1");
}

}  // namespace plan_page_tests
