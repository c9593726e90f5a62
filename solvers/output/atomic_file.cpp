#include "output/atomic_file.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

namespace weir::output {

namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void refuse(const std::filesystem::path& path, int reason) {
    throw OutputError("cannot write " + path.string() + ": " + std::strerror(reason));
}

/// 0, or why the bytes are not in the file now. A full disk may be reported by the write, by the flush, or only when the file is closed.
int write_through(const std::filesystem::path& path, std::string_view bytes) {
    std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "wb"));
    if (!file) return errno;
    const bool good = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size() && std::fflush(file.get()) == 0;
    const int reason = errno;
    if (std::fclose(file.release()) != 0 && good) return errno;
    return good ? 0 : reason;
}

/// What a path means: that which its links point to, also where nothing stands there yet.
std::filesystem::path target_of(std::filesystem::path path) {
    std::error_code failed;
    constexpr int most = 40;  // links in a row, as Linux has it
    for (int i = 0; i < most && std::filesystem::is_symlink(path, failed); ++i)
        path = path.parent_path() / std::filesystem::read_symlink(path, failed);  // an absolute link replaces all of it
    return path;
}

}  // namespace

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    const auto target = target_of(path);
    std::error_code ignored;
    if (std::filesystem::is_other(target, ignored)) {
        if (const int reason = write_through(target, bytes)) refuse(path, reason);
        return;
    }
    auto temporary = target;
    temporary += ".part";
    int reason = write_through(temporary, bytes);
    if (reason == 0 && std::rename(temporary.c_str(), target.c_str()) != 0) reason = errno;
    if (reason == 0) return;
    std::remove(temporary.c_str());
    refuse(path, reason);
}

void require_writable(const std::filesystem::path& folder) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) throw OutputError("cannot make the output folder " + folder.string() + ": " + failed.message());
    const auto probe = folder / ".weir_can_write";
    write_file(probe, "");
    std::filesystem::remove(probe, failed);
}

}  // namespace weir::output
