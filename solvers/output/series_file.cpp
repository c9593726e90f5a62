#include "output/series_file.hpp"

#include "core/error.hpp"
#include "core/words.hpp"
#include "output/atomic_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace weir::output {

namespace {

/// The shortest text that reads back as the same double.
std::string exact(real value) {
    char text[40];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// The value of `name="..."` in a tag.
std::string attribute(std::string_view tag, const std::string& name) {
    const std::size_t begin = tag.find(name + "=\"");
    if (begin == std::string_view::npos) return "";
    const std::size_t value = begin + name.size() + 2, end = tag.find('"', value);
    return end == std::string_view::npos ? "" : std::string(tag.substr(value, end - value));
}

}  // namespace

std::string series_text(const std::vector<SeriesEntry>& entries) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>\n";
    for (const auto& entry : entries)
        text += "    <DataSet timestep=\"" + exact(entry.time) + "\" group=\"\" part=\"0\" file=\"" + entry.file + "\"/>\n";
    return text + "  </Collection>\n</VTKFile>\n";
}

std::vector<SeriesEntry> read_series(const std::filesystem::path& pvd) {
    const std::string text = bytes_of(pvd);
    if (text.find("type=\"Collection\"") == std::string::npos || text.find("</VTKFile>") == std::string::npos)
        throw BadInput(pvd.string() + ": not a .pvd series");
    std::vector<SeriesEntry> entries;
    for (std::size_t at = text.find("<DataSet"), end = at; at != std::string::npos; at = text.find("<DataSet", end)) {
        end = std::min(text.find('>', at), text.size());
        const auto tag = std::string_view(text).substr(at, end - at);
        const std::string time = attribute(tag, "timestep");
        SeriesEntry entry{0, attribute(tag, "file")};
        const auto parsed = std::from_chars(time.data(), time.data() + time.size(), entry.time);
        if (entry.file.empty() || parsed.ec != std::errc() || !std::isfinite(entry.time))
            throw BadInput(pvd.string() + ": a series entry lacks its time or its file");
        entries.push_back(std::move(entry));
    }
    return entries;
}

std::vector<std::filesystem::path> series_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> names;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".pvd" && is_ours(entry.path())) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<SeriesEntry> truncate_series(const std::filesystem::path& pvd, std::int64_t kept) {
    auto entries = read_series(pvd);
    const auto stay = std::min(entries.size(), static_cast<std::size_t>(kept));
    const std::vector<SeriesEntry> gone(entries.begin() + static_cast<std::ptrdiff_t>(stay), entries.end());
    entries.resize(stay);
    std::error_code ignored;
    if (entries.empty()) {
        std::filesystem::remove(pvd, ignored);
    } else if (!gone.empty()) {
        write_file(pvd, series_text(entries));  // the list first, so that it never names a removed file
    }
    for (const auto& entry : gone) std::filesystem::remove(pvd.parent_path() / entry.file, ignored);
    return entries;
}

bool is_ours(const std::filesystem::path& pvd) {
    try {
        const auto entries = read_series(pvd);
        return std::all_of(entries.begin(), entries.end(), [](const SeriesEntry& entry) {
            return entry.file.starts_with(frame_folder + std::string("/")) && entry.file.find("..") == std::string::npos;
        });
    } catch (const BadInput&) {
        return false;
    }
}

}  // namespace weir::output
