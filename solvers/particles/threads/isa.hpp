// The instruction set of the pair passes on threads: the best one of this processor, or the one requested by name (or by the environment
// variable WEIR_ISA), for comparisons in tests and measurements.
#pragma once
#include "particles/threads/passes.hpp"

#include <string_view>
#include <vector>

namespace weir::particles {

/// The instruction sets that this processor can run, best first.
const std::vector<const PassTable*>& available_passes();
/// By name ("sse2", "avx2", "avx512"); "" or "auto": WEIR_ISA if set, otherwise the best. Throws BadInput when it does not run here.
const PassTable& passes_for(std::string_view name);

}  // namespace weir::particles
