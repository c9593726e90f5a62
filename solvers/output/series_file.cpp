#include "output/series_file.hpp"

#include "core/error.hpp"
#include "core/words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace weir::output {

namespace {

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
        text += "    <DataSet timestep=\"" + exact_text(entry.time) + "\" group=\"\" part=\"0\" file=\"" + entry.file + "\"/>\n";
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

SeriesIndex pvd_index() { return {".pvd", series_text, read_series}; }

}  // namespace weir::output
