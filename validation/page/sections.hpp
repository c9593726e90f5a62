// The parts of the page, each from published JSON. A section brings its own heading; a summary is the sentence that stands at the top.
#pragma once
#include "validation/harness/curve.hpp"
#include "validation/page/map.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace weir::validation {

struct Section {
    std::string summary{};  // HTML of its card
    std::string html{};
};

/// Every JSON object in a folder that has this list, by the files' names.
std::vector<nlohmann::json> studies_in(const std::filesystem::path& folder, const char* list);
/// Cases with their claims: verdict, measured, bound, how much of the bound is used, why, blind spot, figure.
Section claims_section(const nlohmann::json& verdicts, const std::filesystem::path& results);
/// Studies of error against time: plot, sentences, table.
Section cost_section(const std::vector<nlohmann::json>& studies, const std::filesystem::path& results);
/// The plot of one study, to be drawn.
Panel cost_panel(const nlohmann::json& study);
/// Limits of all solvers in one table, and two-axis maps.
Section limits_section(const std::vector<nlohmann::json>& studies, const std::filesystem::path& results);
/// One of their maps, to be drawn.
Map drawing_of_map(const nlohmann::json& map);
/// The name of its file: "study-dt-against-iterations-flip.svg".
std::string map_file(const nlohmann::json& study, const nlohmann::json& map);
/// The pictures themselves, inside the page.
Section pictures_section(const std::filesystem::path& results);

/// How many axes there are of each kind, and how they came out.
struct Counts {
    std::size_t limits = 0, unbroken = 0, units = 0, guards = 0, open_targets = 0, below = 0, doubted = 0;
    void add(const nlohmann::json& limit);
    /// "Every guaranteed range passes."
    std::string verdict() const;
};

/// How much of its bound a claim uses: 1 is all of it; absent where the bound is zero.
std::optional<double> used_part(const nlohmann::json& verdict);

}  // namespace weir::validation
