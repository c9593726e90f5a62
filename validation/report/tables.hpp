// Results as text: the table on the terminal, the orders, the CSV and JSON files.
#pragma once
#include "validation/harness/verdict.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace weir::validation {

/// One line a claim: pass or FAIL, measured, bound, seconds, why; the notes of those that failed.
std::string claims_table(const CaseResult& result);
/// Lines that say which runs came to no end, and why, where no claim that rests on them does; empty where there are none.
std::string unreported_failures(const CaseResult& result);
/// Orders, Richardson's value and GCI of every metric that was swept over grids; empty where none was.
std::string orders_table(const CaseResult& result);
/// variant,value,h,metric,measured,order,limit,gci,asymptotic,seconds: one line a run and metric.
std::string csv(const CaseResult& result);
/// Objects with case, variant, criterion, metric, measured, bound, pass, seconds, why, ... (a measured NaN is null).
nlohmann::json verdicts_json(const CaseResult& result);

}  // namespace weir::validation
