// Fields and integrals that solvers write, from small scenes that are really built, with what a scene must name for each.
#pragma once
#include <string>

namespace weir::app {

/// One line each, for a terminal; or docs/fields.md.
std::string output_fields_text();
std::string output_fields_markdown();

}  // namespace weir::app
