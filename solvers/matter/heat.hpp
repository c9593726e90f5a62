// What scenes say of heat in the same words to every solver that carries it: the pressure, heaters, walls through which heat comes.
#pragma once
#include "scene/scene.hpp"
#include "thermo/substance.hpp"

#include <string>
#include <vector>

namespace weir::matter {

/// The key "substance" of a solver that carries heat where it is named, and only there; `doc` is added to its own.
scene::Key substance_key_of_heat(const std::string& doc);
/// "heat.pressure"
scene::Key pressure_key();
/// "heaters": regions with a power; `doc` says over what it is spread.
scene::Key heaters_key(const std::string& doc);
/// What a solver on a grid says of heat: "substance", "heat" with the pressure, the surroundings, the drag of ice and keys of its `own`,
/// and "heaters". `lets`: what naming a substance lets it do; `over`: what a heater's power is spread over.
std::vector<scene::Key> keys_on_a_grid(const std::string& lets, std::vector<scene::Key> own, const std::string& over);
/// What a side of kind "wall" says beside its temperature.
scene::Variant wall_with_exchange();

/// Enthalpy against temperature at the scene's heat.pressure, at which it is refused where the substance is not known there.
thermo::HeatCurve curve_of(const scene::Scene& scene, const thermo::Substance& substance);
/// At another pressure, which `path` of the scene says.
thermo::HeatCurve curve_at(real pressure, const std::string& path, const scene::Scene& scene, const thermo::Substance& substance);
/// Refuses a temperature of 0 K and below, at its place.
void check_temperature(const scene::Scene& scene, const std::string& path, real T);
/// Refuses a heater, scene.heaters[i], that ends before it starts.
void check_heater(const scene::Scene& scene, std::size_t i);

}  // namespace weir::matter
