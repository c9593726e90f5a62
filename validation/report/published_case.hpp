// A case as it is published, beside the case as it is now.
#pragma once
#include "validation/harness/verdict.hpp"
#include "validation/report/pins.hpp"

#include <filesystem>
#include <string>

namespace weir::validation {

/// Every number that the runs of a case measured.
Numbers numbers_of(const CaseResult& result);

/// The numbers of a run at ci size, and the claims of `full` (the case at full size) with their bounds, against what is published.
Comparison compare_with_published(const CaseResult& ci, const Case& full, const std::filesystem::path& published);

}  // namespace weir::validation
