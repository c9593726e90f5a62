// The kinds of probes: points, lines, vertical water gauges, wall pressure, integrals, front.
#pragma once
#include "scene/scene.hpp"
#include "sim/probes.hpp"

#include <memory>

namespace weir::sim {

/// The probe described by entry `number` of the scene's "probes". Throws BadScene where the solver does not support it.
std::unique_ptr<ProbeKind> make_probe(const scene::Scene& scene, std::size_t number, const Solver& solver);

}  // namespace weir::sim
