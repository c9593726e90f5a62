// The part of README.md that holds numbers, written between two markers from what is published.
#pragma once
#include <filesystem>
#include <string>

namespace weir::validation {

inline constexpr const char* readme_begins = "<!-- results: written by `weir report --readme README.md`; do not edit -->";
inline constexpr const char* readme_ends = "<!-- end of results -->";

/// Water methods side by side with their sentences, claims by what they ask, limits; links begin with `prefix`.
std::string readme_part(const std::filesystem::path& results, const std::string& prefix);

/// Replaces what stands between the markers. Throws BadInput where the file or its markers are missing.
void update_readme(const std::filesystem::path& readme, const std::filesystem::path& results);

}  // namespace weir::validation
