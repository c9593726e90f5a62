// results/index.html: the whole report as one file that needs no network, made from what is published and from nothing else.
#pragma once
#include <filesystem>
#include <string>

namespace weir::validation {

/// The page of a folder with verdicts.json, cost/json/, stability/ and pictures/; what is missing is said to be missing. Throws BadInput
/// where there are no verdicts at all.
std::string page_html(const std::filesystem::path& results);

/// Writes results/index.html and returns its path.
std::filesystem::path write_page(const std::filesystem::path& results);

}  // namespace weir::validation
