// From cost.toml to the table, the front, the sentences and the page, on a solver whose numbers are known.
#include "validation/cost/command.hpp"
#include "validation/cost/report_table.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "validation/cost/tables.hpp"
#include "validation/page/sections.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

namespace cost_tests {

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

TEST("the price of a setting is the median of its repeats, not the fastest nor the mean") {
    CostPoint point;
    take_times(point, {{.computing = 9, .simulated = 2, .steps = 100},
                       {.computing = 1, .simulated = 2, .steps = 100},
                       {.computing = 2, .simulated = 2, .steps = 100}});
    EXPECT_EQ(point.repeats, 3);
    EXPECT_EQ(point.seconds_per_second, 1);
    EXPECT_EQ(point.ms_per_step, 20);
    EXPECT_EQ(point.spread, 4);
    take_times(point, {{.computing = 9, .simulated = 2, .steps = 100},
                       {.computing = 3, .simulated = 2, .steps = 100},
                       {.computing = 1, .simulated = 2, .steps = 100},
                       {.computing = 5, .simulated = 2, .steps = 100}});
    EXPECT_EQ(point.seconds_per_second, 1.5);
}

TEST("the first step, which fills caches, is not timed where there is another") {
    RunRecord record;
    record.history.resize(5);  // the initial state and four steps
    for (std::size_t i = 1; i < 5; ++i) record.history[i].seconds = i == 1 ? 100 : 1, record.history[i].report.dt = 0.5;
    const Timing t = timing_of(record);
    EXPECT_EQ(t.computing, 3);
    EXPECT_EQ(t.simulated, 1.5);
    EXPECT_EQ(t.steps, 3);
}

TEST("a study is read at the requested size; what is wrong in it is named") {
    const Study full = parse_study(head + methods, "cost.toml", "cases/sample", Size::full);
    const Study ci = parse_study(head + methods, "cost.toml", "cases/sample", Size::ci);
    ASSERT_EQ(full.methods.size(), 2u);
    EXPECT_EQ(full.methods[0].runs(), 2u);
    EXPECT_EQ(ci.methods[0].runs(), 1u);
    EXPECT_EQ(ci.error, "velocity.max");
    EXPECT_NE(refusal("question = \"q\"\nerror = \"e\"\ngood_enough = 1\n").find("\"good_enough\" needs a \"why\""), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\nerror = \"e\"\nknown_to = 1\n").find("\"known_to\" needs a \"known_why\""), std::string::npos);
    EXPECT_NE(refusal(head + "known_to = 3\nknown_why = \"w\"\n").find("\"good_enough\" is below \"known_to\""), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n").find("error"), std::string::npos);
    EXPECT_NE(refusal(head + "methodes = 1\n").find("methods"), std::string::npos) << "the nearest name is offered";
}

TEST("the front holds the points that no other beats in both error and time; failures and equals are not on it twice") {
    std::vector<CostPoint> points = {point("cheap", 0.5, 1), point("dominated", 0.6, 2), point("accurate", 0.1, 4),
                                     point("failed", 0.01, 0.1)};
    points[3].failure = "diverged at step 41";
    mark_front(points, {.name = "s"});
    EXPECT_TRUE(points[0].on_front && points[2].on_front);
    EXPECT_FALSE(points[1].on_front || points[3].on_front);
}

TEST("of errors that cannot be told apart the cheaper one is on the front: below what the reference is known to, or alike to a twentieth") {
    std::vector<CostPoint> points = {point("cheap", 0.08, 1), point("alike", 0.0795, 2), point("known", 0.04, 3), point("below", 0.01, 4)};
    mark_front(points, {.name = "s", .known_to = 0.05});
    EXPECT_TRUE(points[0].on_front && points[2].on_front);
    EXPECT_FALSE(points[1].on_front) << "0.6% more accurate for twice the time";
    EXPECT_FALSE(points[3].on_front) << "the reference does not know";
    mark_front(points, {.name = "s"});
    EXPECT_TRUE(points[3].on_front) << "a reference without a limit does";
}

TEST("what the reference cannot tell is said, and no setting is called the most accurate for it") {
    StudyResult result{.study = {.name = "s", .error = "e", .good_enough = 0.2, .known_to = 0.05, .known_why = "gates differ"}};
    for (const char* method : {"a", "b", "c"})
        for (const int setting : {1, 2}) {
            result.points.push_back(point(method, setting == 1 ? 0.02 : 0.04, setting * (*method == 'a' ? 0.1 : 0.3)));
            result.points.back().setting = std::to_string(setting);
        }
    mark_front(result.points, result.study);
    const auto sentences = advice(result);
    ASSERT_EQ(sentences.size(), 5u);
    EXPECT_EQ(sentences[1],
              "Interpolated along each method's curve at e = 0.2, in units of the time of a (at most that of its cheapest configuration): "
              "b at most 3, c at most "
              "3.")
        << "neither can be had for the price of a";
    EXPECT_EQ(sentences[2], "6 of 6 configurations run in real time, 6 of them within the reference uncertainty.");
    EXPECT_EQ(sentences[3], "a 1 is the cheapest, and within the reference uncertainty.") << "not: a finer setting does not pay";
    EXPECT_EQ(sentences[4],
              "6 of 6 configurations lie within the reference uncertainty of 0.05, where they cannot be ranked (gates differ); the "
              "cheapest of them is a 1.");
}

TEST("the sentences name the cheapest setting that is good enough, the best in real time, the price of accuracy and the failures") {
    StudyResult result{.study = {.name = "s", .error = "e", .good_enough = 0.2}};
    result.points = {point("coarse", 0.5, 0.5), point("fine", 0.1, 2), point("other", 0.15, 8), point("bad", 0, 0)};
    result.points[3].failure = "diverged";
    mark_front(result.points, result.study);
    const auto sentences = advice(result);
    ASSERT_EQ(sentences.size(), 5u);
    EXPECT_EQ(sentences[0], "For e <= 0.2 take fine: 33.3 ms per frame of 16.7 ms (0.5 times real time).");
    EXPECT_EQ(sentences[1],
              "Interpolated along each method's curve at e = 0.2, in units of the time of fine (at most that of its cheapest "
              "configuration): other at most 4. "
              "Not reached by coarse.");
    EXPECT_EQ(sentences[2],
              "1 of 3 configurations run in real time; the most accurate of them is coarse: e = 0.5, for 8.33 ms of each 16.7 ms frame.");
    EXPECT_EQ(sentences[3],
              "From coarse, the cheapest, to fine, the most accurate, the error falls by a factor of 5 for 4 times the time.");
    EXPECT_EQ(sentences[4], "1 of 4 configurations failed: see the table.");
    result.study.good_enough = 0.01;
    EXPECT_EQ(advice(result)[0],
              "No configuration reaches e = 0.01; the nearest is fine with 0.1, for 33.3 ms per frame of 16.7 ms (0.5 times real time).");
}

TEST("where most methods gain nothing from a more expensive setting the third sentence says so") {
    StudyResult result{.study = {.name = "s", .error = "e"}};
    for (const char* method : {"a", "b", "c"})
        for (const int setting : {1, 2}) {
            result.points.push_back(point(method, setting == 1 ? 0.1 : *method == 'c' ? 0.05 : 0.2, setting * (*method == 'a' ? 1 : 3)));
            result.points.back().setting = std::to_string(setting);
        }
    for (CostPoint& p : result.points)
        if (p.method == "b" && p.setting == "2") p.seconds_per_second = 15;
    mark_front(result.points, result.study);
    EXPECT_EQ(advice(result).back(),
              "Refinement does not pay off here: for 2 of 3 methods the most expensive configuration is no more accurate than the "
              "cheapest, at 2 to 5 times the cost."
              "");
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
    EXPECT_EQ(json["points"][2]["failure"].get<std::string>().substr(0, 21), "diverged at step 2, t");
    EXPECT_NE(read(folder.path() / "out/study.csv").find("late"), std::string::npos);
    EXPECT_NE(read(folder.path() / "out/study.svg").find("Pareto front"), std::string::npos);
    EXPECT_NE(read(folder.path() / "page/index.md").find("| late | diverged at step 2, t = "), std::string::npos);
    EXPECT_NE(read(folder.path() / "page/index.md").find("No reference: the error"), std::string::npos) << "this study has none";
    EXPECT_TRUE(fs::exists(folder.path() / "page/svg/study.svg"));
}

TEST("errors and bytes of a published study are compared with the code: what moved fails, how fast it is does not matter") {
    const test::TemporaryFolder folder;
    const auto study = add(folder.path(), head + methods);
    CostOptions options{
        .names = {study.string()}, .size = Size::full, .out = folder.path() / "out", .publish = folder.path() / "page", .quiet = true};
    ASSERT_EQ(cost_command(options, test::fake_kinds()), exit_success);
    options.size = Size::ci, options.publish = "", options.compare = folder.path() / "page";
    EXPECT_EQ(cost_command(options, test::fake_kinds()), exit_success);
    auto pins = nlohmann::json::parse(read(folder.path() / "page/pins/study.json"));
    ASSERT_EQ(pins["numbers"].size(), 3u) << pins.dump();
    const auto first = pins["numbers"].begin();
    *first = first->get<double>() * 1.01 + 1;
    std::ofstream(folder.path() / "page/pins/study.json") << pins.dump();
    testing::internal::CaptureStderr();
    EXPECT_EQ(cost_command(options, test::fake_kinds()), exit_claim_failed);
    EXPECT_NE(testing::internal::GetCapturedStderr().find(first.key() + " changed by"), std::string::npos);
}

TEST("a backend that is not here leaves its row with the reason, and the study goes on; a method may have threads of its own") {
    const test::TemporaryFolder folder;
    auto kinds = test::fake_kinds();
    kinds[0].make = [make = kinds[0].make](const scene::Scene& scene, const Partition& partition) {
        if (scene.integer("stall_at") == 7) throw BadInput("no OpenCL device here: install one");
        return make(scene, partition);
    };
    const auto study =
        add(folder.path(), head + "[[methods]]\nname = \"here\"\nthreads = 3\n[[methods]]\nname = \"away\"\nset = [\"stall_at = 7\"]\n");
    const int before = threads();
    const StudyResult result = measure_study(read_study(study, Size::ci), {.repeats = 1}, kinds);
    EXPECT_EQ(threads(), before);
    ASSERT_EQ(result.points.size(), 2u);
    EXPECT_EQ(result.points[0].threads, 3);
    EXPECT_EQ(result.points[1].failure.value_or(""), "not run: no OpenCL device here: install one");
    EXPECT_EQ(advice(result).back(), "1 of 2 configurations could not be run here: the table gives the reason.");
    EXPECT_NE(cost_table(result).find("not run: no OpenCL device here: install one"), std::string::npos);
    EXPECT_EQ(notes(result).front(), "here: 3 threads.");
}

TEST("a setting is measured, and its row says so, on the threads that it has work for, whatever the method before it had") {
    const test::TemporaryFolder folder;
    const auto study = add(folder.path(), head + "[[methods]]\nname = \"own\"\nthreads = 3\n[[methods]]\nname = \"small\"\n");
    const int before = set_threads(0);
    const StudyResult result = measure_study(read_study(study, Size::ci), {.repeats = 1}, test::fake_kinds());
    EXPECT_EQ(set_threads(before), 0) << "a study sets it for no later one";
    ASSERT_EQ(result.points.size(), 2u);
    EXPECT_EQ(result.points[0].threads, 3);
    EXPECT_EQ(result.points[1].threads, 1) << "32 cells";
}

TEST("a run that ends with finite nonsense has diverged, where the study says what nonsense is") {
    const test::TemporaryFolder folder;
    const auto study = add(folder.path(), head + "diverged_above = 2.0\ndiverged_why = \"wrong by itself\"\n[[methods]]\nname = \"a\"\n");
    const StudyResult result = measure_study(read_study(study, Size::ci), {.repeats = 1}, test::fake_kinds());
    EXPECT_EQ(result.points.at(0).failure.value_or(""), "diverged by step 5: velocity.max = 2.1 (wrong by itself)");
    EXPECT_NE(refusal(head + "diverged_above = 3\n").find("\"diverged_above\" needs a \"diverged_why\""), std::string::npos);
}

TEST("a figure joins the settings of a method in the study's order, however their prices fell out") {
    StudyResult result{.study = {.name = "s", .error = "e"}};
    result.points = {point("b", 3, 0.3), point("b", 2, 0.1), point("b", 1, 0.2), point("a", 1, 0.01)};
    mark_front(result.points, result.study);
    const Panel panel = cost_panel(cost_json(result));
    ASSERT_EQ(panel.curves.size(), 3u) << "two methods and the front";
    const auto expect = [](const Curve& c, const std::string& label, const std::vector<real>& x, const std::vector<real>& y) {
        EXPECT_EQ(c.label, label);
        EXPECT_EQ(c.y, y);
        ASSERT_EQ(c.x.size(), x.size());
        for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(c.x[i], x[i], 1e-12 * x[i]);
    };
    expect(panel.curves[0], "b", {1 / 0.3, 1 / 0.1, 1 / 0.2}, {3, 2, 1});
    expect(panel.curves[1], "a", {1 / 0.01}, {1});
}

TEST("a device is named with its settings, so that a processor is not taken for a GPU") {
    StudyResult result{.study = {.name = "s", .error = "e"}};
    result.points = {point("pbf-opencl", 0.1, 1)};
    result.points[0].setting = "64", result.points[0].device = "a processor (CPU, 2 units)", result.points[0].device_kind = "CPU";
    mark_front(result.points, result.study);
    EXPECT_EQ(result.points[0].name(), "pbf-opencl 64 (on CPU)");
    EXPECT_EQ(notes(result).front(), "pbf-opencl: a processor (CPU, 2 units); this is no GPU.");
    EXPECT_EQ(cost_panel(cost_json(result)).curves.at(0).label, "pbf-opencl (on CPU)");
}

TEST("--vary replaces a sweep, multiplies methods by words, and refuses what no scene takes") {
    const test::TemporaryFolder folder;
    Study study = read_study(add(folder.path(), head + methods), Size::ci);
    vary(study, {"grid.cells=8,16,32", "time.max_dt=0.01,0.02"}, test::fake_kinds());
    ASSERT_EQ(study.methods.size(), 4u) << "two methods, each with two largest steps";
    EXPECT_EQ(study.methods[0].runs(), 3u);
    EXPECT_EQ(study.methods[1].name, "a time.max_dt=0.02");
    EXPECT_THROW(vary(study, {"sheme=1"}, test::fake_kinds()), BadInput);
    EXPECT_THROW(vary(study, {"time.stepp=1"}, test::fake_kinds()), BadInput);
    EXPECT_THROW(vary(study, {"no values"}, test::fake_kinds()), BadInput);
}

TEST("--vary leaves a method alone whose solver does not know the key, and refuses a value that none takes") {
    const test::TemporaryFolder folder;
    const auto at = add(folder.path(), head + "[[methods]]\nname = \"a\"\n[[methods]]\nname = \"b\"\nscene = \"other.toml\"\n");
    std::ofstream(at / "other.toml") << "solver = \"other\"\ndim = 2\ngrid = { cells = [8, 4], size = [1, 1] }\ntime = { end = 0.1 }\n";
    auto kinds = test::fake_kinds();
    kinds.push_back(kinds[0]);
    kinds[1].schema.name = "other";
    const scene::Key backend{.name = "backend", .type = scene::Type::choice, .doc = "d", .choices = {"threads", "opencl"}};
    kinds[1].schema.keys.push_back({.name = "scheme", .type = scene::Type::table, .doc = "d", .keys = {backend}});
    Study study = read_study(at, Size::ci);
    vary(study, {"backend=threads,opencl"}, kinds);
    ASSERT_EQ(study.methods.size(), 3u);
    EXPECT_EQ(study.methods[0].name, "a");
    EXPECT_EQ(study.methods[2].name, "b backend=opencl");
    EXPECT_THROW(vary(study, {"backend=opnecl"}, kinds), BadInput);
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

}  // namespace cost_tests
