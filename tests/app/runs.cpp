// weir run as users meet it: interrupted, killed, restarted, on one thread and on two, on a full disk.
#include "app/process.hpp"
#include "output/read_frame.hpp"
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

/// Removes what a killed run was writing when it died.
void remove_parts(const fs::path& out) {
    for (const auto& entry : fs::recursive_directory_iterator(out))
        if (entry.path().extension() == ".part") fs::remove(entry.path());
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
        EXPECT_GT(j["steps"]["count"], 10);
        EXPECT_FALSE(j["steps"]["milliseconds"].empty());
        const auto rows = weir::test::rows_of(out / "steps.csv");
        EXPECT_EQ(j["steps"]["count"], rows.size());
        EXPECT_EQ(j["steps"]["columns"]["t [s]"]["max"], rows.back().at("t [s]"));
        EXPECT_EQ(weir::test::rows_of(out / "timings.csv").size(), rows.size());
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

/// A drop of particles in space, and its surface.
const fs::path& drop_run() {
    static TemporaryFolder folder;
    static const fs::path out = folder.path() / "drop";
    if (fs::exists(out)) return out;
    std::ofstream(folder.path() / "drop.toml")
        << "solver = \"pbf\"\ndim = 3\ngrid = { cells = [16, 16, 16], size = [1, 1, 1] }\ntime = { end = 0.02, dt = 0.005 }\n"
           "liquid = [ { shape = \"sphere\", centre = [0.5, 0.4, 0.5], radius = 0.3 } ]\neffects = { gravity = { g = [0, -9.81, 0] } }\n"
           "output = { every = 0.01, surface = \"anisotropic\" }\n";
    run({"run", folder.path() / "drop.toml", "--out", out, "--threads", "1"}, folder.path() / "drop.log");
    return out;
}

TEST("a picture by rays has the same bytes on one thread as on three, and is no picture without rays") {
    if (!WEIR_RAYS) GTEST_SKIP() << "built without Embree";
    TemporaryFolder folder;
    const auto draw = [&](const char* threads, const std::string& name, bool quality) {
        setenv("OMP_NUM_THREADS", threads, 1);
        std::vector<std::string> words{"picture", drop_run(), "--size", "160", "--out", folder.path() / name};
        if (quality) words.push_back("--quality");
        run(words, folder.path() / "log");
        return text_of(folder.path() / name);
    };
    const std::string one = draw("1", "one.png", true);
    EXPECT_GT(one.size(), 2000u);
    EXPECT_TRUE(one == draw("3", "three.png", true));
    setenv("OMP_NUM_THREADS", "1", 1);
    EXPECT_FALSE(one == draw("1", "plain.png", false));
}

TEST("a film has its poster beside it, MP4 and WebM; without ffmpeg and with another ending it is told what is missing") {
    TemporaryFolder folder;
    const std::string path = getenv("PATH");
    setenv("PATH", "/nowhere", 1);
    Process without({"movie", drop_run(), "--out", folder.path() / "a.mp4"}, folder.path() / "log");
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(without.wait(), 2);
    EXPECT_NE(without.said().find("requires ffmpeg"), std::string::npos) << without.said();
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
    Process gif({"movie", drop_run(), "--out", folder.path() / "a.gif"}, folder.path() / "log");
    EXPECT_EQ(gif.wait(), 2);
    for (const std::string name : {"film.mp4", "film.webm"}) {
        run({"movie", drop_run(), "--size", "96", "--out", folder.path() / name}, folder.path() / "log");
        const std::string bytes = text_of(folder.path() / name);
        EXPECT_TRUE(bytes.find(name == "film.mp4" ? "ftyp" : "webm") < 64) << name;
        EXPECT_TRUE(fs::exists(folder.path() / "film.png"));
        EXPECT_FALSE(fs::exists(folder.path() / (name + ".frames")));  // the pictures are gone
        fs::remove(folder.path() / "film.png");
    }
}

TEST("a film of a scene is made by one command, with what --set changes of its run") {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
    TemporaryFolder folder;
    drop_run();
    const fs::path here = fs::current_path(), scene_file = drop_run().parent_path() / "drop.toml";
    fs::current_path(folder.path());
    run({"movie", scene_file, "--size", "64", "--set", "time.end=0.01", "--quiet"}, "log");
    Process mixed({"movie", "out/drop", "--set", "time.end=1"}, "log2");
    EXPECT_EQ(mixed.wait(), 2);
    EXPECT_NE(mixed.said().find("--set applies to a scene"), std::string::npos) << mixed.said();
    fs::current_path(here);
    EXPECT_TRUE(fs::exists(folder.path() / "out/drop/movie.mp4"));
    EXPECT_TRUE(fs::exists(folder.path() / "out/drop/movie.png"));
    EXPECT_EQ(weir::output::frame_times(folder.path() / "out/drop").back(), 0.01);
}

TEST("--range names both ends of the colours, or the upper one; what is no range is refused") {
    TemporaryFolder folder;
    std::ofstream(folder.path() / "even.toml")
        << "solver = \"mac\"\ndim = 2\ngrid = { cells = [8, 8], size = [1, 1] }\ntime = { end = 0.01, dt = 0.01 }\n"
           "initial.temperature = { name = \"constant\", value = 300.0 }\n";
    run({"run", folder.path() / "even.toml", "--out", folder.path() / "even"}, folder.path() / "log");
    const auto picture = [&](const std::string& range) {
        const fs::path file = folder.path() / "a.png";
        std::vector<std::string> words{"picture", folder.path() / "even", "--field", "temperature", "--size", "32", "--out", file};
        if (!range.empty()) words.push_back("--range=" + range);
        run(words, folder.path() / "log");
        return text_of(file);
    };
    const std::string lowest = picture("");
    EXPECT_TRUE(picture("350") == lowest);      // the upper end alone: the lower is the frame's own
    EXPECT_TRUE(picture("300,400") == lowest);  // 300 is the lowest
    const std::string middle = picture("250,350");
    EXPECT_FALSE(middle == lowest);
    EXPECT_TRUE(picture("200,400") == middle);
    EXPECT_TRUE(picture("-300,900") == middle);
    for (const auto& [range, why] : {std::pair{"400,300", "LOW must be less than HIGH"},
                                     {"warm", "is not a number"},
                                     {"1,2,3", "has too many values"},
                                     {"-5", "a single value, that of the highest colour, must be greater than 0"}}) {
        Process refused({"picture", folder.path() / "even", std::string("--range=") + range}, folder.path() / "log");
        EXPECT_EQ(refused.wait(), 2);
        EXPECT_NE(refused.said().find(why), std::string::npos) << refused.said();
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
        EXPECT_EQ(nlohmann::json::parse(text_of(out / "run.json"))["status"], "interrupted");
        run({"run", "--restart", out, "--threads", "1"}, folder.path() / "log2");
        EXPECT_EQ(weir::test::first_difference(whole_run(name), out), "") << name;
        const auto summary = [](const fs::path& run) { return nlohmann::json::parse(text_of(run / "run.json"))["steps"]["columns"]; };
        EXPECT_EQ(summary(out), summary(whole_run(name)));
        EXPECT_EQ(weir::test::rows_of(out / "timings.csv").size(), weir::test::rows_of(out / "steps.csv").size());
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
        for (const auto& left : {"checkpoint.weir.part", "frames/grid_000009.vti.part"}) std::ofstream(out / left) << "unfinished";
        run({"run", "--restart", out, "--threads", "1"}, folder.path() / "log2");
        for (const auto& left : {"checkpoint.weir.part", "frames/grid_000009.vti.part"}) EXPECT_FALSE(fs::exists(out / left)) << left;
        remove_parts(out);
        EXPECT_EQ(weir::test::first_difference(whole_run(name), out), "") << name;
    }
}

/// A run of the water that goes on for a while, with another gravity where `more` says so.
std::vector<std::string> long_run(const fs::path& out, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", scene("water"), "--out", out, "--threads", "1", "--set", "time.end=100.0"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

TEST("a checkpoint continues no other run: a new run in its folder gives it another name, killed before its own first one or not") {
    TemporaryFolder folder;
    const auto out = folder.path() / "out";
    run({"run", scene("water"), "--out", out, "--threads", "1", "--checkpoint-every", "5"}, folder.path() / "log");
    const std::string old = text_of(out / "checkpoint.weir");
    fs::remove(out / "frames/markers_000001.vtp");  // the second run writes it again
    Process second(long_run(out, {"--set", "effects.gravity.g=[0.0,-1.0]"}), folder.path() / "log");
    second.wait_for(out / "frames/markers_000001.vtp");
    second.signal(SIGKILL);
    ASSERT_EQ(second.wait(), 128 + SIGKILL);
    EXPECT_NE(second.said().find("earlier_checkpoint.weir"), std::string::npos) << second.said();

    const std::string frame = text_of(out / "frames/markers_000001.vtp"), series = text_of(out / "grid.pvd");
    Process none({"run", "--restart", out, "--threads", "1"}, folder.path() / "log2");
    EXPECT_EQ(none.wait(), 2) << none.said();
    EXPECT_NE(none.said().find("has no checkpoint to continue from"), std::string::npos) << none.said();
    EXPECT_TRUE(text_of(out / "earlier_checkpoint.weir") == old);  // and nothing is lost

    const auto id = nlohmann::json::parse(text_of(out / "run.json"))["run"].get<std::string>(),
               old_id = nlohmann::json::parse(text_of(whole_run("water") / "run.json"))["run"].get<std::string>();
    EXPECT_NE(id, old_id);
    Process other({"run", "--restart", out / "earlier_checkpoint.weir", "--threads", "1", "--set", "time.end=0.5"}, folder.path() / "log3");
    EXPECT_EQ(other.wait(), 2) << other.said();
    for (const auto& name : {id, old_id, out.string()}) EXPECT_NE(other.said().find(name), std::string::npos) << other.said();
    EXPECT_TRUE(text_of(out / "frames/markers_000001.vtp") == frame && text_of(out / "grid.pvd") == series);

    // back under its name it is refused too, and continues in a folder of its own
    fs::rename(out / "earlier_checkpoint.weir", out / "checkpoint.weir");
    Process renamed({"run", "--restart", out, "--threads", "1", "--set", "time.end=0.5"}, folder.path() / "log4");
    EXPECT_EQ(renamed.wait(), 2) << renamed.said();
    run({"run", "--restart", out / "checkpoint.weir", "--out", folder.path() / "new", "--threads", "1", "--set", "time.end=0.5"},
        folder.path() / "log5");
}

TEST(
    "a branch into a folder of its own is run again there, to the same bytes; a branch of another scene or time, and a run from the start "
    "of the same scene, are others") {
    TemporaryFolder folder;
    const auto first = folder.path() / "first", branch = folder.path() / "branch", log = folder.path() / "log";
    run({"run", scene("water"), "--out", first, "--threads", "1", "--checkpoint-every", "5"}, log);
    const auto words = [&](const fs::path& from, const fs::path& to, const std::string& gravity) {
        return std::vector<std::string>{"run",
                                        "--restart",
                                        from,
                                        "--out",
                                        to,
                                        "--threads",
                                        "1",
                                        "--set",
                                        "time.end=0.5",
                                        "--set",
                                        "effects.gravity.g=[0.0," + gravity + "]"};
    };
    run(words(first, branch, "-5.0"), log);
    fs::copy(branch, folder.path() / "kept", fs::copy_options::recursive);
    run(words(first, branch, "-5.0"), log);
    EXPECT_EQ(weir::test::first_difference(folder.path() / "kept", branch), "");
    const auto refused = [&](const std::vector<std::string>& arguments) {
        Process process(arguments, log);
        EXPECT_EQ(process.wait(), 2) << process.said();
        EXPECT_NE(process.said().find("the files in this folder belong to run "), std::string::npos) << process.said();
    };
    refused(words(first, branch, "-4.0"));
    run({"run", "--restart", first, "--threads", "1", "--set", "time.end=0.45", "--checkpoint-every", "1"}, log);  // goes on: a later one
    refused(words(first, branch, "-5.0"));
    EXPECT_EQ(weir::test::first_difference(folder.path() / "kept", branch), "");
    // ended early and continued, it is the branch that had the later end from its start
    const auto early = folder.path() / "early";
    auto until = words(first, early, "-5.0");
    until[8] = "time.end=0.45", until.insert(until.end(), {"--checkpoint-every", "1"});
    fs::remove_all(first), run({"run", scene("water"), "--out", first, "--threads", "1", "--checkpoint-every", "5"}, log);
    run(until, log);
    run({"run", "--restart", early, "--threads", "1", "--set", "time.end=0.5"}, log);
    EXPECT_EQ(weir::test::first_difference(folder.path() / "kept", early), "");
    // the scene of the branch from its start is no branch: its frames before the checkpoint are others
    const auto whole = folder.path() / "whole";
    run({"run", scene("water"), "--out", whole, "--threads", "1", "--set", "time.end=0.5", "--set", "effects.gravity.g=[0.0,-5.0]"}, log);
    refused(words(first, whole, "-5.0"));
}

TEST("a run ended at any moment of its start, in a folder of another, leaves either run to continue, and never a mixture") {
    TemporaryFolder folder;
    const auto first = folder.path() / "first", out = folder.path() / "out";
    run({"run", scene("water"), "--out", first, "--threads", "1", "--checkpoint-every", "5"}, folder.path() / "log");
    const auto whole = folder.path() / "whole";
    run({"run", scene("water"), "--out", whole, "--threads", "1", "--set", "time.end=0.5"}, folder.path() / "log");
    int of_first = 0, of_none = 0;
    for (int microseconds = 0; of_none < 4 && microseconds < 2000000; microseconds += 12000) {
        fs::remove_all(out);
        fs::copy(first, out, fs::copy_options::recursive);
        Process second(long_run(out, {"--set", "effects.gravity.g=[0.0,-1.0]"}), folder.path() / "log");
        usleep(static_cast<useconds_t>(microseconds));
        second.signal(SIGKILL);
        second.wait();
        Process again({"run", "--restart", out, "--threads", "1", "--set", "time.end=0.5"}, folder.path() / "log2");
        const int code = again.wait();
        EXPECT_TRUE(code == 0 || code == 2) << again.said();
        remove_parts(out);
        EXPECT_EQ(code == 0 ? weir::test::first_difference(whole, out) : "", "") << microseconds;
        ++(code == 0 ? of_first : of_none);
    }
    EXPECT_GT(of_first, 0);  // at 0 it had not begun
    EXPECT_EQ(of_none, 4);
    std::printf("%d continued the first run, %d had nothing to continue\n", of_first, of_none);
}

TEST(
    "two runs do not share a folder: the second ends with exit 2, names folder and process, and changes nothing; the folder is free "
    "after") {
    TemporaryFolder folder;
    const auto out = folder.path() / "out";
    Process first(long_run(out), folder.path() / "log");
    first.wait_for(out / "probes/gauge.csv");
    const std::string log = text_of(out / "run.json");
    for (const bool restarts : {false, true}) {
        auto words = long_run(out, {"--set", "effects.gravity.g=[0.0,-1.0]"});
        if (restarts) {
            run({"run", scene("water"), "--out", folder.path() / "other", "--threads", "1", "--checkpoint-every", "5"},
                folder.path() / "log");
            words.insert(words.end(), {"--restart", folder.path() / "other/checkpoint.weir"});
        }
        Process second(words, folder.path() / "log2");
        EXPECT_EQ(second.wait(), 2) << second.said();
        EXPECT_NE(second.said().find(out.string() + ": another run writes into this folder (process "), std::string::npos) << second.said();
        EXPECT_EQ(nlohmann::json::parse(log)["run"], nlohmann::json::parse(text_of(out / "run.json"))["run"]);
    }
    first.signal(SIGKILL);  // the kernel releases the lock
    first.wait();
    fs::remove_all(out / "frames");  // it may have died before its series named the last one
    run({"run", scene("water"), "--out", out, "--threads", "1"}, folder.path() / "log3");
    EXPECT_FALSE(fs::exists(out / ".weir_lock"));
    EXPECT_EQ(weir::test::first_difference(whole_run("water"), out), "");
}

TEST("neither memory nor run.json grows with the number of steps") {
    TemporaryFolder folder;
    std::ofstream(folder.path() / "tiny.toml")
        << "solver = \"mac\"\ndim = 2\ngrid = { cells = [8, 8], size = [1, 1] }\ntime = { end = 1.0, dt = 0.001 }\n"
           "initial.velocity = { name = \"random\", speed = 0.1 }\noutput = { every = 100.0 }\n";
    const auto taken = [&](const std::string& end, std::size_t steps) {
        const auto out = folder.path() / end;
        Process process({"run", folder.path() / "tiny.toml", "--out", out, "--threads", "1", "--quiet", "--set", "time.end=" + end},
                        folder.path() / "log");
        EXPECT_EQ(process.wait(), 0) << process.said();
        const auto j = nlohmann::json::parse(text_of(out / "run.json"));
        EXPECT_EQ(j["steps"]["count"], steps);
        EXPECT_EQ(weir::test::rows_of(out / "steps.csv").size(), steps);
        return std::pair{process.most_memory(), static_cast<double>(fs::file_size(out / "run.json"))};
    };
    const auto few = taken("1.0", 1000), many = taken("10.0", 10000);
    std::printf("1,000 steps: %.1f MB, run.json %.0f bytes; 10,000 steps: %.1f MB, run.json %.0f bytes\n", few.first / 1e6, few.second,
                many.first / 1e6, many.second);
    EXPECT_LT(many.first - few.first, 2e6);      // pages of the allocator; rows in memory were 1.6 kB per step, 15 MB
    EXPECT_LT(many.second - few.second, 200.0);  // digits of the summary; 392 bytes per step, 3.5 MB
}

TEST(
    "memory and checkpoints do not grow with the rows of probes; a run that goes on, in its folder or another, has all rows in its files") {
    TemporaryFolder folder;
    const auto log = folder.path() / "log";
    std::ofstream(folder.path() / "line.toml")
        << "solver = \"mac\"\ndim = 2\ngrid = { cells = [8, 8], size = [1, 1] }\ntime = { end = 1.0, dt = 0.001 }\n"
           "initial.velocity = { name = \"random\", speed = 0.1 }\noutput = { every = 100.0 }\n"
           "probes = [ { name = \"l\", kind = \"line\", field = \"pressure\", from = [0.1, 0.1], to = [0.9, 0.9], count = 200 } ]\n";
    const auto taken = [&](const std::string& end) {
        const auto out = folder.path() / end;
        Process process({"run", folder.path() / "line.toml", "--out", out, "--threads", "1", "--quiet", "--checkpoint-every", "500",
                         "--set", "time.end=" + end},
                        log);
        EXPECT_EQ(process.wait(), 0) << process.said();
        return std::pair{process.most_memory(), static_cast<double>(fs::file_size(out / "checkpoint.weir"))};
    };
    const auto few = taken("0.5"), many = taken("4.0");
    std::printf("500 rows: %.1f MB, checkpoint %.0f bytes; 4000 rows: %.1f MB, checkpoint %.0f bytes\n", few.first / 1e6, few.second,
                many.first / 1e6, many.second);
    EXPECT_LT(many.first - few.first, 2e6);      // pages of the allocator; 3500 rows of 200 numbers are 5.6 MB, and checkpoints as much
    EXPECT_LT(many.second - few.second, 200.0);  // digits of the end; 5.6 MB
    run({"run", "--restart", folder.path() / "0.5", "--out", folder.path() / "other", "--threads", "1", "--quiet", "--set", "time.end=4.0"},
        log);
    run({"run", "--restart", folder.path() / "0.5", "--threads", "1", "--quiet", "--set", "time.end=4.0"}, log);
    for (const char* name : {"0.5", "other"})
        EXPECT_TRUE(text_of(folder.path() / name / "probes/l.csv") == text_of(folder.path() / "4.0/probes/l.csv")) << name;
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
    const auto log = nlohmann::json::parse(text_of(out / "run.json"));
    EXPECT_EQ(log["status"], "failed");
    EXPECT_TRUE(log["failure"].get<std::string>().starts_with("cannot write")) << log["failure"];
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
    EXPECT_NE(second.said().find("the run has already reached its end"), std::string::npos) << second.said();
    EXPECT_NE(second.said().find("--set time.end="), std::string::npos) << second.said();
    EXPECT_EQ(text_of(out / "run.json"), before);
    run({"run", "--restart", out, "--threads", "1", "--set", "time.end=0.6"}, folder.path() / "log");
    EXPECT_EQ(weir::test::read_whole_series(out / "grid.pvd"), weir::test::read_whole_series(whole_run("smoke") / "grid.pvd"));
    EXPECT_EQ(weir::test::first_difference(whole_run("smoke"), out), "");  // bit for bit the run that had this end from the start
    fs::remove(out / "checkpoint.weir");
    Process third({"run", "--restart", out}, folder.path() / "log");
    EXPECT_EQ(third.wait(), 2);
    EXPECT_NE(third.said().find("has no checkpoint to continue from"), std::string::npos) << third.said();
}

TEST("a run ends with its balance, which run.json has too; --quiet prints none of it") {
    TemporaryFolder folder;
    Process loud({"run", scene("water"), "--out", folder.path() / "loud", "--threads", "1"}, folder.path() / "log");
    EXPECT_EQ(loud.wait(), 0) << loud.said();
    const std::string said = loud.said();
    const auto at = said.find("balance from t = 0 to ");
    ASSERT_NE(at, std::string::npos) << said;
    for (const char* row : {"\n  volume ", "; unexplained ", "\n  energy ", "\n  corrected ", "\n  time "})
        EXPECT_NE(said.find(row, at), std::string::npos) << row << said;
    const auto j = nlohmann::json::parse(text_of(folder.path() / "loud/run.json"))["balance"];
    const auto& volume = j["quantities"]["volume"];
    EXPECT_NEAR(volume["unexplained"].get<double>(),
                (volume["end"].get<double>() - volume["start"].get<double>() - volume["net_inflow"].get<double>()) /
                    (volume["start"].get<double>() + std::max(0.0, volume["net_inflow"].get<double>())),
                1e-12);
    EXPECT_GT(j["stepping_seconds"].get<double>(), 0);
    EXPECT_GT(j["real_time_factor"].get<double>(), 0);
    Process quiet({"run", scene("water"), "--out", folder.path() / "quiet", "--threads", "1", "--quiet"}, folder.path() / "log2");
    EXPECT_EQ(quiet.wait(), 0) << quiet.said();
    EXPECT_EQ(quiet.said().find("balance"), std::string::npos) << quiet.said();
    EXPECT_EQ(weir::test::first_difference(folder.path() / "loud", folder.path() / "quiet"), "");
}

TEST("frames, checkpoints and probes change no step: the last frame and the steps are the same bytes, however often frames are written") {
    TemporaryFolder folder;
    const auto steps_of = [&](const std::string& every, bool saves) {
        const auto out = folder.path() / every;
        std::vector<std::string> words{"run", scene("water"), "--out", out, "--threads", "1", "--set", "output.every=" + every};
        if (saves) words.insert(words.end(), {"--checkpoint-every", "2"});
        run(words, folder.path() / "log");
        std::vector<double> dt;
        for (const auto& step : weir::test::rows_of(out / "steps.csv")) dt.push_back(step.at("dt [s]"));
        const std::string pvd = text_of(out / "grid.pvd");
        const auto file = pvd.rfind("file=\"") + 6;
        return std::pair{dt, text_of(out / pvd.substr(file, pvd.find('"', file) - file))};
    };
    const auto seldom = steps_of("100", false);
    EXPECT_EQ(steps_of("0.01", false), seldom);
    EXPECT_EQ(steps_of("0.037", true), seldom);
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
