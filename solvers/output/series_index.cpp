#include "output/series_index.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

namespace weir::output {

namespace {

constexpr const char* csv_head = "time [s],file";

std::string csv_text(const std::vector<SeriesEntry>& entries) {
    std::string text = csv_head + std::string("\n");
    for (const auto& entry : entries) text += exact_text(entry.time) + ',' + entry.file + '\n';
    return text;
}

std::vector<SeriesEntry> read_csv(const std::filesystem::path& file) {
    std::ifstream text(file, std::ios::binary);
    std::string line;
    if (!std::getline(text, line) || line != csv_head) throw BadInput(file.string() + ": not a series of frames");
    std::vector<SeriesEntry> entries;
    while (std::getline(text, line)) {
        SeriesEntry entry;
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), entry.time);
        const auto comma = static_cast<std::size_t>(end - line.data());
        if (error != std::errc() || !std::isfinite(entry.time) || comma + 1 >= line.size() || line[comma] != ',')
            throw BadInput(file.string() + ": a series entry lacks its time or its file");
        entry.file = line.substr(comma + 1);
        entries.push_back(std::move(entry));
    }
    return entries;
}

}  // namespace

SeriesIndex csv_index() { return {".csv", csv_text, read_csv}; }

std::string exact_text(real value) {
    char text[40];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::vector<std::filesystem::path> series_in(const std::filesystem::path& folder, const SeriesIndex& index) {
    std::vector<std::filesystem::path> names;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
        if (entry.path().extension() == index.extension && is_ours(entry.path(), index)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<SeriesEntry> truncate_series(const std::filesystem::path& file, std::int64_t kept, const SeriesIndex& index) {
    auto entries = index.read(file);
    const auto stay = std::min(entries.size(), static_cast<std::size_t>(kept));
    const std::vector<SeriesEntry> gone(entries.begin() + static_cast<std::ptrdiff_t>(stay), entries.end());
    entries.resize(stay);
    std::error_code ignored;
    if (entries.empty()) {
        std::filesystem::remove(file, ignored);
    } else if (!gone.empty()) {
        write_file(file, index.text(entries));  // the list first, so that it never names a removed file
    }
    for (const auto& entry : gone) std::filesystem::remove(file.parent_path() / entry.file, ignored);
    return entries;
}

bool is_ours(const std::filesystem::path& file, const SeriesIndex& index) {
    try {
        const auto entries = index.read(file);
        return std::all_of(entries.begin(), entries.end(), [](const SeriesEntry& entry) {
            return entry.file.starts_with(frame_folder + std::string("/")) && entry.file.find("..") == std::string::npos;
        });
    } catch (const BadInput&) {
        return false;
    }
}

}  // namespace weir::output
