// ParaView's .pvd: a list of times and files. We write and read the plain form that we write.
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
/// Throws BadInput when the file is not a series of ours.
std::vector<SeriesEntry> read_series(const std::filesystem::path& pvd);
/// Where a series of ours keeps its frames, beside the .pvd.
inline constexpr const char* frame_folder = "frames";

/// Whether this is a readable .pvd all of whose frames stand in `frame_folder`: only such files are ever changed or removed.
bool is_ours(const std::filesystem::path& pvd);
/// Names of the .pvd files of ours in a folder, sorted.
std::vector<std::filesystem::path> series_in(const std::filesystem::path& folder);
/// Keeps the first `kept` entries; removes the files of the others, and the .pvd itself when nothing is left. Returns what was kept.
std::vector<SeriesEntry> truncate_series(const std::filesystem::path& pvd, std::int64_t kept);

}  // namespace weir::output
