// Plots of published studies, drawn again from their published values.
#pragma once
#include <nlohmann/json.hpp>

#include <filesystem>

namespace weir::validation {

/// The plot of a study of cost.
void draw_cost(const nlohmann::json& study, const std::filesystem::path& svg);
/// The maps of a study of stability, in this folder.
void draw_maps(const nlohmann::json& study, const std::filesystem::path& folder);
/// All plots of results/cost/json and results/stability. Those of cases are drawn by `weir validate`.
void draw_published_studies(const std::filesystem::path& results);

}  // namespace weir::validation
