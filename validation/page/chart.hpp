// Diagrams as SVG text that takes its colours from the page around it (light or dark), or carries its own where it stands alone.
#pragma once
#include "validation/harness/curve.hpp"

#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// A line across a diagram at one abscissa: "real time".
struct Mark {
    real at = 0;
    std::string label{};
};

/// Points joined by lines, one colour a curve, dashed lines for guides; names are written beside their points where there is room, and
/// shown on pointing at them everywhere.
std::string chart_svg(const Panel& panel, const std::vector<Mark>& marks = {});
/// The curves' colours and names, for below the diagram.
std::string chart_legend(const Panel& panel);

/// What happened at one place of a two-axis map.
struct MapCell {
    bool stable = true;
    int kind = 0;          // of the break: equal kinds share a colour
    std::string text{};    // inside the cell
    std::string detail{};  // on pointing at it
};
struct Map {
    std::string title{};
    std::string x_label{}, y_label{};
    std::vector<std::string> x{}, y{};          // y from the bottom to the top
    std::vector<std::vector<MapCell>> cells{};  // [x][y]
    std::vector<std::string> kinds{};           // what each kind of break is
};
std::string map_svg(const Map& map);

/// The same with paper and colours of its own, to be a file.
std::string standalone(const std::string& svg);
/// A diagram as such a file: its title above, its legend below.
std::string chart_file(const Panel& panel, const std::vector<Mark>& marks = {});

}  // namespace weir::validation
