#include "validation/report/study_plots.hpp"

#include "validation/page/sections.hpp"
#include "validation/page/text.hpp"
#include "validation/report/svg.hpp"

namespace weir::validation {

void draw_cost(const nlohmann::json& study, const std::filesystem::path& svg) { draw(gnuplot_program("", {cost_panel(study)}), svg); }

void draw_maps(const nlohmann::json& study, const std::filesystem::path& folder) {
    if (!study.contains("maps")) return;
    for (const auto& map : study["maps"]) draw(gnuplot_program(drawing_of_map(map)), folder / map_file(study, map));
}

void draw_published_studies(const std::filesystem::path& results) {
    for (const auto& study : studies_in(results / "cost" / "json", "points"))
        draw_cost(study, results / "cost" / "svg" / (text_at(study, "study") + ".svg"));
    for (const auto& study : studies_in(results / "stability", "limits")) draw_maps(study, results / "stability" / "svg");
}

}  // namespace weir::validation
