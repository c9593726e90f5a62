// A file that is replaced atomically: written under a temporary name beside it, then renamed. A non-regular file (device, pipe) is written
// in place; for a symbolic link the target is replaced.
#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace weir::output {

/// Such a file, written in pieces. Without finish() the destructor removes everything. All functions throw OutputError with the system's
/// reason (disk full, folder gone); the previous file stays readable then.
class NewFile {
public:
    explicit NewFile(const std::filesystem::path& path);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;
    void write(std::string_view bytes);
    /// Replaces the first bytes by as many others; no further writes are allowed.
    void write_over_start(std::string_view bytes);
    void finish();

private:
    [[noreturn]] void refuse(int reason) const;
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::filesystem::path path_, target_, written_;  // as given, resolved, and the temporary name
    std::unique_ptr<std::FILE, Close> file_;
};

/// Writes the whole file.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Creates the folder and checks that a file can be written in it. Throws OutputError.
void require_writable(const std::filesystem::path& folder);

}  // namespace weir::output
