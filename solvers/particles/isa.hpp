// Which machinery a particle solver runs on ("scheme.backend"), and on threads which instruction set the pair passes use: the best that
// this processor has, or the one that is asked for by name (or by the environment variable WEIR_ISA) so that tests and measurements compare
// them.
#pragma once
#include "backend/device.hpp"
#include "particles/passes.hpp"
#include "scene/scene.hpp"

#include <string_view>
#include <vector>

namespace weir::particles {

/// The instruction sets that this processor can run, best first.
const std::vector<const PassTable*>& available_passes();
/// By name ("sse2", "avx2", "avx512"); "" or "auto": WEIR_ISA if set, else the best. Throws BadInput when it cannot run here.
const PassTable& passes_for(std::string_view name);

/// The key "backend" of a particle solver's "scheme", and what a scene chose by it. Throws BadScene where it is none of those known.
scene::Key backend_key();
backend::Choice backend_of(const scene::Scene& scene);

}  // namespace weir::particles
