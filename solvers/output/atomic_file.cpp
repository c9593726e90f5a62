#include "output/atomic_file.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <cstring>
#include <string>

namespace weir::output {

namespace {

/// Resolves the symbolic links of a path, also where the target does not exist yet.
std::filesystem::path target_of(std::filesystem::path path) {
    std::error_code failed;
    constexpr int most = 40;  // number of links, as in Linux
    for (int i = 0; i < most && std::filesystem::is_symlink(path, failed); ++i)
        path = path.parent_path() / std::filesystem::read_symlink(path, failed);  // an absolute link replaces the whole path
    return path;
}

}  // namespace

NewFile::NewFile(const std::filesystem::path& path) : path_(path), target_(target_of(path)), written_(target_) {
    std::error_code ignored;
    if (!std::filesystem::is_other(target_, ignored)) written_ += ".part";
    file_.reset(std::fopen(written_.c_str(), "wb"));
    if (!file_) refuse(errno);
}

NewFile::~NewFile() {
    if (!file_) return;
    file_.reset();
    if (written_ != target_) std::remove(written_.c_str());
}

void NewFile::refuse(int reason) const { throw OutputError("cannot write " + path_.string() + ": " + std::strerror(reason)); }

void NewFile::write(std::string_view bytes) {
    if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) refuse(errno);
}

void NewFile::write_over_start(std::string_view bytes) {
    if (std::fseek(file_.get(), 0, SEEK_SET) != 0) refuse(errno);
    write(bytes);
}

/// A full disk may be reported by the write, by the flush, or only when the file is closed.
void NewFile::finish() {
    if (std::fflush(file_.get()) != 0) refuse(errno);
    int reason = std::fclose(file_.release()) != 0 ? errno : 0;
    if (written_ == target_) return reason == 0 ? void() : refuse(reason);
    if (reason == 0 && std::rename(written_.c_str(), target_.c_str()) != 0) reason = errno;
    if (reason == 0) return;
    std::remove(written_.c_str());
    refuse(reason);
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    NewFile file(path);
    file.write(bytes);
    file.finish();
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
