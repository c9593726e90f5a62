#include "validation/report/published_case.hpp"

#include "validation/page/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <set>

namespace weir::validation {
namespace {

using nlohmann::json;

/// A claim as the page shows it: what is claimed, and its bound.
std::string claim_text(const std::string& variant, const std::string& metric, const std::string& test, const std::string& bound,
                       bool open) {
    return fmt::format("{}{}{} {} {}{}", variant, variant.empty() ? "" : ": ", metric, test, bound, open ? " (asked)" : "");
}

std::multiset<std::string> claims_of(const Case& full) {
    std::multiset<std::string> claims;
    for (const Variant& v : full.variants)
        for (const Criterion& c : v.accept) {
            const Verdict as_claimed{.criterion = std::string(name(c.test)), .low = c.low, .high = c.high};
            claims.insert(claim_text(v.name, c.metric, as_claimed.criterion, as_claimed.bound(), !c.not_reached.empty()));
        }
    return claims;
}

std::multiset<std::string> published_claims(const json& verdicts, const std::string& case_name) {
    std::multiset<std::string> claims;
    for (const json& v : verdicts)
        if (text_at(v, "case") == case_name)
            claims.insert(claim_text(text_at(v, "variant"), text_at(v, "metric"), text_at(v, "criterion"), text_at(v, "bound_text"),
                                     !text_at(v, "not_reached").empty()));
    return claims;
}

std::vector<std::string> moved_claims(const std::multiset<std::string>& now, const std::multiset<std::string>& published) {
    std::vector<std::string> added, gone, moved;
    std::set_difference(now.begin(), now.end(), published.begin(), published.end(), std::back_inserter(added));
    std::set_difference(published.begin(), published.end(), now.begin(), now.end(), std::back_inserter(gone));
    for (const std::string& claim : added) moved.push_back("the claim is not published: " + claim);
    for (const std::string& claim : gone) moved.push_back("the claim is published and no longer made: " + claim);
    return moved;
}

}  // namespace

Numbers numbers_of(const CaseResult& result) {
    Numbers numbers;
    for (const auto& v : result.variants)
        for (const RunResult& run : v.runs) {
            const std::string at = run.label.empty() ? "" : "at " + run.label;
            const std::string place = v.plan.name + (v.plan.name.empty() || at.empty() ? "" : " ") + at;
            for (const auto& [metric, x] : run.measured) numbers[place.empty() ? metric : place + ": " + metric] = x;
        }
    return numbers;
}

Comparison compare_with_published(const CaseResult& ci, const Case& full, const std::filesystem::path& published) {
    const std::string& case_name = ci.plan.name;
    Comparison c = compare_numbers(numbers_of(ci), json_of(pins_file(published, case_name)));
    if (const json verdicts = json_of(published / "verdicts.json"); verdicts.is_array() && c.seconds_to_publish > 0)
        for (std::string& claim : moved_claims(claims_of(full), published_claims(verdicts, case_name))) c.moved.push_back(std::move(claim));
    return c;
}

}  // namespace weir::validation
