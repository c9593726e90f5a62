// Published figures of an earlier report beside what the same problems cost here. Read from cases/report_table/table.toml.
#pragma once
#include "validation/cost/study.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace weir::validation {

/// One figure: frames a second of whole steps, or milliseconds of some passes of a step.
struct ReportRow {
    std::string what{};
    std::string theirs{};               // as the report says it
    real value = 0;                     // the number in it
    std::string on{};                   // "CPU", "GPU"
    std::vector<std::string> passes{};  // empty: the whole step
    Variant variant{};
    std::string unit() const { return passes.empty() ? "frames/s" : "ms"; }
};

struct ReportTable {
    std::string question{};
    std::string their_machine{};
    std::string reading{};  // how the two are made comparable
    std::vector<ReportRow> rows{};
};

const std::vector<scene::Key>& report_table_keys();
ReportTable read_report_table(const std::filesystem::path& folder);
ReportTable parse_report_table(std::string_view text, const std::string& file, const std::filesystem::path& folder);

/// Frames a second of a scene in a window, each of a new step; NaN where there is no window.
using Drawn = std::function<double(const std::filesystem::path& scene, const std::vector<scene::Override>& set)>;

/// Runs each scene for some batches of steps and takes the median batch. Rows of whole steps are drawn too, where `drawn` is given. Throws
/// BadInput where a row names a pass that there is not.
nlohmann::json measure_report_table(const ReportTable& table, const Solvers& solvers, const Drawn& drawn = {});

std::string report_table_text(const nlohmann::json& table);
std::string report_table_markdown(const nlohmann::json& table);

}  // namespace weir::validation
