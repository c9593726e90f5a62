// weir live --bench: how many frames a second a window shows, each of a new step, and what a frame spends on what.
#pragma once
#include "app/live/window.hpp"

#include <string>
#include <vector>

namespace weir::live {

/// For `time` ("10s") each: the scene, or where none is named those of the report in this folder. Prints a table, or JSON of the scene.
int bench(const std::string& time, const std::string& scene, const std::vector<scene::Override>& set, const std::string& report_table,
          const WindowOptions& options, bool json);

}  // namespace weir::live
