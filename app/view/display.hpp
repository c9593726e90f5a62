// Whether there is a display to draw on.
#pragma once
#include <string>

namespace weir::view {

/// Throws BadInput that says what is missing and how to draw without a screen; VTK would abort.
void need_display(const std::string& program = "weir view");

}  // namespace weir::view
