// Bad input through the front door: `weir run` ends with exit code 2, says what is wrong, and writes nothing.
#include "input/bad_folder.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <sys/wait.h>

#include <cstdlib>

using namespace weir;
namespace fs = std::filesystem;

namespace {

struct Ended {
    int exit_code;
    std::string complaint;
};

Ended weir_run(const std::string& scene, const fs::path& out, const fs::path& log, const std::string& options = "") {
    const std::string command = std::string(WEIR_BINARY_DIR) + "/weir run '" + scene + "' --out '" + out.string() + "' " + options +
                                " >/dev/null 2>'" + log.string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::content(log)};
}

}  // namespace

TEST("every bad scene ends weir run with exit code 2, its message, and nothing written") {
    const test::InBadFolder here;
    const test::TemporaryFolder folder;
    const fs::path out = folder.path() / "out", log = folder.path() / "log";
    for (const auto& scene : test::bad_scenes()) {
        const auto ended = weir_run(scene.string(), out, log);
        EXPECT_EQ(ended.exit_code, 2) << scene;
        EXPECT_EQ(ended.complaint, test::content(test::expected_file(scene))) << scene;
        EXPECT_FALSE(fs::exists(out)) << scene;
    }
}

TEST("a scene that is not there, a folder without one, and a bad override are refused like bad scenes") {
    const test::InBadFolder here;
    const test::TemporaryFolder folder;
    const fs::path out = folder.path() / "out", log = folder.path() / "log";
    const auto absent = weir_run("absent.toml", out, log);
    EXPECT_EQ(absent.exit_code, 2);
    EXPECT_EQ(absent.complaint, "absent.toml: there is no such file\n");
    const auto empty = weir_run("..", out, log);
    EXPECT_EQ(empty.exit_code, 2);
    EXPECT_EQ(empty.complaint, "..: this folder has no scene.toml\n");
    const auto change = weir_run("01_unknown_key.toml", out, log, "--set grid.cels=[4,4]");
    EXPECT_EQ(change.exit_code, 2);
    EXPECT_NE(change.complaint.find("--set grid.cels=[4,4]: unknown key \"cels\" in grid; did you mean \"cells\"?"), std::string::npos)
        << change.complaint;
    EXPECT_NE(change.complaint.find("unknown key \"tittle\""), std::string::npos) << "the file's own problems are listed too";
    EXPECT_FALSE(fs::exists(out));
}
