#include "validation/cost/tables.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace weir::validation {
namespace {

using nlohmann::json;

constexpr double busy = 0.2;  // cores of others beyond which a time is marked

std::vector<const CostPoint*> by_price(const StudyResult& result) {
    std::vector<const CostPoint*> list;
    for (const CostPoint& p : result.points) list.push_back(&p);
    std::stable_sort(list.begin(), list.end(), [&](const CostPoint* a, const CostPoint* b) {
        if (a->failure.has_value() != b->failure.has_value()) return b->failure.has_value();
        return a->price(result.study.price) < b->price(result.study.price);
    });
    return list;
}

std::string quoted(std::string s) {
    std::replace(s.begin(), s.end(), '\n', ' ');
    std::replace(s.begin(), s.end(), '"', '\'');
    return s.find(',') == std::string::npos ? s : "\"" + s + "\"";
}

std::string megabytes(std::size_t bytes) { return fmt::format("{:.3g}", static_cast<double>(bytes) / 1e6); }

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// "a, b": the methods of the points that hold `f`, each once.
template <class F>
std::string methods_where(const StudyResult& result, F&& f) {
    std::vector<std::string> names;
    for (const CostPoint& p : result.points)
        if (f(p) && std::find(names.begin(), names.end(), p.method) == names.end()) names.push_back(p.method);
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<std::string> notes(const StudyResult& result) {
    std::vector<std::string> list;
    std::set<std::string> devices;
    std::set<int> threads;
    const auto one_number = [&](const CostPoint& of) {  // of threads, for all settings of the method
        return std::all_of(result.points.begin(), result.points.end(),
                           [&](const CostPoint& p) { return p.method != of.method || !p.was_run() || p.threads == of.threads; });
    };
    const auto on_processor = [](const CostPoint& p) { return p.device.empty() && p.was_run(); };
    for (const CostPoint& p : result.points) {
        if (!p.device.empty() && devices.insert(p.device).second)
            list.push_back(fmt::format("{}: {}{}.", methods_where(result, [&](const CostPoint& q) { return q.device == p.device; }),
                                       p.device, p.device_kind == "GPU" ? "" : "; this is no GPU"));
        if (on_processor(p) && p.threads != result.threads && one_number(p) && threads.insert(p.threads).second)
            list.push_back(fmt::format(
                "{}: {} thread{}.",
                methods_where(result, [&](const CostPoint& q) { return on_processor(q) && q.threads == p.threads && one_number(q); }),
                p.threads, p.threads == 1 ? "" : "s"));
    }
    if (const auto mixed = methods_where(result, [&](const CostPoint& q) { return on_processor(q) && !one_number(q); }); !mixed.empty())
        list.push_back(fmt::format("{}: configurations with little work use fewer threads (column threads).", mixed));
    list.push_back(result.source.empty() ? "No reference: the error is computed from each run itself."
                                         : fmt::format("Compared with: {}.", result.source));
    return list;
}

std::string cost_table(const StudyResult& result) {
    std::size_t width = 12;
    for (const CostPoint& p : result.points) width = std::max(width, p.name().size());
    std::string s = fmt::format("{} ({}, {} thread{}): {}\n", result.study.name, name(result.study.size), result.threads,
                                result.threads == 1 ? "" : "s", result.study.question);
    s += fmt::format("    {:{}}  {:>11} {:>12} {:>10} {:>9} {:>7} {:>8}\n", "setting", width, result.study.error.substr(0, 11),
                     "s per sim. s", "ms/step", "MB", "steps", "spread");
    for (const CostPoint* p : by_price(result)) {
        s += fmt::format("  {} {:{}}  ", p->on_front ? "*" : " ", p->name(), width);
        s += p->failure
                 ? first_line(*p->failure) + "\n"
                 : fmt::format("{:>11.4g} {:>12.4g} {:>10.4g} {:>9} {:>7} {:>8}{}\n", p->error, p->seconds_per_second, p->ms_per_step,
                               megabytes(p->bytes), p->steps, p->repeats > 1 ? fmt::format("{:.0f}%", 100 * p->spread) : "-",
                               p->others > busy ? fmt::format("  others used {:.1f} cores", p->others) : "");
    }
    s += "    * on the Pareto front: no other configuration is both cheaper and more accurate\n";
    for (const std::string& sentence : advice(result)) s += "  " + sentence + "\n";
    for (const std::string& note : notes(result)) s += "  (" + note + ")\n";
    return s;
}

std::string cost_csv(const StudyResult& result) {
    std::string s =
        fmt::format("# {} at {} size, error: {}. {}\n", result.study.name, name(result.study.size), result.study.error, result.source);
    s += "method,setting,error,seconds_per_second,ms_per_step,real_time_factor,spread,others,repeats,steps,bytes,front,threads,device,"
         "failure";
    for (const std::string& metric : result.study.also) s += "," + metric;
    s += "\n";
    for (const CostPoint* p : by_price(result)) {
        s += p->failure
                 ? fmt::format("{},{},,,,,,{:.2f},{},{},{},no,{},{},{}", p->method, p->setting, p->others, p->repeats, p->steps, p->bytes,
                               p->threads, quoted(p->device), quoted(*p->failure))
                 : fmt::format("{},{},{:.9g},{:.6g},{:.6g},{:.6g},{:.3f},{:.2f},{},{},{},{},{},{},", p->method, p->setting, p->error,
                               p->seconds_per_second, p->ms_per_step, p->seconds_per_second > 0 ? 1 / p->seconds_per_second : 0, p->spread,
                               p->others, p->repeats, p->steps, p->bytes, p->on_front ? "yes" : "no", p->threads, quoted(p->device));
        for (const std::string& metric : result.study.also) {
            const auto at = p->also.find(metric);
            s += at == p->also.end() ? std::string(",") : fmt::format(",{:.9g}", at->second);
        }
        s += "\n";
    }
    return s;
}

json cost_json(const StudyResult& result) {
    const Study& study = result.study;
    json points = json::array();
    for (const CostPoint* p : by_price(result)) {
        json entry = {{"method", p->method},
                      {"setting", p->setting},
                      {"name", p->name()},
                      {"steps", p->steps},
                      {"bytes", p->bytes},
                      {"others", p->others},
                      {"spread", p->spread},
                      {"repeats", p->repeats},
                      {"front", p->on_front},
                      {"label", p->label()},
                      {"order", p - result.points.data()},
                      {"threads", p->threads},
                      {"device", p->device}};
        if (p->failure) {
            entry["failure"] = *p->failure;
        } else {
            entry["error"] = p->error, entry["seconds_per_second"] = p->seconds_per_second, entry["ms_per_step"] = p->ms_per_step;
            entry["also"] = p->also;
        }
        points.push_back(entry);
    }
    return {{"study", study.name},
            {"size", name(study.size)},
            {"question", study.question},
            {"error", study.error},
            {"unit", result.unit},
            {"also", study.also},
            {"good_enough", study.good_enough},
            {"why", study.why},
            {"known_to", study.known_to},
            {"known_why", study.known_why},
            {"price", study.price == Price::second ? "second" : "step"},
            {"source", result.source},
            {"threads", result.threads},
            {"advice", advice(result)},
            {"notes", notes(result)},
            {"points", points}};
}

namespace {

std::string markdown_row(const json& p, const std::vector<std::string>& also) {
    const std::string name = p["name"], memory = megabytes(p["bytes"].get<std::size_t>());
    const auto steps = p["steps"].get<std::int64_t>();
    std::string further;
    for (const std::string& metric : also) {
        const auto value = p.contains("also") ? p["also"].find(metric) : p.end();
        const bool known = p.contains("also") && value != p["also"].end() && value->is_number();
        further += known ? fmt::format("{:.4g} | ", value->get<double>()) : "| ";
    }
    if (p.contains("failure"))
        return fmt::format("| {} | {} | | | {} | {} | {}|\n", name, first_line(p["failure"].get<std::string>()), memory, steps, further);
    const double others = p["others"];
    return fmt::format("| {} | {:.4g} | {:.4g} | {:.4g} | {} | {} | {}{}{} |\n", name, p["error"].get<double>(),
                       p["seconds_per_second"].get<double>(), p["ms_per_step"].get<double>(), memory, steps, further,
                       p["front"].get<bool>() ? "front" : "",
                       others > busy ? fmt::format(" ({:.1f} cores busy with other work)", others) : "");
}

}  // namespace

std::string cost_markdown(const json& study) {
    const std::string name = study["study"];
    std::string s = fmt::format("## {}\n\n{}\n\n![{} against time](svg/{}.svg)\n\n", name, study["question"].get<std::string>(),
                                study["error"].get<std::string>(), name);
    for (const auto& sentence : study["advice"]) s += "- " + sentence.get<std::string>() + "\n";
    const auto also = study.value("also", std::vector<std::string>{});
    std::string further, rule;
    for (const std::string& metric : also) further += metric + " | ", rule += "---|";
    s += fmt::format("\n| configuration | {} | s per simulated s | ms per step | MB | steps | {}|\n|---|---|---|---|---|---|{}---|\n",
                     study["error"].get<std::string>(), further, rule);
    for (const auto& p : study["points"]) s += markdown_row(p, also);
    s += "\n";
    for (const auto& note : study.value("notes", json::array())) s += note.get<std::string>() + " ";
    s += fmt::format("All values: [csv/{}.csv](csv/{}.csv). {} thread(s), {} size, commit {}, on {}.\n\n", name, name,
                     study["threads"].get<int>(), study["size"].get<std::string>(), study.value("commit", "unknown"),
                     study.value("machine", "unknown"));
    return s;
}

}  // namespace weir::validation
