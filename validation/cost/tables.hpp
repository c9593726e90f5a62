// A study as text: the table on the terminal and in CSV, JSON and Markdown, and sentences made from its numbers.
#pragma once
#include "validation/cost/measure.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace weir::validation {

/// One line per point, from cheap to expensive; failures come last.
std::string cost_table(const StudyResult& result);
/// method,setting,error,seconds_per_second,ms_per_step,real_time_factor,spread,others,repeats,steps,bytes,front,threads,device,failure and
/// the further metrics.
std::string cost_csv(const StudyResult& result);
nlohmann::json cost_json(const StudyResult& result);
/// The page's part: question, figure, sentences, table.
std::string cost_markdown(const nlohmann::json& study);

/// Three sentences or fewer that say which setting to take: at the error that is good enough, within real time, and what more accuracy
/// costs, or that it is not to be had; then what the reference cannot tell, and what failed. Each is made from the points alone; prices
/// are parts of a frame at 60 a second.
std::vector<std::string> advice(const StudyResult& result);

/// Below the table: which device was meant by OpenCL, which methods had threads of their own, what the error is measured against.
std::vector<std::string> notes(const StudyResult& result);

}  // namespace weir::validation
