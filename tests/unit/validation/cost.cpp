// From cost.toml to the table, the front, the sentences and the page, on a solver whose numbers are known.
#include "validation/cost/command.hpp"
#include "validation/cost/report_table.hpp"

#include "core/error.hpp"
#include "validation/cost/tables.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

using namespace weir;
using namespace weir::validation;
namespace fs = std::filesystem;

namespace {

const std::string head = "question = \"q\"\nerror = \"velocity.max\"\ngood_enough = 2.2\nwhy = \"w\"\n";
const std::string methods =
    "[[methods]]\nname = \"a\"\nsweep = { key = \"grid.cells\", values = [8, 16], ci = [8] }\n"
    "[[methods]]\nname = \"late\"\nset = [\"fail_at = 2\"]\n";

fs::path add(const fs::path& root, const std::string& text) {
    const fs::path folder = root / "study";
    fs::create_directories(folder);
    std::ofstream(folder / "cost.toml") << text;
    std::ofstream(folder / "case.toml") << "question = \"q\"\nblind_to = \"b\"\nkind = \"exact\"\n"
                                           "accept = [{ metric = \"steps\", at_least = 1, why = \"w\" }]\n";
    std::ofstream(folder / "scene.toml") << "solver = \"fake\"\ndim = 2\ngrid = { cells = [8, 4], size = [1, 1] }\ntime = { end = 0.1 }\n";
    return folder;
}

std::string read(const fs::path& file) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

CostPoint point(const std::string& method, real error, double seconds) {
    return {.method = method, .error = error, .seconds_per_second = seconds, .ms_per_step = 1};
}

std::string refusal(const std::string& text) {
    try {
        parse_study(text, "cost.toml", "cases/sample", Size::ci);
    } catch (const BadInput& wrong) {
        return wrong.what();
    }
    return "accepted";
}

}  // namespace

TEST("a study is read at the asked size; what is wrong in it is named") {
    const Study full = parse_study(head + methods, "cost.toml", "cases/sample", Size::full);
    const Study ci = parse_study(head + methods, "cost.toml", "cases/sample", Size::ci);
    ASSERT_EQ(full.methods.size(), 2u);
    EXPECT_EQ(full.methods[0].runs(), 2u);
    EXPECT_EQ(ci.methods[0].runs(), 1u);
    EXPECT_EQ(ci.error, "velocity.max");
    EXPECT_NE(refusal("question = \"q\"\nerror = \"e\"\ngood_enough = 1\n").find("\"good_enough\" needs a \"why\""), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n").find("error"), std::string::npos);
    EXPECT_NE(refusal(head + "methodes = 1\n").find("methods"), std::string::npos) << "the nearest name is offered";
}

TEST("the front holds the points that no other beats in both error and time; failures and equals are not on it twice") {
    std::vector<CostPoint> points = {point("cheap", 0.5, 1), point("dominated", 0.6, 2), point("accurate", 0.1, 4),
                                     point("failed", 0.01, 0.1)};
    points[3].failure = "diverged at step 41";
    mark_front(points, Price::second);
    EXPECT_TRUE(points[0].on_front && points[2].on_front);
    EXPECT_FALSE(points[1].on_front || points[3].on_front);
}

TEST("the sentences name the cheapest setting that is good enough, the best in real time, the price of accuracy and the failures") {
    StudyResult result{.study = {.name = "s", .error = "e", .good_enough = 0.2}};
    result.points = {point("coarse", 0.5, 0.5), point("fine", 0.1, 2), point("other", 0.15, 8), point("bad", 0, 0)};
    result.points[3].failure = "diverged";
    mark_front(result.points, Price::second);
    const auto sentences = advice(result);
    ASSERT_EQ(sentences.size(), 4u);
    EXPECT_EQ(
        sentences[0],
        "For e <= 0.2 take fine: 33.3 ms of each 16.7 ms frame (0.5 times real time); the next method, other, costs 4 times as much.");
    EXPECT_EQ(sentences[1],
              "1 of 3 settings run in real time; the most accurate of them is coarse: e = 0.5, for 8.33 ms of each 16.7 ms frame.");
    EXPECT_EQ(sentences[2], "From coarse, the cheapest, to fine, the most accurate, the error falls 5 times for 4 times the time.");
    EXPECT_EQ(sentences[3], "1 of 4 settings failed: see the table.");
    result.study.good_enough = 0.01;
    EXPECT_EQ(advice(result)[0],
              "No setting reaches e = 0.01; fine comes nearest with 0.1, for 33.3 ms of each 16.7 ms frame (0.5 times real time).");
}

TEST("where most methods gain nothing from a dearer setting the third sentence says so") {
    StudyResult result{.study = {.name = "s", .error = "e"}};
    for (const char* method : {"a", "b", "c"})
        for (const int setting : {1, 2}) {
            result.points.push_back(point(method, setting == 1 ? 0.1 : *method == 'c' ? 0.05 : 0.2, setting * (*method == 'a' ? 1 : 3)));
            result.points.back().setting = std::to_string(setting);
        }
    for (CostPoint& p : result.points)
        if (p.method == "b" && p.setting == "2") p.seconds_per_second = 15;
    mark_front(result.points, Price::second);
    EXPECT_EQ(advice(result).back(),
              "A finer setting does not pay here: the dearest of 2 of 3 methods is no more accurate than its cheapest, at 2 to 5 times the "
              "price.");
    result.points[1].error = 0.01;  // now most methods gain
    EXPECT_EQ(advice(result).back().substr(0, 4), "From");
}

TEST("the command writes table, JSON, figure and page; a setting that fails stays in them with its step") {
    const test::TemporaryFolder folder;
    const auto study = add(folder.path(), head + methods);
    CostOptions options{
        .names = {study.string()}, .size = Size::full, .out = folder.path() / "out", .publish = folder.path() / "page", .quiet = true};
    EXPECT_EQ(cost_command(options, test::fake_kinds()), exit_success);
    const auto json = nlohmann::json::parse(read(folder.path() / "out/study.json"));
    ASSERT_EQ(json["points"].size(), 3u);
    EXPECT_NEAR(json["points"][0]["error"].get<double>(), 2.1, 1e-9) << "2 y + t at y = 1, t = 0.1";
    EXPECT_GT(json["points"][0]["seconds_per_second"].get<double>(), 0);
    EXPECT_NE(json["points"][2]["failure"].get<std::string>().find("step 2"), std::string::npos);
    EXPECT_NE(read(folder.path() / "out/study.csv").find("late"), std::string::npos);
    EXPECT_NE(read(folder.path() / "out/study.svg").find("Pareto front"), std::string::npos);
    EXPECT_NE(read(folder.path() / "page/index.md").find("failed: "), std::string::npos);
    EXPECT_TRUE(fs::exists(folder.path() / "page/svg/study.svg"));
}

TEST("--vary replaces a sweep, multiplies methods by words, and refuses what no scene takes") {
    const test::TemporaryFolder folder;
    Study study = read_study(add(folder.path(), head + methods), Size::ci);
    vary(study, {"grid.cells=8,16,32", "time.max_dt=0.01,0.02"}, test::fake_kinds());
    ASSERT_EQ(study.methods.size(), 4u) << "two methods, each with two largest steps";
    EXPECT_EQ(study.methods[0].runs(), 3u);
    EXPECT_EQ(study.methods[1].name, "a time.max_dt=0.02");
    EXPECT_THROW(vary(study, {"sheme=1"}, test::fake_kinds()), BadInput);
    EXPECT_THROW(vary(study, {"no values"}, test::fake_kinds()), BadInput);
}

TEST("the report's figures stand beside ours: frames a second of whole steps, milliseconds of passes that there are") {
    const test::TemporaryFolder folder;
    add(folder.path(), head + methods);  // for its scene
    const std::string top =
        "question = \"q\"\ntheir_machine = \"theirs\"\nreading = \"r\"\n[[rows]]\nwhat = \"w\"\ntheirs = \"over 30\"\nvalue = 30\non = "
        "\"CPU\"\nset = [\"time.end = 100\"]\n";
    const auto measured = [&](const std::string& row) {
        return measure_report_table(parse_report_table(top + row, "table.toml", folder.path() / "study"), test::fake_kinds());
    };
    const auto steps = measured("")["rows"][0], pass = measured("passes = [\"fake\"]\n")["rows"][0];
    EXPECT_NEAR(steps["times"].get<double>(), steps["ours"].get<double>() / 30, 1e-9);
    EXPECT_EQ(pass["unit"], "ms");
    EXPECT_NEAR(pass["times"].get<double>(), 30 / pass["ours"].get<double>(), 1e-6 * pass["times"].get<double>());
    EXPECT_THROW(measured("passes = [\"none such\"]\n"), BadInput);
    const std::string page = report_table_markdown(measured(""));
    EXPECT_NE(page.find("The report: theirs. Weir: commit"), std::string::npos) << "both machines are named";
    EXPECT_NO_THROW(read_report_table(fs::path(WEIR_SOURCE_DIR) / "cases/report_table"));
}
