// ParaView's .pvd: a list of times and files, in the plain form written here.
#pragma once
#include "core/types.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace weir::output {

struct SeriesEntry {
    real time = 0;     // [s]
    std::string file;  // relative to the .pvd
};

std::string series_text(const std::vector<SeriesEntry>& entries);
/// Throws BadInput when the file is not a series written by weir.
std::vector<SeriesEntry> read_series(const std::filesystem::path& pvd);
/// The folder of a series' frames, beside the .pvd.
inline constexpr const char* frame_folder = "frames";

/// Returns whether this is a readable .pvd all of whose frames lie in `frame_folder`: only such files are ever changed or removed.
bool is_ours(const std::filesystem::path& pvd);
/// Names of the .pvd files by weir in a folder, sorted.
std::vector<std::filesystem::path> series_in(const std::filesystem::path& folder);
/// Keeps the first `kept` entries; removes the files of the others, and the .pvd itself when nothing is left. Returns the kept entries.
std::vector<SeriesEntry> truncate_series(const std::filesystem::path& pvd, std::int64_t kept);

}  // namespace weir::output
