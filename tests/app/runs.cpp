// weir run as users meet it: interrupted, killed, restarted, on one thread and on two, on a full disk.
#include "app/process.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"
#include "support/vtk_files.hpp"

#include <nlohmann/json.hpp>

namespace {

namespace fs = std::filesystem;
using weir::test::Process;
using weir::test::TemporaryFolder;
using weir::test::text_of;

const std::vector<std::string> scene_names{"smoke", "water"};

std::string scene(const std::string& name) { return std::string(WEIR_SOURCE_DIR) + "/tests/app/scenes/" + name + ".toml"; }

int run(const std::vector<std::string>& arguments, const fs::path& log) {
    Process process(arguments, log);
    const int code = process.wait();
    if (code != 0) ADD_FAILURE() << "weir ended with " << code << ":\n" << process.said();
    return code;
}

/// The uninterrupted run on one thread, made once and shared.
const fs::path& whole_run(const std::string& name) {
    static TemporaryFolder folder;
    static std::map<std::string, fs::path> runs;
    auto& out = runs[name];
    if (out.empty()) {
        out = folder.path() / name;
        run({"run", scene(name), "--out", out, "--threads", "1"}, folder.path() / (name + ".log"));
    }
    return out;
}

TEST("a run ends with exit 0, complete series that VTK reads, probes, and a run.json that parses") {
    for (const auto& name : scene_names) {
        const auto& out = whole_run(name);
        EXPECT_GE(weir::test::read_whole_series(out / "grid.pvd"), 7) << name;
        const auto j = nlohmann::json::parse(text_of(out / "run.json"));
        EXPECT_EQ(j["status"], "finished");
        EXPECT_GT(j["steps"].size(), 10u);
        EXPECT_FALSE(j["steps"][3]["passes"].empty());
    }
    EXPECT_EQ(weir::test::read_whole_series(whole_run("water") / "markers.pvd"), 9);
    EXPECT_TRUE(fs::exists(whole_run("water") / "probes/gauge.csv"));
}

TEST("two threads give the same bytes as one: every frame, every series, every probe") {
    for (const auto& name : scene_names) {
        TemporaryFolder folder;
        run({"run", scene(name), "--out", folder.path() / "out", "--threads", "2"}, folder.path() / "log");
        EXPECT_EQ(weir::test::first_difference(whole_run(name), folder.path() / "out"), "") << name;
    }
}

TEST("Ctrl-C ends a run with its frame, exit 130 and a checkpoint; --restart then yields the bytes of the uninterrupted run") {
    for (const auto& name : scene_names) {
        TemporaryFolder folder;
        const auto out = folder.path() / "out";
        Process first({"run", scene(name), "--out", out, "--threads", "1"}, folder.path() / "log");
        first.wait_for(out / "frames/grid_000001.vti");
        first.signal(SIGINT);
        ASSERT_EQ(first.wait(), 130) << first.said();
        EXPECT_NE(first.said().find("--restart"), std::string::npos);
        const int frames = weir::test::read_whole_series(out / "grid.pvd");
        EXPECT_GE(frames, 2);
        EXPECT_LT(frames, weir::test::read_whole_series(whole_run(name) / "grid.pvd"));
        EXPECT_EQ(nlohmann::json::parse(text_of(out / "run.json"))["status"].get<std::string>().substr(0, 11), "interrupted");
        run({"run", "--restart", out, "--threads", "1"}, folder.path() / "log2");
        EXPECT_EQ(weir::test::first_difference(whole_run(name), out), "") << name;
        EXPECT_EQ(nlohmann::json::parse(text_of(out / "run.json"))["steps"].size(),
                  nlohmann::json::parse(text_of(whole_run(name) / "run.json"))["steps"].size());
    }
}

TEST("SIGTERM ends a run as Ctrl-C does, with exit 143") {
    TemporaryFolder folder;
    const auto out = folder.path() / "out";
    Process process({"run", scene("smoke"), "--out", out, "--threads", "1"}, folder.path() / "log");
    process.wait_for(out / "frames/grid_000001.vti");
    process.signal(SIGTERM);
    EXPECT_EQ(process.wait(), 128 + SIGTERM) << process.said();
}

TEST("a run killed at any moment (kill -9) leaves a readable series; its last checkpoint continues bit for bit") {
    for (const auto& name : scene_names) {
        TemporaryFolder folder;
        const auto out = folder.path() / "out";
        Process first({"run", scene(name), "--out", out, "--threads", "1", "--checkpoint-every", "7"}, folder.path() / "log");
        first.wait_for(out / "frames/grid_000003.vti");
        first.signal(SIGKILL);
        ASSERT_EQ(first.wait(), 128 + SIGKILL);
        EXPECT_GE(weir::test::read_whole_series(out / "grid.pvd"), 3);
        run({"run", "--restart", out, "--threads", "1"}, folder.path() / "log2");
        for (const auto& entry : fs::recursive_directory_iterator(out))  // what was being written when it died
            if (entry.path().extension() == ".part") fs::remove(entry.path());
        EXPECT_EQ(weir::test::first_difference(whole_run(name), out), "") << name;
    }
}

TEST("a disk that fills is a clear error with exit 2, and the earlier frames stay readable") {
    TemporaryFolder folder;
    const auto out = folder.path() / "out";
    // frames grow from 2 to 27 kB while the smoke spreads: the first ones pass
    Process process({"run", scene("smoke"), "--out", out, "--threads", "1"}, folder.path() / "log", 24000);
    EXPECT_EQ(process.wait(), 2);
    EXPECT_NE(process.said().find("cannot write"), std::string::npos) << process.said();
    EXPECT_NE(process.said().find("File too large"), std::string::npos) << process.said();
    EXPECT_GE(weir::test::read_whole_series(out / "grid.pvd"), 2);
    const auto status = nlohmann::json::parse(text_of(out / "run.json"))["status"].get<std::string>();
    EXPECT_TRUE(status.starts_with("failed: cannot write")) << status;
}

TEST("a finished run says how to see it; to restart it finds nothing left to do, and goes on to a later end") {
    TemporaryFolder folder;
    const auto out = folder.path() / "out";
    Process first({"run", scene("smoke"), "--out", out, "--threads", "1", "--set", "time.end=0.1", "--checkpoint-every", "1000"},
                  folder.path() / "log");
    EXPECT_EQ(first.wait(), 0);
    EXPECT_NE(first.said().find("weir view " + out.string()), std::string::npos) << first.said();
    EXPECT_NE(first.said().find("weir picture " + out.string()), std::string::npos) << first.said();
    const auto before = text_of(out / "run.json");
    Process second({"run", "--restart", out}, folder.path() / "log");
    EXPECT_EQ(second.wait(), 0);
    EXPECT_NE(second.said().find("nothing is left to do"), std::string::npos) << second.said();
    EXPECT_NE(second.said().find("--set time.end="), std::string::npos) << second.said();
    EXPECT_EQ(text_of(out / "run.json"), before);
    run({"run", "--restart", out, "--threads", "1", "--set", "time.end=0.6"}, folder.path() / "log");
    EXPECT_EQ(weir::test::read_whole_series(out / "grid.pvd"), weir::test::read_whole_series(whole_run("smoke") / "grid.pvd"));
    fs::remove(out / "checkpoint.weir");
    Process third({"run", "--restart", out}, folder.path() / "log");
    EXPECT_EQ(third.wait(), 2);
    EXPECT_NE(third.said().find("has no checkpoint to continue from"), std::string::npos) << third.said();
}

TEST("a case is run by its name from anywhere; another name is refused with where was looked") {
    TemporaryFolder folder;
    const auto out = folder.path() / "out";
    run({"run", "smoke_obstacle_2d", "--out", out, "--set", "time.end=0.01", "--set", "grid.cells=[16,24]"}, folder.path() / "log");
    EXPECT_TRUE(fs::exists(out / "run.json"));
    Process unknown({"run", "smoke_obstacle_2", "--out", out}, folder.path() / "log");
    EXPECT_EQ(unknown.wait(), 2);
    EXPECT_NE(unknown.said().find("did you mean \"smoke_obstacle_2d\"?"), std::string::npos) << unknown.said();
    EXPECT_NE(unknown.said().find("looked in "), std::string::npos) << unknown.said();
}

}  // namespace
