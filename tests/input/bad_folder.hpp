// The folder of bad scenes, for the tests that read them and those that run them.
#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace weir::test {

inline std::filesystem::path bad_folder() { return std::filesystem::path(WEIR_SOURCE_DIR) / "tests/input/bad"; }

/// Names of the scenes, without their folder: messages name a file as the user wrote it, so tests work in the folder.
inline std::vector<std::filesystem::path> bad_scenes() {
    std::vector<std::filesystem::path> names;
    for (const auto& entry : std::filesystem::directory_iterator(bad_folder()))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

inline std::string content(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline std::filesystem::path expected_file(std::filesystem::path scene) { return bad_folder() / scene.replace_extension(".expected"); }

/// Works in the folder of bad scenes, and goes back at the end.
class InBadFolder {
public:
    InBadFolder() : before_(std::filesystem::current_path()) { std::filesystem::current_path(bad_folder()); }
    ~InBadFolder() { std::filesystem::current_path(before_); }
    InBadFolder(const InBadFolder&) = delete;
    InBadFolder& operator=(const InBadFolder&) = delete;

private:
    std::filesystem::path before_;
};

}  // namespace weir::test
