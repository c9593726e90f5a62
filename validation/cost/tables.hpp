// A study as text: the table on the terminal and in CSV, JSON and Markdown, sentences made from its numbers, and the diagram.
#pragma once
#include "validation/cost/measure.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace weir::validation {

/// One line a point, from cheap to dear; failures stay, last.
std::string cost_table(const StudyResult& result);
/// method,setting,error,seconds_per_second,ms_per_step,real_time_factor,spread,others,repeats,steps,bytes,front,failure and the further
/// metrics.
std::string cost_csv(const StudyResult& result);
nlohmann::json cost_json(const StudyResult& result);
/// The page's part: question, figure, sentences, table.
std::string cost_markdown(const nlohmann::json& study);

/// Three sentences or fewer that say which setting to take: at the error that is good enough, within real time, and what more accuracy
/// costs, or that it is not to be had. Each is made from the points alone; prices are parts of a frame at 60 a second.
std::vector<std::string> advice(const StudyResult& result);

/// Error against the real-time factor (or milliseconds a step), one curve a method, and the front with its points named.
std::vector<Panel> cost_panels(const StudyResult& result);

}  // namespace weir::validation
