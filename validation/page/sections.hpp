// The parts of the page, each from published JSON. A section brings its own heading; a summary is the sentence that stands at the top.
#pragma once
#include "validation/page/chart.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace weir::validation {

struct Section {
    std::string summary{};  // HTML of its card
    std::string html{};
};

/// Cases with their claims: verdict, measured, bound, how much of the bound is used, why, blind spot, figure.
Section claims_section(const nlohmann::json& verdicts, const std::filesystem::path& results);
/// Studies of error against time: figure, sentences, table.
Section cost_section(const std::vector<nlohmann::json>& studies, const std::filesystem::path& results);
/// The figure of one study, as a file.
std::string cost_figure(const nlohmann::json& study);
/// Limits of all solvers in one table, and two-axis maps.
Section limits_section(const std::vector<nlohmann::json>& studies);
/// One of their maps, to be drawn.
Map drawing_of_map(const nlohmann::json& map);
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
