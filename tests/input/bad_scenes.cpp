// Each tests/input/bad/NN_name.toml is refused with exactly the text of NN_name.expected. After a message was changed on purpose,
// WEIR_WRITE_EXPECTED=1 writes the new texts, to be read before they are committed.
#include "input/schemas.hpp"
#include "support/test.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace weir;
namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(WEIR_SOURCE_DIR) / "tests/input/bad";

std::vector<fs::path> bad_scenes() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string refusal(const fs::path& file) {
    try {
        (void)scene::read(file, test::schemas());
    } catch (const BadInput& e) {
        return std::string(e.what()) + "\n";
    }
    return "accepted\n";
}

}  // namespace

TEST("each bad scene is refused with exactly the expected message") {
    const fs::path before = fs::current_path();
    fs::current_path(folder);  // messages name the file as the user wrote it
    const auto files = bad_scenes();
    EXPECT_GE(files.size(), 50U);
    for (const auto& file : files) {
        const auto message = refusal(file.filename());
        auto expected = file;
        expected.replace_extension(".expected");
        if (std::getenv("WEIR_WRITE_EXPECTED")) std::ofstream(expected, std::ios::binary) << message;
        EXPECT_EQ(message, content(expected)) << file.filename();
    }
    fs::current_path(before);
}
