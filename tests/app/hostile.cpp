// Files and names of strangers: nothing that a case file, a folder's name or a damaged file holds is run, leaves --out, removes what is
// the user's, or crashes.
#include "app/process.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

namespace {

namespace fs = std::filesystem;
using weir::test::Process;
using weir::test::TemporaryFolder;
using weir::test::text_of;

struct Answer {
    int code;
    std::string text;
};

Answer weir_says(std::vector<std::string> arguments) {
    TemporaryFolder folder;
    Process process(std::move(arguments), folder.path() / "log");
    const int code = process.wait();
    return {code, process.said()};
}

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
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

}  // namespace
