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

}  // namespace

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    auto temporary = path;
    temporary += ".part";
    std::unique_ptr<std::FILE, CloseFile> file(std::fopen(temporary.c_str(), "wb"));
    if (!file) refuse(path, errno);
    // a full disk may be reported by the write, by the flush, or only when the file is closed
    bool good = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size() && std::fflush(file.get()) == 0;
    int reason = errno;
    if (std::fclose(file.release()) != 0 && good) good = false, reason = errno;
    if (good && std::rename(temporary.c_str(), path.c_str()) != 0) good = false, reason = errno;
    if (good) return;
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
