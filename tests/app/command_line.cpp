// What is refused, with which exit code, and that nothing is written then.
#include "app/process.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

#include <sys/wait.h>

namespace {

using weir::test::Process;
using weir::test::TemporaryFolder;
using weir::test::weir_says;

const std::string smoke = std::string(WEIR_SOURCE_DIR) + "/tests/app/scenes/smoke.toml";

TEST("--version, list and describe answer with exit 0") {
    EXPECT_EQ(weir_says({"--version"}).code, 0);
    EXPECT_NE(weir_says({"list", "solvers"}).text.find("mac"), std::string::npos);
    EXPECT_NE(weir_says({"list", "effects"}).text.find("buoyancy"), std::string::npos);
    EXPECT_NE(weir_says({"describe", "time.cfl"}).text.find("cfl"), std::string::npos);
    EXPECT_NE(weir_says({"describe", "substance", "water"}).text.find("at 373.124 K 2.25667e+06 J/kg make vapour of liquid"),
              std::string::npos);
    EXPECT_NE(weir_says({"describe", "substance", "own"}).text.find("fusion"), std::string::npos);
}

TEST("what cannot be printed is no success: exit 2, with the system's reason") {
    TemporaryFolder folder;
    for (const std::string& command :
         std::vector<std::string>{"list solvers", "describe", "validate --list", "run " + smoke + " --explain"}) {
        const auto log = folder.path() / "log";
        const int status = std::system((std::string(WEIR_EXECUTABLE) + ' ' + command + " >/dev/full 2>" + log.string()).c_str());
        EXPECT_EQ(WEXITSTATUS(status), 2) << command;
        std::ifstream said(log);
        const std::string text{std::istreambuf_iterator<char>(said), {}};
        EXPECT_NE(text.find("No space left"), std::string::npos) << command << ": " << text;
    }
}

TEST("no command, an unknown command, an unknown option and a missing scene are bad input: exit 2") {
    EXPECT_EQ(weir_says({}).code, 2);
    EXPECT_EQ(weir_says({"rum"}).code, 2);
    EXPECT_EQ(weir_says({"run", "--colour", smoke}).code, 2);
    EXPECT_EQ(weir_says({"run"}).code, 2);
    EXPECT_EQ(weir_says({"run", "/nowhere/scene.toml"}).code, 2);
    EXPECT_EQ(weir_says({"run", smoke, "--threads", "0"}).code, 2);
}

TEST("a bad --set is refused with the key that was meant, and nothing is written") {
    TemporaryFolder folder;
    const auto answer = weir_says({"run", smoke, "--out", folder.path() / "out", "--set", "grid.cell=[8, 8]"});
    EXPECT_EQ(answer.code, 2);
    EXPECT_NE(answer.text.find("did you mean"), std::string::npos) << answer.text;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST("--backend runs particles on the reference; what it lacks, and an unknown name, are refused with what is allowed") {
    const std::string dam = std::string(WEIR_SOURCE_DIR) + "/tests/app/scenes/dam.toml";
    TemporaryFolder folder;
    const auto run = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"run", dam, "--out", folder.path() / "out"});
        return weir_says(more);
    };
    auto answer = run({"--backend", "referee"});
    EXPECT_EQ(answer.code, 2);
    EXPECT_NE(answer.text.find("opencl:N (weir list devices), reference"), std::string::npos) << answer.text;
    answer = run({"--backend", "reference", "--set", "effects.xsph.c=0.1"});
    EXPECT_EQ(answer.code, 2);
    EXPECT_NE(answer.text.find("it has gravity, artificial_pressure"), std::string::npos) << answer.text;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
    answer = run({"--backend", "reference"});
    EXPECT_EQ(answer.code, 0) << answer.text;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out"));
}

TEST("docs/fields.md is what weir list fields --markdown writes") {
    const auto answer = weir_says({"list", "fields", "--markdown"});
    EXPECT_EQ(answer.code, 0);
    EXPECT_EQ(answer.text, weir::test::text_of(std::string(WEIR_SOURCE_DIR) + "/docs/fields.md"))
        << "run: weir list fields --markdown > docs/fields.md";
}

TEST("--explain says so where a scene is not valid without an effect, whose cost is then no difference of two runs") {
    const std::string drop = std::string(WEIR_SOURCE_DIR) + "/cases/couette/sph.toml";
    const auto answer = weir_says({"run", drop, "--explain", "--set", "grid.cells=[8, 16]"});
    EXPECT_EQ(answer.code, 0) << answer.text;
    EXPECT_NE(answer.text.find("the scene is not valid without it"), std::string::npos) << answer.text;
}

TEST("--explain tells what was called for, what was built and what was left out, and writes nothing") {
    TemporaryFolder folder;
    const auto answer = weir_says({"run", smoke, "--explain", "--out", folder.path() / "out"});
    EXPECT_EQ(answer.code, 0) << answer.text;
    const auto at = [&](const char* what) { return answer.text.find(what); };
    EXPECT_NE(at("effects     buoyancy"), std::string::npos) << answer.text;
    EXPECT_LT(at("temperature [K]"), at("project")) << "fields, then passes";
    EXPECT_NE(at("pass \"effect confinement\"; scratch vorticity_magnitude"), std::string::npos) << answer.text;
    EXPECT_LT(at("not requested"), at("cooling")) << answer.text;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST("bodies in a fluid without a density in the scene are remarked by a run and by --explain, and no others") {
    TemporaryFolder folder;
    const std::string water = std::string(WEIR_SOURCE_DIR) + "/cases/floating_bodies/scene.toml";
    const auto said = [&](const std::string& density, const char* how) {
        std::ofstream(folder.path() / "scene.toml") << R"(title = "A tank"
solver = "mac_water"
dim = 2
grid = { cells = [10, 8], size = [1.0, 0.8] }
time = { end = 0.01 }
liquid = [ { shape = "box", min = [0.0, 0.0], max = [1.0, 0.4] } ]
bodies = [ { name = "raft", shape = "box", min = [0.2, 0.3], max = [0.6, 0.5], mass = 40.0 },
           { name = "cork", shape = "sphere", centre = [0.8, 0.4], radius = 0.1, density = 0.5 } ]
effects = { gravity = { g = [0.0, -9.81] } }
)" << density;
        return weir_says({"run", folder.path() / "scene.toml", how, "--out", folder.path() / "out"}).text;
    };
    const std::string remark =
        "fluid.density is not given; the default is 1 kg/m^3, the density of air, and body \"raft\" of 500 kg/m^3 sinks in it; for water";
    for (const char* how : {"--explain", "--quiet"}) {
        EXPECT_NE(said("", how).find(remark), std::string::npos) << said("", how);
        EXPECT_EQ(said("fluid = { density = 1.0 }\n", how).find("is not given"), std::string::npos) << how;
    }
    EXPECT_EQ(weir_says({"run", water, "--explain"}).text.find("is not given"), std::string::npos);
}

TEST("an effect of strength zero is remarked: it may cost, and does nothing") {
    TemporaryFolder folder;
    const auto said = [&](const std::string& epsilon) {
        return weir_says({"run", smoke, "--quiet", "--set", "time.end=0.01", "--set", "effects.confinement.epsilon=" + epsilon, "--out",
                          folder.path() / "out"})
            .text;
    };
    EXPECT_NE(said("0.0").find("effect \"confinement\" has strength zero"), std::string::npos);
    EXPECT_EQ(said("0.2").find("strength zero"), std::string::npos);
}

TEST("run.json times each effect by its name") {
    TemporaryFolder folder;
    weir_says({"run", smoke, "--quiet", "--set", "time.end=0.01", "--out", folder.path() / "out"});
    const std::string log = weir::test::text_of(folder.path() / "out" / "run.json");
    for (const char* pass : {"\"effect buoyancy\":", "\"effect confinement\":", "\"effect emitters\":"})
        EXPECT_NE(log.find(pass), std::string::npos) << pass;
}

TEST("weir cost --plan tells what a scene will cost and writes nothing; weir plan chooses, or says that nothing reaches it") {
    const auto estimate = weir_says({"cost", "--plan", smoke});
    EXPECT_EQ(estimate.code, 0) << estimate.text;
    for (const char* what :
         {"temperature [K]", "bytes per cell", "frames", " steps", "effect buoyancy", "all", "ns per cell", "rates measured now"})
        EXPECT_NE(estimate.text.find(what), std::string::npos) << what << "\n" << estimate.text;
    const std::string tables = std::string(WEIR_SOURCE_DIR) + "/results/cost", study = std::string(WEIR_SOURCE_DIR) + "/cases/taylor_green";
    const auto chosen = weir_says({"plan", study, "--tables", tables, "--as-measured", "--error", "20%", "--budget", "10s"});
    EXPECT_EQ(chosen.code, 0) << chosen.text;
    EXPECT_NE(chosen.text.find("take "), std::string::npos) << chosen.text;
    const auto none = weir_says({"plan", study, "--tables", tables, "--as-measured", "--error", "1e-9", "--budget", "10s"});
    EXPECT_EQ(none.code, 1) << none.text;
    EXPECT_NE(none.text.find("the nearest:"), std::string::npos) << none.text;
    EXPECT_EQ(weir_says({"plan", study, "--tables", tables, "--as-measured", "--error", "2%", "--budget", "16"}).code, 2)
        << "a time requires a unit";
}

TEST("an output folder that cannot be written is refused before the run") {
    TemporaryFolder folder;
    std::ofstream(folder.path() / "file") << "x";
    const auto answer = weir_says({"run", smoke, "--out", folder.path() / "file" / "out"});
    EXPECT_EQ(answer.code, 2);
    EXPECT_NE(answer.text.find("Not a directory"), std::string::npos) << answer.text;
}

TEST("a field that the scene does not have is refused before the run, with those that it has") {
    TemporaryFolder folder;
    const auto answer = weir_says({"run", smoke, "--out", folder.path() / "out", "--set", "output.fields=[\"smok\"]"});
    EXPECT_EQ(answer.code, 2);
    EXPECT_NE(answer.text.find("smoke"), std::string::npos) << answer.text;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST("a truncated checkpoint is refused") {
    TemporaryFolder folder;
    std::ofstream(folder.path() / "checkpoint.weir") << "weircp01 and no more";
    const auto answer = weir_says({"run", "--restart", folder.path()});
    EXPECT_EQ(answer.code, 2);
    EXPECT_NE(answer.text.find("checkpoint"), std::string::npos) << answer.text;
}

TEST(
    "a pressure solve that misses its tolerance is a numerical failure: exit 3, with step, time, quantity, and the last good state saved") {
    TemporaryFolder folder;
    const auto out = folder.path() / "out";
    const auto answer = weir_says(
        {"run", smoke, "--out", out, "--threads", "1", "--set", "scheme.poisson.max_iterations=1", "--set", "scheme.poisson.method=cg"});
    EXPECT_EQ(answer.code, 3) << answer.text;
    EXPECT_NE(answer.text.find("step "), std::string::npos) << answer.text;
    EXPECT_NE(answer.text.find("pressure"), std::string::npos) << answer.text;
    EXPECT_NE(answer.text.find("last_good.weir"), std::string::npos) << answer.text;
    EXPECT_TRUE(std::filesystem::exists(out / "last_good.weir"));
}

TEST("a particle whose place is not a number is caught in the step it appears: exit 3, and the last good state saved") {
    TemporaryFolder folder;
    const auto scene = folder.path() / "nan.toml", out = folder.path() / "out";
    std::ofstream(scene) << "title = \"not a number\"\nsolver = \"pbf\"\ndim = 2\ngrid = { cells = [8, 12], size = [1, 1.5] }\n"
                            "time = { end = 1.0, dt = 0.008 }\nfluid = { density = 1000.0 }\nscheme = { settle = 0 }\n"
                            "liquid = [ { shape = \"box\", min = [0, 0], max = [1, 1] } ]\n"
                            // omega^2 overflows, and infinity times the distance 0 of one particle to the centre is NaN
                            "effects = { central_force = { omega = 1e160, centre = [0.4375, 0.4375] } }\n";
    const auto answer = weir_says({"run", scene, "--out", out, "--threads", "1"});
    EXPECT_EQ(answer.code, 3) << answer.text;
    EXPECT_NE(answer.text.find("step 1, "), std::string::npos) << answer.text;
    EXPECT_NE(answer.text.find("position"), std::string::npos) << answer.text;
    EXPECT_TRUE(std::filesystem::exists(out / "last_good.weir"));
}

TEST("of a sweep the run that is refused is named with why, though the claim rests on another one") {
    TemporaryFolder folder;
    const auto one = folder.path() / "thin";
    std::filesystem::create_directories(one);
    std::ofstream(one / "case.toml")
        << "question = \"q\"\nblind_to = \"b\"\nkind = \"benchmark\"\n"
           "sweep = { key = \"grid.cells\", values = [4, 32] }\n"
           "accept = [ { metric = \"total_smoke\", at_least = 0, why = \"smoke is let in, never taken out\" } ]\n";
    std::ofstream(one / "scene.toml")
        << "solver = \"mac\"\ndim = 2\ngrid = { cells = [32, 32], size = [1.0, 1.0] }\ntime = { end = 0.01, dt = 0.01 }\n"
           "emitters = [ { shape = \"sphere\", centre = [0.5, 0.5], radius = 0.03, smoke = 1.0 } ]\n";
    const auto answer = weir_says({"validate", one, "--out", folder.path() / "out"});
    EXPECT_EQ(answer.code, 2) << answer.text;
    EXPECT_NE(answer.text.find("1 of 1 claims pass"), std::string::npos) << answer.text;
    const auto told = answer.text.find("thin at grid.cells = 4: refused: ");
    ASSERT_NE(told, std::string::npos) << answer.text;
    EXPECT_NE(answer.text.find("scene.toml:5:12: ", told), std::string::npos) << answer.text;
    EXPECT_NE(answer.text.find("it covers the centre of no cell", told), std::string::npos) << answer.text;
}

}  // namespace
