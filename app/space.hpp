// What a run will write, told before it begins and held against the room on the disk.
#pragma once
#include "sim/simulation.hpp"

#include <filesystem>
#include <string>

namespace weir::app {

/// One line: frames, their size, and the room in `folder` or where it will be made. Throws BadInput with both numbers where the frames
/// that are still to come may not fit, unless `any_size`: compressed ones are smaller by an unknown amount.
std::string check_space(const Simulation& simulation, const std::filesystem::path& folder, bool any_size);

}  // namespace weir::app
