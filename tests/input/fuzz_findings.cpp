// What the fuzzer found, and the texts that it starts from: each is read as a scene or refused with a message.
#include "fuzz/read_any.hpp"
#include "input/bad_folder.hpp"
#include "support/test.hpp"

using namespace weir;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

TEST("everything that the fuzzer found is refused in words") {
    const auto files = files_in(fs::path(WEIR_SOURCE_DIR) / "tests/input/fuzz");
    EXPECT_GE(files.size(), 1U);
    for (const auto& file : files) EXPECT_FALSE(test::read_any(test::content(file))) << file;
}

TEST("the texts that the fuzzer starts from are good scenes") {
    const auto files = files_in(fs::path(WEIR_SOURCE_DIR) / "tests/fuzz/corpus");
    EXPECT_GE(files.size(), 2U);
    for (const auto& file : files) EXPECT_TRUE(test::read_any(test::content(file))) << file;
}

TEST("a text cut off anywhere, or with any byte changed, is read or refused") {
    const auto text = test::content(fs::path(WEIR_SOURCE_DIR) / "tests/fuzz/corpus/good_smoke.toml");
    for (std::size_t n = 0; n <= text.size(); ++n) (void)test::read_any(text.substr(0, n));
    for (std::size_t i = 0; i < text.size(); ++i)
        for (const char c : {'\0', '\n', '"', '[', '}', '=', '9', '\xC9', '\xFF'}) {
            std::string changed = text;
            changed[i] = c;
            (void)test::read_any(changed);
        }
}

TEST("depth and length without end are refused") {
    const auto many = [](const std::string& s, int n) {
        std::string out;
        for (int i = 0; i < n; ++i) out += s;
        return out;
    };
    EXPECT_FALSE(test::read_any("a = " + many("[", 100000)));
    EXPECT_FALSE(test::read_any("a = " + many("[\n", 100000)));
    EXPECT_FALSE(test::read_any("a = " + many("{a=", 100000)));
    EXPECT_FALSE(test::read_any(many("a.", 100000) + "a = 1"));
    EXPECT_FALSE(test::read_any("[" + many("a.", 100000) + "a]"));
    EXPECT_FALSE(test::read_any(many("a = 1\n", 10000)));
    EXPECT_FALSE(test::read_any("title = \"" + many("x", 2000000) + "\""));
    EXPECT_FALSE(test::read_any(many("k", 100000) + " = 1"));
    EXPECT_FALSE(test::read_any("#! " + many("a.", 1000) + "b=1\n"));
    EXPECT_FALSE(test::read_any("#! a" + many("[0]", 1000) + "=1\n"));
}
