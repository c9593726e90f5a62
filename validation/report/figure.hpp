// The figure of a case, composed from what its runs left.
#pragma once
#include "validation/harness/verdict.hpp"

#include <vector>

namespace weir::validation {

/// Error against mesh width (with the slopes that the case claims), accuracy against work, the metrics' own profiles, histories; and
/// where none of these exists, the claims against their bounds. Never empty.
std::vector<Panel> panels_of(const CaseResult& result);

}  // namespace weir::validation
