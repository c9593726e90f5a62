// Sentences about a plan that the terminal and the page share. They are plain text.
#pragma once
#include "validation/uncertainty/scene_plan.hpp"

#include <string>
#include <vector>

namespace weir::validation::plan_words {

inline constexpr double busy = 0.25;  // cores of other programs that are mentioned

/// Milliseconds with two digits, or all before the point: "4.2", "120".
std::string in_milliseconds(double seconds);
/// "4.2 ms".
std::string milliseconds(double seconds);
/// "to 5% of its range (94.86 mm: 4.7 mm)", "as accurately as possible".
std::string wish_text(const ScenePlan& plan, std::size_t q);
/// "for 4 ms of computing per frame of 17 ms, on one thread"; empty without a budget.
std::string budget_text(const ScenePlan& plan);
/// "3 grids, 15 x 9 to 30 x 18 cells, 2.1 s of computing", with the estimate.
std::string price_text(const MethodStudy& study);
/// "346.8 mm", or of several samples their root mean square; "-" where it is not known.
std::string value_text(const Value& value, real width);
/// Why a quantity is not known on a grid; of the finest grid how the grids converge; else empty.
std::string grid_note(const QuantityStudy& quantity, const MethodStudy& study, std::size_t g);
/// "not told apart from mac_water: ...", "other equations: ..."; empty where the method was not compared.
std::string comparison_text(const PlannedMethod& planned, const ScenePlan& plan);
/// "1.8 mm of the grids, 0.2 mm of the time step, 0.1 mm of the markers' seeds"; empty where only the grids count.
std::string band_parts(const QuantityStudy& quantity);
/// Of a plan without a recommendation: what is known at which cost, and the grid that would be needed.
std::vector<std::string> nearest(const ScenePlan& plan);
/// "other programs used 1.2 cores meanwhile: ..."; empty on a quiet machine.
std::string others_text(const ScenePlan& plan);

}  // namespace weir::validation::plan_words
