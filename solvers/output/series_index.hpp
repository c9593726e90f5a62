// The index of a series of frames: a file beside the folder of frames that lists their times and files.
#pragma once
#include "core/types.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace weir::output {

struct SeriesEntry {
    real time = 0;     // [s]
    std::string file;  // relative to the index
};

/// How a format writes and reads its index.
struct SeriesIndex {
    const char* extension;
    std::string (*text)(const std::vector<SeriesEntry>& entries);
    /// Throws BadInput when the file is not an index written by weir.
    std::vector<SeriesEntry> (*read)(const std::filesystem::path& file);
};

/// NAME.csv with a row "time [s],file" per frame.
SeriesIndex csv_index();

/// The folder of a series' frames, beside the index.
inline constexpr const char* frame_folder = "frames";

/// The shortest text that reads back as the same double.
std::string exact_text(real value);

/// Returns whether this is a readable index all of whose frames lie in `frame_folder`: only such files are ever changed or removed.
bool is_ours(const std::filesystem::path& file, const SeriesIndex& index);
/// Names of the indices by weir in a folder, sorted.
std::vector<std::filesystem::path> series_in(const std::filesystem::path& folder, const SeriesIndex& index);
/// Keeps the first `kept` entries; removes the files of the others, and the index itself when nothing is left. Returns the kept entries.
std::vector<SeriesEntry> truncate_series(const std::filesystem::path& file, std::int64_t kept, const SeriesIndex& index);

}  // namespace weir::output
