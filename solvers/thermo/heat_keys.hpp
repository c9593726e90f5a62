// The keys of heat common to all solvers that have it: the pressure, heaters, walls with a heat flux.
#pragma once
#include "scene/scene.hpp"
#include "thermo/substance.hpp"

#include <string>
#include <vector>

namespace weir::thermo {

/// The optional key "substance" of a solver with heat; `doc` is appended to its description.
scene::Key substance_key_of_heat(const std::string& doc);
/// "heat.pressure"
scene::Key pressure_key();
/// "heaters": regions with a power; `doc`: over what it is distributed.
scene::Key heaters_key(const std::string& doc);
/// The keys of heat of a solver on a grid: "substance", "heat" with the pressure, the surroundings, the drag of ice and keys of its `own`,
/// and "heaters". `lets`: the effect of naming a substance; `over`: what a heater's power is distributed over.
std::vector<scene::Key> keys_on_a_grid(const std::string& lets, std::vector<scene::Key> own, const std::string& over);
/// The keys of a side of kind "wall" besides its temperature.
scene::Variant wall_with_exchange();

/// Enthalpy and temperature at the scene's heat.pressure; throws BadScene where the substance is not known at that pressure.
HeatCurve curve_of(const scene::Scene& scene, const Substance& substance);
/// At another pressure, given by the key `path` of the scene.
HeatCurve curve_at(real pressure, const std::string& path, const scene::Scene& scene, const Substance& substance);
/// Rejects a temperature of 0 K and below, at its key.
void check_temperature(const scene::Scene& scene, const std::string& path, real T);
/// Rejects a heater, scene.heaters[i], that ends before it starts.
void check_heater(const scene::Scene& scene, std::size_t i);

}  // namespace weir::thermo
