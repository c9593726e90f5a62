// The scenes of all cases, each on few cells: what a metamorphic property runs.
#pragma once
#include "scene/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace weir::metamorphic {

/// The steps that are compared.
inline constexpr int steps = 10;

struct NamedScene {
    std::string name;  // "dam_break_2d", "standing_wave/flip"
    scene::Scene scene;
};

/// One for each solver and transfer that a case runs, at its ci size, without probes and frames.
std::vector<NamedScene> small_scenes(const std::filesystem::path& cases);

}  // namespace weir::metamorphic
