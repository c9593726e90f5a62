// Which instruction set the pair passes use on threads: the best that this processor has, or the one that is asked for by name (or by the
// environment variable WEIR_ISA) so that tests and measurements compare them.
#pragma once
#include "particles/passes.hpp"

#include <string_view>
#include <vector>

namespace weir::particles {

/// The instruction sets that this processor can run, best first.
const std::vector<const PassTable*>& available_passes();
/// By name ("sse2", "avx2", "avx512"); "" or "auto": WEIR_ISA if set, else the best. Throws BadInput when it cannot run here.
const PassTable& passes_for(std::string_view name);

}  // namespace weir::particles
