// A file that is either the old one or the new one, never half of it: written beside its name, then renamed. What is no regular file (a
// device, a pipe) stays what it is and is written to; a symbolic link stays, and the file that it points to is replaced.
#pragma once
#include <filesystem>
#include <string_view>

namespace weir::output {

/// Throws OutputError with the system's reason (disk full, folder gone); what stood under this name stays readable then.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Makes the folder and proves that a file can be written in it. Throws OutputError.
void require_writable(const std::filesystem::path& folder);

}  // namespace weir::output
