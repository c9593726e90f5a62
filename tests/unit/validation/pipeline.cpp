// From case.toml to exit code, verdicts.json, CSV, SVG and the published page, on a solver whose numbers are known.
#include "core/error.hpp"
#include "validation/harness/runner.hpp"
#include "validation/report/command.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/fake_solver.hpp"
#include "support/test.hpp"

namespace pipeline_tests {

using namespace weir;
using namespace weir::validation;
namespace fs = std::filesystem;

namespace {

const std::string head = "question = \"q\"\nblind_to = \"b\"\nkind = \"benchmark\"\n";

/// A folder that is gone when the test is.
struct Folder {
    fs::path path = fs::temp_directory_path() / ("weir_validation_" + std::to_string(::getpid()));
    Folder() { fs::remove_all(path), fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
    /// Writes a case about the fake solver and returns its folder.
    std::string add(const std::string& name, const std::string& text, const std::string& scene_more = "") const {
        fs::create_directories(path / name);
        std::ofstream(path / name / "case.toml") << text;
        std::ofstream(path / name / "scene.toml") << "solver = \"fake\"\ndim = 2\ngrid = { cells = [8, 4], size = [1, 1] }\n"
                                                  << "time = { end = 0.1 }\n"
                                                  << scene_more;
        return (path / name).string();
    }
    ValidateOptions options(const std::vector<std::string>& cases) const {
        return {.names = cases, .out = path / "out", .publish = path / "results", .quiet = true};
    }
    std::string read(const fs::path& file) const {
        std::ifstream stream(path / file);
        std::ostringstream text;
        text << stream.rdbuf();
        return text.str();
    }
    nlohmann::json verdicts() const { return nlohmann::json::parse(read("out/verdicts.json")); }
};

int run(const Folder& folder, const std::vector<std::string>& cases) { return validate_command(folder.options(cases), test::fake_kinds()); }

}  // namespace

TEST("claims that hold give exit code 0, verdicts with all their keys, a figure, a table, frames and a page") {
    const Folder folder;
    const auto good = folder.add("good", head + R"(
sweep = { key = "grid.cells", values = [8, 16] }
accept = [
  { metric = "velocity.max", within = [2.0999, 2.1001], why = "2 y + t at y = 1, t = 0.1" },
  { metric = "steps", at_least = 3, why = "the advised step is at most 0.03", every = true },
])");
    EXPECT_EQ(run(folder, {good}), exit_success);
    const auto verdicts = folder.verdicts();
    ASSERT_EQ(verdicts.size(), 2u);
    for (const char* key : {"case", "criterion", "metric", "measured", "bound", "pass", "seconds"})
        EXPECT_TRUE(verdicts[0].contains(key)) << key;
    EXPECT_EQ(verdicts[0]["case"], "good");
    EXPECT_EQ(verdicts[0]["criterion"], "within");
    EXPECT_NEAR(verdicts[0]["measured"].get<double>(), 2.1, 1e-12);
    EXPECT_EQ(verdicts[0]["bound"], (std::vector<double>{2.0999, 2.1001}));
    EXPECT_NE(folder.read("results/svg/good.svg").find("</svg>"), std::string::npos);
    EXPECT_NE(folder.read("results/csv/good.csv").find("velocity.max"), std::string::npos);
    const std::string page = folder.read("results/index.md");
    EXPECT_NE(page.find("2 of 2 claims pass"), std::string::npos);
    EXPECT_NE(page.find("2 y + t at y = 1"), std::string::npos);
    for (const char* size : {"8", "16"}) EXPECT_TRUE(fs::exists(folder.path / "out/good" / size / "grid.pvd")) << size;
}

TEST("a claim that does not hold gives exit code 1 and stands in the verdicts as failed") {
    const Folder folder;
    const auto bad = folder.add("bad", head + R"(accept = [
  { metric = "velocity.max", at_most = 2.0, why = "too low on purpose" },
  { metric = "mass", never_increases = true, why = "the fake mass swings" },
  { metric = "iterations.max", at_most = 100, why = "counts steps" },
])");
    EXPECT_EQ(run(folder, {bad}), exit_claim_failed);
    const auto verdicts = folder.verdicts();
    EXPECT_FALSE(verdicts[0]["pass"].get<bool>());
    EXPECT_FALSE(verdicts[1]["pass"].get<bool>());
    EXPECT_TRUE(verdicts[2]["pass"].get<bool>());
}

TEST("an open target is listed with its value and claims nothing; once it is met the list is wrong") {
    const Folder folder;
    const std::string held = "{ metric = \"velocity.max\", at_most = 10, why = \"w\" }";
    const auto open =
        folder.add("open", head + "accept = [" + held +
                               ", { metric = \"velocity.max\", at_most = 2.0, why = \"first asked\", not_reached = \"2.1\" }]");
    EXPECT_EQ(run(folder, {open}), exit_success);
    const std::string page = folder.read("results/index.md");
    EXPECT_NE(page.find("1 of 1 claims pass"), std::string::npos);
    EXPECT_NE(page.find("## Open targets"), std::string::npos);
    EXPECT_NE(page.find("| open | velocity.max | <= 2 | 2.1 | first asked | 2.1 |"), std::string::npos);
    const auto stale =
        folder.add("stale", head + "accept = [{ metric = \"velocity.max\", at_most = 10, why = \"w\", not_reached = \"no\" }]");
    EXPECT_EQ(run(folder, {stale}), exit_claim_failed);
    const auto broken = folder.add(
        "broken", head + "accept = [{ metric = \"velocity.max\", at_most = 10, why = \"w\", not_reached = \"no\" }]", "fail_at = 3\n");
    EXPECT_EQ(run(folder, {broken}), exit_claim_failed);
}

TEST("publishing names the cases whose numbers at ci size are not published, which nothing can compare with the code") {
    const Folder folder;
    const std::string claims = "accept = [ { metric = \"velocity.max\", at_most = 10, why = \"w\" } ]\n";
    const auto first = folder.add("first", head + claims), second = folder.add("second", head + claims);
    EXPECT_EQ(run(folder, {first, second}), exit_success);
    EXPECT_EQ(folder.read("results/index.md").find("Not verified"), std::string::npos);
    EXPECT_NE(folder.read("results/index.md").find(" (unchanged since)"), std::string::npos);
    auto published = nlohmann::json::parse(folder.read("results/verdicts.json"));
    for (auto& v : published) v.erase("pinned");
    std::ofstream(folder.path / "results/verdicts.json") << published.dump();
    EXPECT_EQ(run(folder, {second}), exit_success);
    EXPECT_NE(folder.read("results/index.md").find("Not verified against the current code: first."), std::string::npos);
}

TEST("published results that are older than the code fail with what moved; those that are not hold, and so does what is not published") {
    const Folder folder;
    const std::string claims =
        head + "full = { set = [\"grid.cells = [16, 8]\"] }\n" + "accept = [ { metric = \"velocity.max\", at_most = 10, why = \"w\" } ]\n";
    const auto tank = folder.add("tank", claims);
    auto publishing = folder.options({tank}), comparing = publishing;
    publishing.size = Size::full;
    comparing.publish = "", comparing.compare = folder.path / "results";
    fs::create_directories(comparing.compare);
    const auto compared = [&] {
        testing::internal::CaptureStderr();
        const int code = validate_command(comparing, test::fake_kinds());
        return std::pair(code, testing::internal::GetCapturedStderr());
    };
    EXPECT_EQ(compared(),
              (std::pair<int, std::string>(exit_success, "tank: not compared with the published results: none are published\n")));
    ASSERT_EQ(validate_command(publishing, test::fake_kinds()), exit_success);
    EXPECT_EQ(compared(), (std::pair<int, std::string>(exit_success, "")));  // the ci size, which was published beside the full one
    std::ofstream(folder.path / "tank/scene.toml") << "solver = \"fake\"\ndim = 2\ngrid = { cells = [8, 4], size = [1, 1] }\n"
                                                      "time = { end = 0.10001 }\n";  // what a change of the solver would do to 2 y + t
    const auto [code, said] = compared();
    EXPECT_EQ(code, exit_claim_failed);
    EXPECT_NE(said.find("tank: published results are older than the code; publishing takes 1 s: weir validate tank --size full --publish"),
              std::string::npos)
        << said;
    EXPECT_NE(said.find("velocity.max changed by 0.00048%: 2.1 published, 2.10001 now"), std::string::npos) << said;
}

TEST("a claim whose bound is another than the published one is older than the code") {
    const Folder folder;
    const auto claims = [](const std::string& bound) {
        return head + "accept = [ { metric = \"velocity.max\", at_most = " + bound + ", why = \"w\" } ]\n";
    };
    const auto tank = folder.add("tank", claims("10"));
    ASSERT_EQ(run(folder, {tank}), exit_success);
    folder.add("tank", claims("9"));
    auto comparing = folder.options({tank});
    comparing.publish = "", comparing.compare = folder.path / "results";
    testing::internal::CaptureStderr();
    EXPECT_EQ(validate_command(comparing, test::fake_kinds()), exit_claim_failed);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("the claim is not published: velocity.max at_most <= 9"), std::string::npos) << said;
    EXPECT_NE(said.find("the claim is published and no longer made: velocity.max at_most <= 10"), std::string::npos) << said;
    const auto refusal = [](const ValidateOptions& options) {
        try {
            validate_command(options, test::fake_kinds());
        } catch (const BadInput& refused) {
            return std::string(refused.what());
        }
        return std::string();
    };
    auto other = comparing;
    other.size = Size::full;
    EXPECT_NE(refusal(other).find("--compare requires the ci size"), std::string::npos);
    other = folder.options({tank}), other.backend = "opencl";
    EXPECT_NE(refusal(other).find("--publish runs the scenes unchanged"), std::string::npos);
}

TEST("a numerical failure and an exceeded time limit fail every claim of the run with their message; other cases go on") {
    const Folder folder;
    const std::string claims = "accept = [ { metric = \"velocity.max\", at_most = 10, why = \"w\" } ]\n";
    const auto broken = folder.add("broken", head + claims, "fail_at = 3\n");
    const auto slow = folder.add("slow", head + "ci = { time_limit = 1e-9 }\n" + claims);
    const auto good = folder.add("well", head + claims);
    EXPECT_EQ(run(folder, {broken, slow, good}), exit_claim_failed);
    const auto verdicts = folder.verdicts();
    ASSERT_EQ(verdicts.size(), 3u);
    EXPECT_FALSE(verdicts[0]["pass"].get<bool>());
    EXPECT_TRUE(verdicts[0]["measured"].is_null());
    EXPECT_NE(verdicts[0]["note"].get<std::string>().find("pressure"), std::string::npos);
    EXPECT_NE(verdicts[1]["note"].get<std::string>().find("1e-09 s"), std::string::npos);
    EXPECT_TRUE(verdicts[2]["pass"].get<bool>());
}

TEST("a metric that does not exist is an error, exit code 2, before a step is spent") {
    const Folder folder;
    const auto odd = folder.add("odd", head + "accept = [ { metric = \"volocity.max\", at_most = 10, why = \"w\" } ]");
    EXPECT_EQ(run(folder, {odd}), exit_bad_input);
    const auto verdicts = folder.verdicts();
    EXPECT_FALSE(verdicts[0]["pass"].get<bool>());
    EXPECT_NE(verdicts[0]["note"].get<std::string>().find("unknown metric \"volocity.max\""), std::string::npos);
    EXPECT_EQ(verdicts[0]["seconds"], 0);
}

TEST("unknown names, a bad case file, a bad scene and an unknown reference are refused together, and nothing is written") {
    const Folder folder;
    const std::string claims = "accept = [ { metric = \"velocity.max\", at_most = 10, why = \"w\" } ]\n";
    const auto file = folder.add("file", head + "accpet = []\n");
    const auto scene = folder.add("scene", head + claims, "colour = 3\n");
    const auto reference = folder.add("reference", head + "reference = \"unlisted\"\n" + claims);
    try {
        run(folder, {file, scene, reference});
        FAIL() << "accepted";
    } catch (const BadInput& wrong) {
        for (const char* part : {"accpet", "colour", "unknown reference \"unlisted\""})
            EXPECT_NE(std::string(wrong.what()).find(part), std::string::npos) << part << "\n" << wrong.what();
    }
    EXPECT_FALSE(fs::exists(folder.path / "out"));
    EXPECT_THROW(run(folder, {"no_such_case"}), BadInput);
    EXPECT_THROW(run(folder, {}), BadInput);
}

TEST("publishing one case keeps what was published of the others") {
    const Folder folder;
    const std::string claims = "accept = [ { metric = \"velocity.max\", at_most = 10, why = \"w\" } ]\n";
    const auto one = folder.add("one", head + claims), two = folder.add("two", head + claims);
    EXPECT_EQ(run(folder, {one}), exit_success);
    EXPECT_EQ(run(folder, {two}), exit_success);
    EXPECT_EQ(run(folder, {two}), exit_success);
    EXPECT_NE(folder.read("results/index.md").find("2 of 2 claims pass, in 2 cases"), std::string::npos);
}

TEST("a sweep over cells keeps the scene's proportions, or refuses what has none") {
    const Folder folder;
    const std::string claims = "accept = [ { metric = \"velocity.max\", at_most = 10, why = \"w\" } ]\n";
    folder.add("shape", head + "sweep = { key = \"grid.cells\", values = [16, 6, 7] }\n" + claims);
    const Case c = read_case(folder.path / "shape", Size::full);
    const std::vector<scene::SolverSchema> schemas = {test::fake_kinds()[0].schema};
    EXPECT_EQ(scene_of(c.variants[0], 0, schemas).root().numbers("grid.cells"), (std::vector<double>{16, 8}));
    EXPECT_EQ(scene_of(c.variants[0], 1, schemas).root().numbers("grid.cells"), (std::vector<double>{6, 3}));
    EXPECT_THROW(scene_of(c.variants[0], 2, schemas), BadInput);  // 3.5 cells along y
}

TEST("a run that is cut off runs, measures and draws at the first value of its sweep, and nothing of it is judged or published") {
    const Folder folder;
    const auto good = folder.add("good", head + R"(
sweep = { key = "grid.cells", values = [8, 16, 32], also = [ { key = "time.max_dt", values = [0.02, 0.01, 0.005] } ] }
accept = [
  { metric = "velocity.max", at_most = 0, why = "wrong on purpose" },
  { metric = "velocity.max", at = 32, at_most = 0, why = "of a value that is not run" },
])");
    ValidateOptions options = folder.options({good});
    options.steps = 2;
    EXPECT_THROW(validate_command(options, test::fake_kinds()), BadInput);  // nothing to publish
    options.publish.clear();
    EXPECT_EQ(validate_command(options, test::fake_kinds()), exit_success);
    EXPECT_FALSE(fs::exists(folder.path / "out/verdicts.json"));
    EXPECT_NE(folder.read("out/svg/good.svg").find("</svg>"), std::string::npos);
    EXPECT_NE(folder.read("out/csv/good.csv").find("velocity.max"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder.path / "out/good/8/frames/grid_000001.vti"));  // the last step, which is no frame of the scene's
    EXPECT_FALSE(fs::exists(folder.path / "out/good/16"));
    const CaseResult result = validate(cut_short(read_case(good, Size::ci), 2), folder.path / "out", test::fake_kinds());
    ASSERT_EQ(result.variants.at(0).runs.size(), 1u);
    EXPECT_EQ(result.variants[0].runs[0].steps, 2);
    EXPECT_EQ(result.variants[0].runs[0].measured.count("velocity.max"), 1u);
}

TEST("a run that is cut off and fails, or asks for what is not there, is reported by the exit code") {
    const Folder folder;
    const auto broken =
        folder.add("broken", head + "accept = [ { metric = \"velocity.max\", at_most = 10, why = \"w\" } ]\n", "fail_at = 2\n");
    const auto odd = folder.add("odd", head + "accept = [ { metric = \"volocity.max\", at_most = 10, why = \"w\" } ]");
    for (const auto& [name, code] : {std::pair{broken, exit_claim_failed}, {odd, exit_bad_input}}) {
        ValidateOptions options = folder.options({name});
        options.steps = 3, options.publish.clear();
        EXPECT_EQ(validate_command(options, test::fake_kinds()), code);
    }
}

}  // namespace pipeline_tests
