// Limits as they are published, beside the code as it is now.
#include "core/error.hpp"
#include "validation/page/text.hpp"
#include "validation/stability/command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <optional>

namespace weir::validation {
namespace {

using nlohmann::json;

std::string place_of(const Stress& s) { return (s.method.empty() ? s.name : s.name + ", " + s.method) + ": "; }

/// Takes out the published numbers of an axis that is not compared.
void drop_numbers(json& pins, const std::string& place) {
    if (!pins.is_object() || !pins.contains("numbers")) return;
    json kept = json::object();
    for (const auto& [name, value] : pins["numbers"].items())
        if (!name.starts_with(place)) kept[name] = value;
    pins["numbers"] = std::move(kept);
}

constexpr auto stable_end = "last stable", unstable_end = "first unstable";

/// Either end of an axis as it was found, to the last digit: what breaks depends on it. Nothing where the axis is not published.
std::optional<Limit> at_published_ends(const Stress& s, const json& study, const Solvers& solvers) {
    if (const auto limits = study.find("limits"); limits != study.end() && limits->is_array())
        for (const json& l : *limits)
            if (text_at(l, "axis") == s.name && text_at(l, "method") == s.method)
                return recheck(s, number_at(l, "last_stable"), number_at(l, "first_unstable"), solvers);
    return std::nullopt;
}

}  // namespace

Numbers numbers_of(const std::vector<Limit>& limits) {
    Numbers numbers;
    for (const Limit& l : limits) {
        const std::string place = place_of(l.stress);
        if (l.last_stable) numbers[place + stable_end] = *l.last_stable;
        for (const MeasuredValue& h : l.preconditions) numbers[place + h.quantity] = h.value;
        if (!l.first_unstable) continue;
        numbers[place + unstable_end] = *l.first_unstable;
        numbers[place + "step that breaks"] = static_cast<real>(l.broke.step);
        numbers[place + "time that breaks"] = l.broke.time;
    }
    return numbers;
}

int compare_limits(const std::vector<StressStudy>& studies, Size size, const std::filesystem::path& published, const Solvers& solvers) {
    bool sound = true;
    for (const StressStudy& study : studies) {
        json pins = json_of(pins_file(published, study.name));
        const json study_as_published = json_of(published / (study.name + ".json"));
        const bool comparable = pins.is_object() && study_as_published.is_object() && rounds_otherwise(pins).empty();
        std::vector<Limit> shown, compared;
        std::vector<std::string> unpublished;
        for (const Stress& s : study.stresses) {
            const bool range_only = s.slow && size == Size::ci;
            if (range_only) drop_numbers(pins, place_of(s));
            const auto there = comparable && !range_only ? at_published_ends(s, study_as_published, solvers) : std::nullopt;
            if (comparable && !range_only && !there) unpublished.push_back(place_of(s) + "its limit is not published");
            if (there)
                shown.push_back(*there), sound = sound && there->guarded();
            else if (s.guaranteed)
                shown.push_back(check_guaranteed(s, solvers)), sound = sound && shown.back().passes();
            else
                continue;
            if (!range_only) compared.push_back(shown.back());
        }
        fmt::print("{}\n", limits_table(study, shown));
        std::fflush(stdout);
        Comparison c = compare_numbers(numbers_of(compared), pins);
        c.moved.insert(c.moved.begin(), unpublished.begin(), unpublished.end());
        const std::string command = fmt::format("weir stability {} --size full --publish", study.name);
        std::fputs(comparison_text(study.name + ", limits", command, c).c_str(), stderr);
        sound = sound && c.moved.empty();
    }
    return sound ? exit_success : exit_claim_failed;
}

}  // namespace weir::validation
