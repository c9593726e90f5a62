// A file that is either the old one or the new one, never half of it: written beside its name, then renamed. What is no regular file (a
// device, a pipe) stays what it is and is written to; a symbolic link stays, and the file that it points to is replaced.
#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace weir::output {

/// Such a file, piece by piece. What has been written before finish() leaves nothing behind where it ends here. All throw OutputError with
/// the system's reason (disk full, folder gone); what stood under this name stays readable then.
class NewFile {
public:
    explicit NewFile(const std::filesystem::path& path);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;
    void write(std::string_view bytes);
    /// Other bytes in the place of the first ones, as many; then nothing more is written.
    void write_over_start(std::string_view bytes);
    void finish();

private:
    [[noreturn]] void refuse(int reason) const;
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::filesystem::path path_, target_, written_;  // as it was named, what that means, and under which name it is written
    std::unique_ptr<std::FILE, Close> file_;
};

/// All of it at once.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Makes the folder and proves that a file can be written in it. Throws OutputError.
void require_writable(const std::filesystem::path& folder);

}  // namespace weir::output
