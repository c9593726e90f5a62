// What a scene says of the stuff that it is made of: one part of the schema for every solver that knows temperature, and the substance made
// of it.
#pragma once
#include "scene/scene.hpp"
#include "thermo/substance.hpp"

#include <string>

namespace weir::matter {

/// The key "substance": "water", or a table with constants of one's own or of an equation of state.
scene::Key substance_key();

/// The substance of a scene whose solver has the key. Refuses constants that cannot be, at their place.
thermo::SubstancePtr substance_of(const scene::Scene& scene);

/// What a substance is, in numbers: its points, lines and constants.
std::string describe(const thermo::Substance& substance);

}  // namespace weir::matter
