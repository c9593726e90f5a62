// `weir plan SCENE --of QUANTITY` as a user types it: the printed command gives the promised value, kept runs answer a second question, and
// what cannot be answered is refused.
#include "app/process.hpp"
#include "output/folder_lock.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <sys/wait.h>
#include <nlohmann/json.hpp>

namespace weir {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::TemporaryFolder;
using test::text_of;

const std::string question = "weir plan sloshing.toml --of right.height.max ";

/// A folder with a small tank in which water sloshes.
class Desk {
public:
    Desk() {
        std::ofstream(path() / "sloshing.toml")
            << "solver = \"mac_water\"\ndim = 2\ngrid = { cells = [20, 12], size = [1.0, 0.6] }\ntime = { end = 1.0 }\n"
               "fluid = { density = 1000.0 }\nliquid = [ { shape = \"plane\", point = [0.5, 0.3], normal = [0.1, 1.0] } ]\n"
               "effects = { gravity = { g = [0.0, -9.81] } }\n"
               "probes = [ { name = \"right\", kind = \"gauge\", at = [0.98, 0.0], every = 0.01 } ]\n";
    }
    const fs::path& path() const { return folder_.path(); }
    fs::path plan() const { return path() / "out/sloshing/plan"; }

    /// A line of a shell, with the executable of this build as "weir"; its exit code. What it prints is in `said`.
    int run(const std::string& line) {
        const fs::path script = path() / "line.sh", log = path() / "said.log";
        std::ofstream(script) << "cd '" << path().string() << "'\nPATH='" << fs::path(WEIR_EXECUTABLE).parent_path().string() << "':$PATH\n"
                              << line << "\n";
        const int status = std::system(fmt::format("sh '{}' > '{}' 2>&1", script.string(), log.string()).c_str());
        said = text_of(log);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string line_that_begins(const std::string& with) const {
        std::istringstream in(said);
        for (std::string line; std::getline(in, line);)
            if (line.starts_with(with)) return line;
        return "";
    }
    json answer() const { return json::parse(text_of(plan() / "plan.json")); }
    /// Kept runs and when they were written.
    std::map<std::string, fs::file_time_type> kept() const {
        std::map<std::string, fs::file_time_type> files;
        for (const auto& entry : fs::directory_iterator(plan() / "runs")) files[entry.path().filename()] = entry.last_write_time();
        return files;
    }

    std::string said{};

private:
    TemporaryFolder folder_{};
};

/// Values that the command measures, of the recommended grid.
double promised(const json& answer) {
    const std::size_t grid = answer.at("take").at("grid");
    return answer.at("methods").at(0).at("grids").at(grid).at("values").at(0).at("value");
}

/// Of a file of a gauge: comments, a line of names, then rows of t, height, depth.
double largest_height(const fs::path& csv) {
    std::ifstream file(csv);
    double highest = -INFINITY, t = 0, height = 0;
    char comma = 0;
    for (std::string line; std::getline(file, line);)
        if (std::istringstream row(line); row >> t >> comma >> height) highest = std::max(highest, height);
    return highest;
}

// The maximum is the largest sample. A file of a probe has at least nine digits.
constexpr double printed = 1e-8;

TEST("the printed command runs, and its probe has the promised value") {
    Desk desk;
    ASSERT_EQ(desk.run(question + "--error 5%"), 0) << desk.said;
    const std::string line = desk.line_that_begins("weir run ");
    ASSERT_NE(line, "") << desk.said;
    EXPECT_EQ(desk.line_that_begins("page: "), "page: out/sloshing/plan/index.html");
    const json answer = desk.answer();
    EXPECT_EQ(answer.at("take").at("command"), line);
    ASSERT_EQ(desk.run(line + " --out followed"), 0) << desk.said;
    const double highest = largest_height(desk.path() / "followed/probes/right.csv");
    EXPECT_NEAR(highest, promised(answer), printed * promised(answer));
    EXPECT_TRUE(fs::exists(desk.plan() / "plan.svg"));
    const std::string page = text_of(desk.plan() / "index.html");
    EXPECT_NE(page.find("<svg"), std::string::npos);
    EXPECT_NE(page.find("--error 5%</code>"), std::string::npos) << "the page repeats the question";
    EXPECT_EQ(desk.run(question + "--error 1um --budget 0.5ms"), 1) << desk.said;
    EXPECT_NE(text_of(desk.plan() / "index.html").find("No configuration of the ladder meets the request"), std::string::npos);
}

TEST("a second question is answered from kept runs") {
    Desk desk;
    ASSERT_EQ(desk.run(question + "--error 5%"), 0) << desk.said;
    const auto runs = desk.kept();
    const double first = promised(desk.answer());
    ASSERT_GE(runs.size(), 3u) << "a band requires three grids";
    EXPECT_GT(desk.answer().at("seconds_of_new_runs"), 0);
    ASSERT_EQ(desk.run(question + "--error 7%"), 0) << desk.said;
    EXPECT_EQ(desk.kept(), runs) << "no run was made again";
    EXPECT_EQ(desk.answer().at("seconds_of_new_runs"), 0);
    ASSERT_EQ(desk.run("weir plan sloshing.toml --of right.depth.max --error 7%"), 0) << desk.said;
    EXPECT_EQ(desk.kept(), runs) << "runs keep all series, so another quantity requires none";
    ASSERT_EQ(desk.run(question + "--error 5%"), 0);
    EXPECT_EQ(promised(desk.answer()), first);
}

TEST("a damaged run is made again: a truncated file, a changed digit, another scene's run") {
    Desk desk;
    ASSERT_EQ(desk.run(question + "--error 5%"), 0) << desk.said;
    const double value = promised(desk.answer());
    std::vector<fs::path> files;
    for (const auto& [name, time] : desk.kept()) files.push_back(desk.plan() / "runs" / name);
    ASSERT_GE(files.size(), 3u);
    std::map<fs::path, std::string> whole;
    for (const fs::path& file : files) whole[file] = text_of(file);
    const auto damaged = [&](const std::string& how, auto damage) {
        for (const fs::path& file : files) std::ofstream(file) << damage(whole[file], file);
        EXPECT_EQ(desk.run(question + "--error 5%"), 0) << how << "\n" << desk.said;
        EXPECT_EQ(promised(desk.answer()), value) << how;
        const std::string series = "\"series\"";  // computing times differ, results do not
        for (const fs::path& file : files)
            EXPECT_EQ(text_of(file).substr(text_of(file).find(series)), whole[file].substr(whole[file].find(series))) << how;
    };
    damaged("truncated", [](const std::string& text, const fs::path&) { return text.substr(0, text.size() / 2); });
    damaged("empty", [](const std::string&, const fs::path&) { return std::string(); });
    damaged("a digit", [](std::string text, const fs::path&) {
        const auto at = text.find("0.3", text.find("\"values\"", text.find("right.height")));
        return at == std::string::npos ? text : text.replace(at, 3, "0.9");
    });
    damaged("another scene's", [&](const std::string&, const fs::path& file) { return whole[file == files[0] ? files[1] : files[0]]; });
}

TEST("an unknown probe is refused before a run, with the known ones; an unknown scene too") {
    Desk desk;
    EXPECT_EQ(desk.run("weir plan sloshing.toml --of rihgt.height.max --error 5%"), 2);
    EXPECT_NE(desk.said.find("right.height, right.depth"), std::string::npos) << desk.said;
    EXPECT_EQ(desk.run("weir plan sloshing.toml --of right.max --error 5%"), 2);
    EXPECT_NE(desk.said.find("right has several columns; name one: right.height, right.depth"), std::string::npos) << desk.said;
    EXPECT_EQ(desk.run("weir plan sloshing.toml"), 2);
    EXPECT_NE(desk.said.find("right.depth"), std::string::npos) << desk.said;
    EXPECT_FALSE(fs::exists(desk.plan())) << "nothing was run";
    EXPECT_EQ(desk.run("weir plan no_such_thing"), 2);
    EXPECT_NE(desk.said.find("no_such_thing: there is no such file, and no such case"), std::string::npos) << desk.said;
}

// The ladder of the first question ends where the grids alone meet the error; step and seeds widen the band beyond it.
TEST("the ladder goes on where the time step and the seeds widen a band beyond the error") {
    Desk desk;
    for (const char* error : {"3%", "4%", "6%", "8%", "12%", "16%", "20%"})
        EXPECT_EQ(desk.run(fmt::format("weir plan sloshing.toml --of kinetic_energy.mean@0.3.. --of right.height.max --error {}", error)),
                  0)
            << error << "\n"
            << desk.said;
}

TEST("an error that no affordable grid has gives exit code 1, and the nearest answer") {
    Desk desk;
    EXPECT_EQ(desk.run(question + "--error 1um --budget 0.5ms"), 1) << desk.said;
    EXPECT_NE(desk.said.find("no configuration of the ladder meets this"), std::string::npos) << desk.said;
    EXPECT_NE(desk.said.find("right.height.max is known to"), std::string::npos) << desk.said;
    EXPECT_NE(desk.said.find("mac_water would need more than 100 times as many cells per axis"), std::string::npos) << desk.said;
    EXPECT_EQ(desk.line_that_begins("weir run "), "");
    EXPECT_TRUE(desk.answer().at("take").is_null());
}

TEST("of two plans in one folder the second is refused") {
    Desk desk;
    fs::create_directories(desk.plan());
    {
        const output::FolderLock first(desk.plan());
        EXPECT_EQ(desk.run(question + "--error 5%"), 2);
        EXPECT_NE(desk.said.find("out/sloshing/plan"), std::string::npos) << desk.said;
        EXPECT_FALSE(fs::exists(desk.plan() / "runs"));
    }
    EXPECT_EQ(desk.run(question + "--error 5%"), 0) << desk.said;
}

TEST("an unknown command is refused with the nearest one") {
    Desk desk;
    EXPECT_EQ(desk.run("weir rnu sloshing.toml"), 2);
    EXPECT_NE(desk.said.find("weir has no command \"rnu\"; did you mean \"run\"?"), std::string::npos) << desk.said;
    EXPECT_EQ(desk.run("weir --version"), 0);
}

}  // namespace
}  // namespace weir
