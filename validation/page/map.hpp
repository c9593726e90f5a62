// A map of two axes of a stability study: what happened at each pair of values.
#pragma once
#include <string>
#include <vector>

namespace weir::validation {

struct MapCell {
    bool stable = true;
    int kind = 0;        // of the failure: equal kinds have one colour
    std::string text{};  // inside the cell
};

struct Map {
    std::string title{};
    std::string x_label{}, y_label{};
    std::vector<std::string> x{}, y{};          // y from the bottom to the top
    std::vector<std::vector<MapCell>> cells{};  // [x][y]
    std::vector<std::string> kinds{};           // what each kind of failure is
};

}  // namespace weir::validation
