// The substance of a scene: a common part of the schema for every solver with temperature, and the construction of the substance.
#pragma once
#include "scene/scene.hpp"
#include "thermo/substance.hpp"

#include <string>

namespace weir::thermo {

/// The key "substance": "water", or a table with constants or the parameters of an equation of state.
scene::Key substance_key();

/// The substance of a scene whose solver has the key. Rejects invalid constants, at their key.
SubstancePtr substance_of(const scene::Scene& scene);

/// The properties of a substance: its points, phase boundaries and constants.
std::string describe(const Substance& substance);

}  // namespace weir::thermo
