// The advice of `weir plan`, followed: for every study, configurations that it can recommend (two, or all at full size) are measured,
// requested, run by the line that it prints, and compared with what it promised.
// WEIR_PLAN_TABLES names a folder of tables that are taken as they stand (the published ones, or full-size ones), in place of fresh ones:
// errors are judged, milliseconds only told, for they may be another machine's.
#include "validation/cost/plan.hpp"

#include "output/atomic_file.hpp"
#include "output/machine.hpp"
#include "support/size.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"
#include "validation/cost/calibrate.hpp"
#include "validation/cost/measure.hpp"
#include "validation/cost/tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <sys/wait.h>
#include <nlohmann/json.hpp>

namespace weir::validation {
namespace {

namespace fs = std::filesystem;
using weir::test::TemporaryFolder;

const fs::path cases = WEIR_SOURCE_DIR "/cases", published = WEIR_SOURCE_DIR "/results/cost";

struct Answer {
    int code = -1;
    std::string text;
};

/// A line as a user types it, in `folder`, with the executable of this build as "weir".
Answer shell(const fs::path& folder, const std::string& line) {
    const fs::path log = folder / "said.log", script = folder / "line.sh";
    std::ofstream(script) << "cd '" << folder.string() << "' || exit 99\nPATH='" << fs::path(WEIR_EXECUTABLE).parent_path().string()
                          << "':$PATH\n"
                          << line << "\n";
    const int status = std::system(fmt::format("sh '{}' > '{}' 2>&1", script.string(), log.string()).c_str());
    std::ifstream in(log);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, {std::istreambuf_iterator<char>(in), {}}};
}

std::string line_that_begins(const std::string& text, const std::string& with) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(with)) return line;
    return "";
}

Budget budget_of(const Study& study) { return {.known_to = study.known_to}; }

CostPoint measured_now(const Study& study, const CostCurve& curve, const Priced& row) {
    Study one = study_of_row(study, curve.method, row.index);
    one.methods.front().threads = row.threads;
    const MeasureOptions options{.repeats = 3, .enough_seconds = 0.3, .least_seconds = 0.05, .most_repeats = 5};
    return measure_study(one, options, sim::registry()).points.front();
}

/// The configurations that are followed: all at full size; otherwise the least expensive and the one in the middle.
std::vector<Choice> followed_of(std::vector<Choice> rows) {
    if (rows.size() <= 2 || full_size()) return rows;
    return {rows.front(), rows[rows.size() / 2]};
}

/// Tables of this machine and of this build, with the configurations that the published ones recommend.
fs::path fresh_tables(const Study& study, const fs::path& folder) {
    StudyResult result{.study = study, .points = {}};
    const auto curves = read_cost_table(study, published);
    for (const Choice& row : followed_of(recommendable(curves, study.price, budget_of(study))))
        result.points.push_back(measured_now(study, *row.curve, row.at));
    nlohmann::json json = cost_json(result);
    json["machine"] = output::this_machine().processor;
    output::write_file(folder / (study.name + ".csv"), cost_csv(result));
    output::write_file(folder / (study.name + ".json"), json.dump());
    return folder;
}

struct Count {
    int followed = 0, met = 0, judged = 0;
    std::vector<double> ratios{};  // milliseconds of the run over those promised
};

/// The numbers that a run measured of itself, from the only run.json below `folder`.
nlohmann::json measured_by_run(const fs::path& folder) {
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().filename() == "run.json") {
            std::ifstream in(entry.path());
            return nlohmann::json::parse(in).at("measured");
        }
    return {};
}

/// Asks for exactly this row and follows the answer; the numbers of the run.
nlohmann::json followed(const Study& study, const fs::path& tables, const Choice& row, const fs::path& work) {
    const std::string question =
        fmt::format("weir plan '{}' --tables '{}' --as-measured --error {:.12g} --budget '{:.12g} s'", study.folder.string(),
                    tables.string(), study.told(row.at.error) * (1 + 1e-9), row.seconds * (1 + 1e-9));
    const Answer advice = shell(work, question);
    EXPECT_EQ(advice.code, 0) << question << "\n" << advice.text;
    const std::string line = line_that_begins(advice.text, "weir run ");
    EXPECT_NE(line_that_begins(advice.text, "take " + row.curve->method), "") << advice.text;
    fs::remove_all(work / "out");
    const Answer run = shell(work, line);
    EXPECT_EQ(run.code, 0) << line << "\n" << run.text;
    return run.code == 0 ? measured_by_run(work / "out") : nlohmann::json();
}

/// The same steps by the same functions: the error agrees to the nine digits of a table.
constexpr double digits = 1e-8;
/// A rival for the core takes half of it, so a run may take twice as long as promised, or half where the rival was there first. Who is
/// disturbed in three rounds of measuring and following has no such excuse. Runs of less than 50 ms end between two ticks of a scheduler
/// that shares a core for a tenth of a second, and several threads wait for the one that has no core: these are counted, not judged.
constexpr double rival = 2, long_enough = 0.05;
constexpr int rounds = 3;

void follow(const Study& study, const fs::path& tables, const Choice& row, bool fresh, const fs::path& work, Count& count) {
    const std::string name = fmt::format("{} {} {:g}", study.name, row.curve->method, row.at.setting);
    const bool judged = fresh && row.at.threads == 1 && row.at.seconds() >= long_enough;
    double promised = row.at.ms_per_step, ratio = 0;
    for (int round = 0; round < rounds; ++round) {
        if (round > 0) promised = measured_now(study, *row.curve, row.at).ms_per_step;
        const auto numbers = followed(study, tables, row, work);
        if (!numbers.contains(study.error)) {
            ADD_FAILURE() << name << ": the run measured no " << study.error << "; " << numbers.dump();
            return;
        }
        if (round == 0) ++count.followed;
        const double error = std::abs(numbers[study.error].get<double>());
        const bool met = std::abs(error - row.at.error) <= digits * row.at.error;
        EXPECT_TRUE(met) << name << ": " << row.at.error << " was promised, " << error << " came out";
        if (round == 0) count.met += met;
        ratio = numbers["ms_per_step"].get<double>() / promised;
        if (!judged || std::max(ratio, 1 / ratio) <= rival) break;
    }
    count.ratios.push_back(ratio);
    count.judged += judged;
    if (judged) {
        EXPECT_LE(std::max(ratio, 1 / ratio), rival) << name << ": " << promised << " ms a step promised";
    }
}

}  // namespace

TEST("the configurations that weir plan recommends are run by the line that it prints, with the error and the time that it promises") {
    const char* stored = std::getenv("WEIR_PLAN_TABLES");
    const auto folders = find_studies(cases);
    ASSERT_FALSE(folders.empty());
    Count all;
    for (const auto& folder : folders) {
        const TemporaryFolder work, own;
        const Size size = stored ? size_of_table(folder.filename().string(), stored) : Size::ci;
        const Study study = read_study(folder, size);
        const fs::path tables = stored ? fs::absolute(stored) : fresh_tables(study, own.path());
        const auto curves = read_cost_table(study, tables);
        Count count;
        for (const Choice& row : followed_of(recommendable(curves, study.price, budget_of(study))))
            follow(study, tables, row, !stored, work.path(), count);
        EXPECT_GT(count.followed, 0) << study.name;
        fmt::print("{:34} {:2} followed, {:2} with the error promised\n", study.name, count.followed, count.met);
        all.followed += count.followed, all.met += count.met, all.judged += count.judged;
        all.ratios.insert(all.ratios.end(), count.ratios.begin(), count.ratios.end());
    }
    std::sort(all.ratios.begin(), all.ratios.end());
    const double median = all.ratios.empty() ? 0 : all.ratios[all.ratios.size() / 2];
    fmt::print("{} lines followed, {} met; milliseconds: median {:.2f} of what was promised, {:.2f} to {:.2f}, {} judged\n", all.followed,
               all.met, median, all.ratios.empty() ? 0 : all.ratios.front(), all.ratios.empty() ? 0 : all.ratios.back(), all.judged);
}

TEST("tables of another machine are scaled by settings that are run again, or it is said that they are not from here") {
    const Study study = read_study(cases / "taylor_green", Size::ci);
    const TemporaryFolder folder;
    fs::copy_file(published / "csv" / "taylor_green.csv", folder.path() / "taylor_green.csv");
    std::ofstream(folder.path() / "taylor_green.json") << R"({"machine": "a slide rule", "commit": "abc"})";
    const std::string ask = fmt::format("weir plan '{}' --tables '{}' --error 10%", study.folder.string(), folder.path().string());
    const Answer plain = shell(folder.path(), ask + " --as-measured"), scaled_here = shell(folder.path(), ask);
    EXPECT_EQ(plain.code, 0);
    EXPECT_NE(plain.text.find("a slide rule"), std::string::npos) << plain.text;
    EXPECT_NE(plain.text.find("the times were not measured on this machine"), std::string::npos) << plain.text;
    EXPECT_NE(scaled_here.text.find("times scaled by"), std::string::npos) << scaled_here.text;
}

TEST("a machine that is as many times faster as the table was made slower is found to be so") {
    const Study study = read_study(cases / "taylor_green", Size::ci);
    const TemporaryFolder folder;
    auto curves = read_cost_table(study, fresh_tables(study, folder.path()));
    for (CostCurve& c : curves)
        for (Priced& p : c.points) p.ms_per_step *= 10, p.seconds_per_second *= 10;
    const Calibration c = calibrate(study, curves, sim::registry());
    ASSERT_EQ(c.factors.size(), curves.size());
    EXPECT_EQ(c.measured, curves.size()) << "all of them take less than ten seconds";
    EXPECT_LT(c.seconds, 20);
    auto factors = c.factors;
    std::sort(factors.begin(), factors.end());
    EXPECT_NEAR(std::log(factors[factors.size() / 2] * 10), 0, std::log(rival)) << "the median of the methods, as far as a rival lets it";
    EXPECT_DOUBLE_EQ(scaled(curves, c)[0].points[0].ms_per_step, curves[0].points[0].ms_per_step * c.factors[0]);
}

TEST("weir plan with a budget alone buys the most accurate, with an error alone the cheapest; with neither it asks") {
    const TemporaryFolder folder;
    const std::string ask = "weir plan '" + (cases / "taylor_green").string() + "' --as-measured --tables '" + published.string() + "'";
    const Answer rich = shell(folder.path(), ask + " --budget 1s"), cheap = shell(folder.path(), ask + " --error 50%");
    EXPECT_EQ(rich.code, 0) << rich.text;
    EXPECT_NE(rich.text.find("take conservative, grid.cells = 64"), std::string::npos) << rich.text;
    EXPECT_EQ(cheap.code, 0) << cheap.text;
    EXPECT_NE(cheap.text.find("grid.cells = 16"), std::string::npos) << cheap.text;
    EXPECT_EQ(shell(folder.path(), ask).code, 2);
    const Answer poor = shell(folder.path(), ask + " --budget 1us");
    EXPECT_EQ(poor.code, 1) << "nothing is so cheap";
    EXPECT_NE(line_that_begins(poor.text, "weir run "), "") << "the cheapest is named nevertheless\n" << poor.text;
}

TEST("weir run --measure says what a case would: an unknown metric, a reference alone and a restart are refused before a step") {
    const TemporaryFolder folder;
    const std::string run =
        "weir run '" + (cases / "taylor_green" / "scene.toml").string() + "' --quiet --out o --set 'grid.cells=[16,16]'";
    EXPECT_EQ(shell(folder.path(), run + " --measure velocity.l2_relativ --reference taylor_green").code, 2);
    EXPECT_EQ(shell(folder.path(), run + " --measure velocity.l2_relative").code, 2) << "there is nothing to compare with";
    EXPECT_EQ(shell(folder.path(), run + " --reference taylor_green").code, 2);
    EXPECT_EQ(shell(folder.path(), run + " --measure steps --restart o").code, 2);
    EXPECT_FALSE(fs::exists(folder.path() / "o" / "run.json"));
    const Answer good = shell(folder.path(), run + " --measure velocity.l2_relative --reference taylor_green");
    EXPECT_EQ(good.code, 0) << good.text;
    EXPECT_NE(good.text.find("velocity.l2_relative = "), std::string::npos) << good.text;
}

}  // namespace weir::validation
