// The audit of one effect of one solver, as the registry knows them: what it costs where a scene does not name it, and whether it is what
// it declares where a scene does.
#pragma once
#include "scene/solver_kind.hpp"

#include <string>
#include <vector>

namespace weir::test {

using Findings = std::vector<std::string>;

/// A step without effects has the fields and passes that the solver registers as its plain ones, and nothing beside.
Findings audit_plain(const scene::SolverKind& kind, int dim);
/// Named: its declared fields, passes and bytes, and no others; steps that allocate no more than before; no changed bit at strength zero,
/// and a warning. Not named, among all the other effects: nothing of it.
Findings audit_effect(const scene::SolverKind& kind, int dim, const std::string& effect);

}  // namespace weir::test
