#include "validation/page/readme.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "validation/page/sections.hpp"
#include "validation/page/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <set>

namespace weir::validation {
namespace {

using nlohmann::json;

std::string side_by_side(const std::filesystem::path& results, const std::string& prefix) {
    const json study = json_of(results / "cost" / "json" / "dam_break_martin_moyce.json");
    if (!study.is_object()) return "";
    std::string s = fmt::format(
        "### {}\n![Error of front and height against the real-time factor, for every water "
        "method]({}/cost/svg/dam_break_martin_moyce.svg)\n\n",
        text_at(study, "question"), prefix);
    for (const json& sentence : study["advice"]) s += "- " + sentence.get<std::string>() + "\n";
    return s + fmt::format("\n{}, {} thread(s), {} size; all configurations and the other studies: [{}/cost]({}/cost/index.md).\n\n",
                           text_at(study, "machine"), study.value("threads", 1), text_at(study, "size"), prefix, prefix);
}

struct Question {
    const char* title;
    std::set<std::string> kinds;
};

std::string claims_table(const json& verdicts, const std::string& prefix) {
    const Question parts[] = {{"Are the equations solved correctly?", {"exact", "convergence"}},
                              {"Are they the right equations?", {"benchmark"}},
                              {"How much solver work does accuracy cost?", {"iterations"}}};
    std::string s = "### Claims\n| question | claims that pass | cases |\n|---|---|---|\n";
    for (const Question& part : parts) {
        std::size_t held = 0, all = 0;
        std::set<std::string> cases;
        for (const json& v : verdicts) {
            if (!part.kinds.count(text_at(v, "kind"))) continue;
            held += v.value("pass", false) ? 1 : 0, ++all;
            cases.insert(text_at(v, "case"));
        }
        s += fmt::format("| {} | {} of {} | [{}]({}/index.md) |\n", part.title, held, all, cases.size(), prefix);
    }
    return s;
}

std::string limits_line(const std::filesystem::path& results, const std::string& prefix) {
    Counts counts;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(results / "stability", missing)) {
        const json study = json_of(entry.path());
        if (!study.is_object() || !study.contains("limits")) continue;
        for (const json& l : study["limits"]) counts.add(l);
    }
    if (counts.limits + counts.units + counts.guards == 0) return "";
    return fmt::format(
        "\n**Stability limits:** {} limits measured, {} of them without a failure in the tested range; {} checks of units, {} of guards. "
        "{} [{}/stability]({}/stability/index.md).\n",
        counts.limits, counts.unbroken, counts.units, counts.guards, counts.verdict(), prefix, prefix);
}

}  // namespace

std::string readme_part(const std::filesystem::path& results, const std::string& prefix) {
    const json verdicts = json_of(results / "verdicts.json");
    if (!verdicts.is_array()) throw BadInput(results.string() + " has no readable verdicts.json");
    const std::size_t open = open_targets(verdicts).size();
    const std::string not_reached =
        open == 0 ? "" : fmt::format("\n{} open targets are not met: [the table]({}/index.md#open-targets).\n", open, prefix);
    return side_by_side(results, prefix) + claims_table(claimed(verdicts), prefix) + not_reached + limits_line(results, prefix) +
           fmt::format("\nAll results on one page for a browser: `{}/index.html`.\n", prefix);
}

void update_readme(const std::filesystem::path& readme, const std::filesystem::path& results) {
    const std::string text = bytes_of(readme);
    const auto begin = text.find(readme_begins), end = text.find(readme_ends);
    if (begin == std::string::npos || end == std::string::npos || end < begin)
        throw BadInput(fmt::format("{} has no \"{}\" followed by \"{}\"", readme.string(), readme_begins, readme_ends));
    const std::string prefix = std::filesystem::relative(results, std::filesystem::absolute(readme).parent_path()).generic_string();
    output::write_file(readme, text.substr(0, begin) + readme_begins + "\n" + readme_part(results, prefix) + text.substr(end));
}

}  // namespace weir::validation
