// Every plot of the results: panels and maps, drawn by gnuplot as one SVG file.
#pragma once
#include "validation/harness/curve.hpp"
#include "validation/page/map.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace weir::validation {

/// The gnuplot program of a plot: data inside, panels two per row, below each its legend. No title: that of the only panel serves.
std::string gnuplot_program(const std::string& title, const std::vector<Panel>& panels);
/// That of a map: a cell per pair of values, below it a legend of the kinds of failure.
std::string gnuplot_program(const Map& map);

/// Runs a program; throws OutputError when gnuplot is missing, fails, or the file cannot be written.
void draw(const std::string& program, const std::filesystem::path& svg);

}  // namespace weir::validation
