// Files and names of strangers: nothing that a case file, a folder's name or a damaged file holds is run, leaves --out, removes what is
// the user's, or crashes.
#include "app/process.hpp"
#include "output/folder_lock.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <algorithm>

#include <sys/stat.h>

namespace {

namespace fs = std::filesystem;
using weir::test::Answer;
using weir::test::Process;
using weir::test::TemporaryFolder;
using weir::test::text_of;
using weir::test::weir_says;

void write(const fs::path& file, const std::string& text) {
    if (file.has_parent_path()) fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

/// A folder to be in, which nothing but what the test expects may stand in.
class Inside {
public:
    explicit Inside(const fs::path& folder) : before_(fs::current_path()) { fs::current_path(folder); }
    ~Inside() { fs::current_path(before_); }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

private:
    fs::path before_;
};

/// Names in the folder that we are in.
std::vector<std::string> names_here() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(".")) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

const std::string tiny_scene =
    "solver = \"mac\"\ndim = 2\ngrid = { cells = [8, 8], size = [1, 1] }\ntime = { end = 0.02, dt = 0.01 }\noutput = { every = 0.01 }\n"
    "initial.temperature = { name = \"constant\", value = 300.0 }\n";
const std::string tiny_case =
    "question = \"q\"\nblind_to = \"all\"\nkind = \"exact\"\n"
    "accept = [ { metric = \"divergence.max\", at_most = 1, why = \"nothing moves\" } ]\n";

/// A run of three frames, made once.
const fs::path& tiny_run() {
    static TemporaryFolder folder;
    static const fs::path out = folder.path() / "run";
    if (fs::exists(out)) return out;
    write(folder.path() / "scene.toml", tiny_scene);
    EXPECT_EQ(weir_says({"run", folder.path() / "scene.toml", "--out", out, "--threads", "1"}).code, 0);
    return out;
}

TEST("a case whose 'over' would name folders outside --out or hold commands is refused with its line, and nothing is written") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    write("evil/scene.toml", tiny_scene);
    write("evil/case.toml", tiny_case + "over = { key = \"title\", values = ['\"a\"', '\"../../../../ESC\"', '\"`touch X`\"'] }\n");
    const Answer answer = weir_says({"validate", "evil/", "--out", "out/a/b/c/d", "--threads", "1"});
    EXPECT_EQ(answer.code, 2);
    EXPECT_NE(answer.text.find("evil/case.toml:5:"), std::string::npos) << answer.text;
    EXPECT_NE(answer.text.find("may have letters, digits and _ - + . only"), std::string::npos) << answer.text;
    EXPECT_EQ(names_here(), std::vector<std::string>{"evil"});
}

TEST("names of folders with quotes, spaces, back quotes, pipes and % are names: cases are judged and drawn, and nothing of them is run") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    const std::string name = "it's \"a\" `touch X`; $(touch Y) 100% \\";
    write(name + "/scene.toml", tiny_scene);
    write(name + "/case.toml", tiny_case);
    for (const std::string out : {"| touch Z;/p", "'; touch W; '", "-x"}) {
        const Answer answer = weir_says({"validate", name + "/", "--out=" + out, "--threads", "1"});
        EXPECT_EQ(answer.code, 0) << answer.text;
        const std::string drawn = text_of(fs::path(out) / "svg" / (name + ".svg"));
        EXPECT_NE(drawn.find("`touch X`"), std::string::npos) << out;
        EXPECT_NE(drawn.find("</svg>"), std::string::npos) << out;
    }
    EXPECT_EQ(names_here(), (std::vector<std::string>{"'; touch W; '", "-x", name, "| touch Z;"}));
}

TEST("a path with bytes that are not UTF-8 is a path: runs and plans end as elsewhere") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    write("caf\xe9/small.toml", tiny_scene);
    EXPECT_EQ(weir_says({"run", "caf\xe9/small.toml", "--out", "out", "--threads", "1"}).code, 0);
    const Answer plan = weir_says({"plan", "caf\xe9/small.toml", "--of", "kinetic_energy", "--error", "1", "--out", "plan", "--quiet"});
    EXPECT_EQ(plan.code, 0) << plan.text;
}

TEST("weir validate ends with 2 where a figure could not be drawn, and its numbers are there") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    write("small/scene.toml", tiny_scene);
    write("small/case.toml", tiny_case);
    const std::string path = getenv("PATH");
    setenv("PATH", "/nowhere", 1);
    const Answer answer = weir_says({"validate", "small/", "--out", "out", "--threads", "1"});
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(answer.code, 2);
    EXPECT_NE(answer.text.find("cannot draw out/svg/small.svg: gnuplot is not on the PATH"), std::string::npos) << answer.text;
    EXPECT_TRUE(fs::exists("out/verdicts.json"));
}

TEST("a film removes nothing of the user's, and takes its name whatever it begins with or holds") {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
    TemporaryFolder folder;
    const Inside here(folder.path());
    write("user.mp4.frames/precious", "mine");
    fs::create_directory("poster.png");
    fs::copy(tiny_run(), "a 'run' 50% %d \"x\"", fs::copy_options::recursive);
    const auto movie = [](const std::string& out) {
        return weir_says({"movie", "a 'run' 50% %d \"x\"", "--size", "32", "--quiet", "--out=" + out});
    };
    for (const std::string out : {"user.mp4", "-f.mp4", "100%d 'q'/a:b %06d.webm"}) {
        const Answer answer = movie(out);
        EXPECT_EQ(answer.code, 0) << out << ": " << answer.text;
        EXPECT_GT(text_of(out).size(), 500u) << out;
        EXPECT_TRUE(fs::exists(fs::path(out).replace_extension(".png"))) << out;
    }
    EXPECT_EQ(text_of("user.mp4.frames/precious"), "mine");
    const Answer blocked = movie("poster.mp4");  // its poster's name is a folder's
    EXPECT_EQ(blocked.code, 2);
    EXPECT_NE(blocked.text.find("poster.png: this is a folder"), std::string::npos) << blocked.text;
    EXPECT_EQ(names_here(), (std::vector<std::string>{"-f.mp4", "-f.png", "100%d 'q'", "a 'run' 50% %d \"x\"", "poster.png", "user.mp4",
                                                      "user.mp4.frames", "user.png"}));
}

TEST("the poster of a film replaces the poster of an earlier film, and no other file: that is refused before anything is drawn") {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
    TemporaryFolder folder;
    const Inside here(folder.path());
    const auto movie = [](const std::string& out) { return weir_says({"movie", tiny_run(), "--size", "32", "--quiet", "--out", out}); };
    EXPECT_EQ(weir_says({"picture", tiny_run(), "--size", "32", "--out", "picture.png"}).code, 0);
    write("holiday.png", "mine");
    fs::create_symlink("holiday.png", "link.png");
    const std::string picture = text_of("picture.png");
    for (const std::string name : {"holiday", "picture", "link"}) {
        const Answer answer = movie(name + ".mp4");
        EXPECT_EQ(answer.code, 2) << answer.text;
        EXPECT_NE(answer.text.find(name + ".png: the poster of " + name + ".mp4 would overwrite this file"), std::string::npos)
            << answer.text;
    }
    EXPECT_EQ(text_of("holiday.png"), "mine");
    EXPECT_EQ(text_of("picture.png"), picture);
    EXPECT_EQ(names_here(), (std::vector<std::string>{"holiday.png", "link.png", "picture.png"}));
    for (int again = 0; again < 2; ++again) EXPECT_EQ(movie("new.mp4").code, 0) << again;
}

TEST("a damaged frame is named with exit 2, by pictures and films alike, and no file is left of them") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    fs::copy(tiny_run(), "run", fs::copy_options::recursive);
    const std::string frame = "run/frames/grid_000002.vti", whole = text_of(frame);
    const std::size_t data = whole.find("<AppendedData"), end = whole.rfind("</AppendedData>");
    std::vector<std::string> damaged{"", "<VTKFile", whole.substr(0, data), whole.substr(0, whole.size() - 60)};
    for (const std::size_t at :
         {whole.find("byte_order=") + 14, whole.find("Extent=") + 10, whole.find("NumberOfComponents=") + 20, end - 12, end - 30}) {
        damaged.push_back(whole);
        damaged.back()[at] ^= 0x55;
    }
    for (const std::string& bytes : damaged) {
        write(frame, bytes);
        for (const std::vector<std::string>& words : {std::vector<std::string>{"picture", "run", "--size", "32", "--out", "a.png"},
                                                      {"movie", "run", "--size", "32", "--out", "a.mp4"}}) {
            if (words[0] == "movie" && std::system("ffmpeg -version > /dev/null 2>&1") != 0) continue;
            const Answer answer = weir_says(words);
            EXPECT_EQ(answer.code, 2) << answer.text;
            EXPECT_NE(answer.text.find(frame), std::string::npos) << answer.text;
        }
    }
    EXPECT_EQ(names_here(), std::vector<std::string>{"run"});
}

TEST("a run.json of any shape is refused with exit 2 by pictures, and says what it lacks") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    fs::copy(tiny_run(), "run", fs::copy_options::recursive);
    for (const std::string text :
         {"", "null", "[]", "{}", "7", "\"scene\"", "{\"scene\": null}", "{\"scene\": 3}", "{\"scene\": []}", "{\"scene\": {}}",
          "{\"scene\": {\"source\": 1, \"file\": \"a\"}}", "{\"scene\": {\"source\": \"\", \"file\": \"a\", \"overrides\": {\"a\": 1}}}",
          "{\"scene\": {\"source\": \"\", \"file\": \"a\", \"overrides\": [1]}}", "{\"scene\": {\"source\": \"\", \"file\": null}}",
          "{\"scene\": {\"source\": \"x = 1\", \"file\": \"a.toml\"}}",
          "{\"scene\": {\"source\": \"\", \"file\": \"a\", \"overrides\": [\"=\"]}}"}) {
        write("run/run.json", text);
        const Answer answer = weir_says({"picture", "run", "--out", "a.png"});
        EXPECT_EQ(answer.code, 2) << text << ": " << answer.text;
        EXPECT_FALSE(answer.text.empty()) << text;
    }
    EXPECT_EQ(names_here(), std::vector<std::string>{"run"});
}

TEST(
    "leave grid.cells, grid.size and grid.origin unchanged: --restart with other cells, size or origin is refused, and no frame is "
    "touched") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    for (const std::string solver : {"smoke", "dam"}) {
        const std::string scene = std::string(WEIR_SOURCE_DIR) + "/tests/app/scenes/" + solver + ".toml";
        fs::remove_all("run");
        ASSERT_EQ(weir_says({"run", scene, "--out", "run", "--threads", "1", "--checkpoint-every", "1", "--set", "time.end=0.02"}).code, 0);
        const std::string before = text_of("run/grid.pvd") + text_of("run/particles.pvd");
        const std::string size = solver == "smoke" ? "grid.size=[3, 3]" : "grid.size=[2, 1]";
        for (const std::string& change : {size, std::string("grid.origin=[0.01, 0]")}) {
            const Answer answer = weir_says({"run", "--restart", "run", "--threads", "1", "--set", "time.end=0.04", "--set", change});
            EXPECT_EQ(answer.code, 2) << change << ": " << answer.text;
            EXPECT_NE(answer.text.find("leave grid.cells, grid.size and grid.origin unchanged"), std::string::npos) << answer.text;
        }
        EXPECT_EQ(text_of("run/grid.pvd") + text_of("run/particles.pvd"), before);
        EXPECT_EQ(weir_says({"run", "--restart", "run", "--threads", "1", "--set", "time.end=0.04"}).code, 0);
    }
}

TEST("OMP_NUM_THREADS of more threads than a thousand is refused with what is allowed") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    write("a.toml", tiny_scene);
    const std::string before = getenv("OMP_NUM_THREADS") ? getenv("OMP_NUM_THREADS") : "1";
    setenv("OMP_NUM_THREADS", "99999", 1);
    const Answer answer = weir_says({"run", "a.toml", "--out", "out"});
    setenv("OMP_NUM_THREADS", before.c_str(), 1);
    EXPECT_EQ(answer.code, 2);
    EXPECT_NE(answer.text.find("OMP_NUM_THREADS=99999: expected a number of threads from 1 to 1024"), std::string::npos) << answer.text;
    EXPECT_FALSE(fs::exists("out"));
}

TEST("WEIR_FORKED_RANKS that is no number of ranks is refused with what is allowed") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    write("a.toml", tiny_scene);
    for (const std::string given : {"x", "", "0", "-2", "3x", "17", "99999999999"}) {
        setenv("WEIR_FORKED_RANKS", given.c_str(), 1);
        const Answer answer = weir_says({"run", "a.toml", "--out", "out"});
        unsetenv("WEIR_FORKED_RANKS");
        EXPECT_EQ(answer.code, 2) << given;
        EXPECT_EQ(answer.text, "WEIR_FORKED_RANKS=" + given + ": expected a number of ranks from 1 to 16\n");
    }
    EXPECT_FALSE(fs::exists("out"));
}

TEST("where memory is scarce a run ends; where OpenBLAS waits for memory at its end, a signal ends it") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    write("a.toml", tiny_scene);
    for (const std::string kilobytes : {"150000", "200000", "300000"}) {
        const std::string command = "ulimit -v " + kilobytes +
                                    "; unset OMP_NUM_THREADS; exec timeout -k 2 20 " WEIR_EXECUTABLE
                                    " run a.toml --out out --quiet --threads 1 > log 2>&1";
        const int status = std::system(command.c_str());
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) != 124 && WEXITSTATUS(status) != 137) << kilobytes << ": " << text_of("log");
    }
    const int status = std::system("ulimit -v 200000; OPENBLAS_NUM_THREADS=2 exec timeout -k 5 3 " WEIR_EXECUTABLE
                                   " run a.toml --out out --quiet --threads 1 > log 2>&1");
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) != 137) << text_of("log");  // 137: SIGTERM did not end it
}

TEST("a scene whose name is dots writes below out/, as one beside the folder that we are in does") {
    TemporaryFolder folder;
    fs::create_directory(folder.path() / "inner");
    const Inside here(folder.path() / "inner");
    write("...toml", tiny_scene), write("..toml", tiny_scene), write("../scene.toml", tiny_scene);
    for (const std::string scene : {"...toml", "..toml", "../scene.toml"})
        EXPECT_EQ(weir_says({"run", scene, "--threads", "1", "--quiet"}).code, 0) << scene;
    EXPECT_EQ(names_here(), (std::vector<std::string>{"...toml", "..toml", "out"}));
    EXPECT_TRUE(fs::exists("out/...toml/run.json"));
    EXPECT_TRUE(fs::exists("out/..toml/run.json"));
    EXPECT_TRUE(fs::exists("out/" + folder.path().filename().string() + "/run.json"));
}

TEST("meshes and terrain that are nothing, a looped link, a pipe or without end are refused at once with their place") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    fs::create_symlink("loop.stl", "loop.stl");
    fs::create_symlink("/dev/zero", "endless.stl");
    ASSERT_EQ(mkfifo("pipe.stl", 0600), 0);
    for (const std::string file : {"", "loop.stl", "endless.stl", "pipe.stl", "."}) {
        write("mesh.toml",
              "solver = \"mac\"\ndim = 3\ngrid = { cells = [8, 8, 8], size = [1, 1, 1] }\ntime = { end = 0.02, dt = 0.01 }\n"
              "initial.temperature = { name = \"constant\", value = 300.0 }\nsolids = [ { shape = \"mesh\", file = \"" +
                  file + "\" } ]\n");
        const Answer mesh = weir_says({"run", "mesh.toml", "--out", "out"});
        EXPECT_EQ(mesh.code, 2) << file;
        EXPECT_NE(mesh.text.find("mesh.toml:6:"), std::string::npos) << mesh.text;
        write("terrain.toml", text_of(std::string(WEIR_SOURCE_DIR) + "/tests/input/bad/heightfield_grid_nowhere.toml"));
        std::string scene = text_of("terrain.toml");
        scene.replace(scene.find("terrain/nowhere.asc"), 19, file);
        write("terrain.toml", scene);
        const Answer terrain = weir_says({"run", "terrain.toml", "--out", "out"});
        EXPECT_EQ(terrain.code, 2) << file;
        EXPECT_NE(terrain.text.find("terrain.toml:6:"), std::string::npos) << terrain.text;
    }
    EXPECT_FALSE(fs::exists("out"));
    fs::create_symlink("loop.toml", "loop.toml");
    const Answer loop = weir_says({"run", "loop.toml"});
    EXPECT_EQ(loop.code, 2);
    EXPECT_NE(loop.text.find("loop.toml: "), std::string::npos) << loop.text;
    EXPECT_EQ(loop.text.find("cannot write"), std::string::npos) << loop.text;
}

}  // namespace

namespace {

/// What the executable says within ten seconds; code 124 where it does not end.
Answer says_in_time(const std::string& words) {
    const int status = std::system(("timeout -k 1 10 " WEIR_EXECUTABLE " " + words + " > log 2>&1").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of("log")};
}

}  // namespace

TEST("scenes, cases and checkpoints that are pipes which no program writes to, or devices, are refused at once; other pipes are read") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    ASSERT_EQ(mkfifo("pipe.toml", 0600), 0);
    fs::create_directory("case");
    write("case/scene.toml", tiny_scene);
    ASSERT_EQ(mkfifo("case/case.toml", 0600), 0);
    for (const auto& [words, message] :
         {std::pair{"run pipe.toml --out out", "pipe.toml: no program writes to this pipe"},
          {"validate case/ --out out", "case.toml: no program writes to this pipe"},
          {"run --restart pipe.toml --out out", "pipe.toml: cannot read checkpoint"},
          {"run /dev/zero --out out", "/dev/zero: this is a device or a socket; regular files and pipes are read"},
          {"run /dev/null --out out", "/dev/null: this is a device or a socket; regular files and pipes are read"}}) {
        const Answer answer = says_in_time(words);
        EXPECT_EQ(answer.code, 2) << words << ": " << answer.text;
        EXPECT_NE(answer.text.find(message), std::string::npos) << answer.text;
    }
    EXPECT_FALSE(fs::exists("out"));
    write("a.toml", tiny_scene);
    EXPECT_EQ(std::system("(sleep 0.3; cat a.toml) | timeout 10 " WEIR_EXECUTABLE " run /dev/stdin --out late --threads 1 > log 2>&1"), 0)
        << text_of("log");
    EXPECT_TRUE(fs::exists("late/run.json"));
}

TEST("two programs do not write verdicts into one folder: weir validate ends with 2 where another has the folder, and writes nothing") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    write("small/scene.toml", tiny_scene), write("small/case.toml", tiny_case);
    fs::create_directory("out");
    {
        const weir::output::FolderLock lock("out");
        const Answer answer = weir_says({"validate", "small/", "--out", "out", "--threads", "1"});
        EXPECT_EQ(answer.code, 2);
        EXPECT_NE(answer.text.find("out: another run writes into this folder (process "), std::string::npos) << answer.text;
        EXPECT_FALSE(fs::exists("out/csv") || fs::exists("out/verdicts.json"));
    }
    EXPECT_EQ(weir_says({"validate", "small/", "--out", "out", "--threads", "1"}).code, 0);
    EXPECT_FALSE(fs::exists("out/.weir_lock"));
}

TEST("nor tables of limits and of cost") {
    TemporaryFolder folder;
    const Inside here(folder.path());
    fs::create_directory("out");
    const weir::output::FolderLock lock("out");
    for (const std::vector<std::string>& words : {std::vector<std::string>{"stability", "taylor_green", "--floors"},
                                                  {"cost", "cavity"},
                                                  {"cost", "--report-table"},
                                                  {"cost", "--effects"}}) {
        std::vector<std::string> all = words;
        all.insert(all.end(), {"--out", "out", "--threads", "1"});
        const Answer answer = weir_says(all);
        EXPECT_EQ(answer.code, 2) << words[0];
        EXPECT_NE(answer.text.find("out: another run writes into this folder (process "), std::string::npos) << answer.text;
        EXPECT_EQ(std::distance(fs::directory_iterator("out"), fs::directory_iterator()), 1) << words[0];
    }
}
