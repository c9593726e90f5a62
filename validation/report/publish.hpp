// results/: the page of claims, its figures and tables, written by the program only.
#pragma once
#include "output/folder_lock.hpp"
#include "validation/harness/verdict.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace weir::validation {

/// The page made of all verdicts (with the machine and commit that each was measured on).
std::string index_markdown(const nlohmann::json& verdicts);

/// Writes folder/index.md from folder/verdicts.json.
void write_index(const std::filesystem::path& folder);

/// The lock of a folder of published results, which waits for another publication; none where `out` is that folder, whose lock its run has.
std::unique_ptr<output::FolderLock> lock_published(const std::filesystem::path& folder, const std::filesystem::path& out);

/// Copies the figures and tables of `results` from `out` to `folder`, replaces their entries in folder/verdicts.json (others stay), writes
/// their `pins` (of pins_json, in the same order) and folder/index.md anew.
void publish(const std::vector<CaseResult>& results, const std::vector<nlohmann::json>& pins, const std::filesystem::path& out,
             const std::filesystem::path& folder);

}  // namespace weir::validation
