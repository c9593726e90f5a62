// Panels drawn by gnuplot as one SVG file.
#pragma once
#include "validation/harness/curve.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace weir::validation {

/// The gnuplot program of a figure: data inside, panels two a row.
std::string gnuplot_program(const std::string& title, const std::vector<Panel>& panels);

/// Draws; throws OutputError when gnuplot is missing, fails, or the file cannot be written.
void draw(const std::string& title, const std::vector<Panel>& panels, const std::filesystem::path& svg);

}  // namespace weir::validation
