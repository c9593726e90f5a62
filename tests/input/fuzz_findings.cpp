// What the fuzzers found, and the files that they start from: each is read, or refused with a message.
#include "fuzz/targets.hpp"
#include "input/bad_folder.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

using namespace weir;
namespace fs = std::filesystem;

namespace {

using fuzz::made_up;

fs::path source() { return WEIR_SOURCE_DIR; }

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    if (!fs::exists(folder)) return files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

TEST("everything that the fuzzers found is read or refused in words, and nothing else happens") {
    for (const fuzz::Kind& kind : fuzz::kinds)
        for (const auto& file : files_in(source() / "tests/input/fuzz" / kind.name))
            EXPECT_NO_THROW(EXPECT_FALSE(kind.read(test::content(file)) && kind.read == made_up) << file) << file;
}

TEST("the files that the fuzzers start from are good ones, of every kind") {
    for (const fuzz::Kind& kind : fuzz::kinds) {
        const auto files = files_in(source() / "tests/fuzz/corpus" / kind.name);
        EXPECT_GE(files.size(), 1U) << kind.name;
        for (const auto& file : files) EXPECT_TRUE(kind.read(test::content(file))) << file;
    }
}

TEST("any of them cut off, or with any byte changed, is read or refused") {
    const auto tried = [](const fuzz::Kind& kind, const std::string& bytes, const std::string& what) {
        EXPECT_NO_THROW((void)kind.read(bytes)) << kind.name << ' ' << what;
    };
    for (const fuzz::Kind& kind : fuzz::kinds) {
        if (kind.read == fuzz::made_up) continue;  // below, at every byte
        for (const auto& file : files_in(source() / "tests/fuzz/corpus" / kind.name)) {
            const auto text = test::content(file);
            for (std::size_t part = 1; part < 12; ++part) {
                const std::size_t at = text.size() * part / 12;
                tried(kind, text.substr(0, at), fmt::format("{} cut off at {}", file.string(), at));
                std::string changed = text;
                changed[at] = static_cast<char>(changed[at] ^ (part % 2 ? 0x80 : 0x15));
                tried(kind, changed, fmt::format("{} with byte {} changed", file.string(), at));
            }
        }
    }
}

TEST("a text cut off anywhere, or with any byte changed, is read or refused") {
    const auto text = test::content(source() / "tests/fuzz/corpus/made_up/good_smoke.toml");
    for (std::size_t n = 0; n <= text.size(); ++n) (void)made_up(text.substr(0, n));
    for (std::size_t i = 0; i < text.size(); ++i)
        for (const char c : {'\0', '\n', '"', '[', '}', '=', '9', '\xC9', '\xFF'}) {
            std::string changed = text;
            changed[i] = c;
            (void)made_up(changed);
        }
}

TEST("depth and length without end are refused") {
    const auto many = [](const std::string& s, int n) {
        std::string out;
        for (int i = 0; i < n; ++i) out += s;
        return out;
    };
    EXPECT_FALSE(made_up("a = " + many("[", 100000)));
    EXPECT_FALSE(made_up("a = " + many("[\n", 100000)));
    EXPECT_FALSE(made_up("a = " + many("{a=", 100000)));
    EXPECT_FALSE(made_up(many("a.", 100000) + "a = 1"));
    EXPECT_FALSE(made_up("[" + many("a.", 100000) + "a]"));
    EXPECT_FALSE(made_up(many("a = 1\n", 10000)));
    EXPECT_FALSE(made_up("title = \"" + many("x", 2000000) + "\""));
    EXPECT_FALSE(made_up(many("k", 100000) + " = 1"));
    EXPECT_FALSE(made_up("#! " + many("a.", 1000) + "b=1\n"));
#ifdef WEIR_HAS_VTK
    EXPECT_FALSE(fuzz::frame(many("<?>", 2000000)));  // one call for each was deeper than the stack
    // A tag's attributes were looked for to the end of the file: 8e10 characters here.
    EXPECT_TRUE(fuzz::frame("<VTKFile type=\"Collection\">" + many("<DataSet file=\"a\" ", 300000) + "timestep=\"0\"></VTKFile>"));
#endif
    EXPECT_FALSE(made_up("#! a" + many("[0]", 1000) + "=1\n"));
}
