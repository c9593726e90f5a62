// What solvers show: the fields and integrals of small scenes that are really built, with what it takes for each to be there.
#pragma once
#include <string>

namespace weir::app {

/// One line each, for a terminal; or docs/fields.md.
std::string shown_text();
std::string shown_markdown();

}  // namespace weir::app
