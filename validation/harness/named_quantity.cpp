#include "validation/harness/named_quantity.hpp"

#include "core/error.hpp"
#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>

namespace weir::validation {
namespace {

struct Word {
    std::string_view name;
    Statistic kind;
};
constexpr Word words[] = {{"end", Statistic::end},
                          {"max", Statistic::max},
                          {"min", Statistic::min},
                          {"mean", Statistic::mean},
                          {"rms", Statistic::rms},
                          {"range", Statistic::range},
                          {"drift", Statistic::drift},
                          {"change", Statistic::change},
                          {"time_of_max", Statistic::time_of_max},
                          {"time_of_min", Statistic::time_of_min},
                          {"period", Statistic::period},
                          {"curve", Statistic::curve},
                          {"picture", Statistic::picture}};

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
    throw BadInput(
        fmt::format("quantity {}: {}; expected PROBE[.COLUMN][.STATISTIC][@WHEN] or INTEGRAL[.STATISTIC][@WHEN], such as "
                    "right.height.max@0.8.. or front.time_of(>0.4)",
                    scene::quote(std::string(text)), why));
}

std::optional<real> number(std::string_view text) {
    real value = 0;
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (wrong != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

Window parse_window(std::string_view text, std::string_view whole) {
    const auto time = [&](std::string_view part) {
        const auto value = number(part);
        if (!value || *value < 0) refuse(whole, fmt::format("@{} is no time; write @2.5, @0.8.. or @0.8..2 [s]", text));
        return *value;
    };
    const auto dots = text.find("..");
    if (dots == std::string_view::npos) return {time(text), time(text)};
    Window window;
    if (dots > 0) window.first = time(text.substr(0, dots));
    if (dots + 2 < text.size()) window.last = time(text.substr(dots + 2));
    if (!(window.first < window.last) || text.size() == 2) refuse(whole, fmt::format("@{} is an empty interval", text));
    if (window.first == 0) window.first = -infinity;  // from the beginning of the series, which may be the first step
    return window;
}

/// ">0.45", "<0.1,2".
Crossing parse_crossing(std::string_view text, std::string_view whole) {
    Crossing crossing;
    const auto comma = text.find(',');
    const std::string_view level = text.substr(0, comma);
    if (level.empty() || (level[0] != '>' && level[0] != '<')) refuse(whole, "time_of requires (>LEVEL), (<LEVEL) or (>LEVEL,COUNT)");
    crossing.above = level[0] == '>';
    const auto value = number(level.substr(1));
    if (!value) refuse(whole, fmt::format("{} is no level", level));
    crossing.level = *value;
    if (comma == std::string_view::npos) return crossing;
    const auto count = number(text.substr(comma + 1));
    if (!count || *count < 1 || *count > 1e6 || *count != std::floor(*count))
        refuse(whole, "the count of a crossing is a whole number from 1");
    crossing.number = static_cast<int>(*count);
    return crossing;
}

/// Takes ".time_of(...)" or a word of the list off the end of `name`.
void take_statistic(std::string_view& name, NamedQuantity& q, std::string_view whole) {
    const auto open = name.find(".time_of(");
    if (open != std::string_view::npos) {
        if (name.back() != ')') refuse(whole, "')' is missing");
        q.kind = Statistic::time_of, q.statistic = std::string(name.substr(open + 1));
        q.crossing = parse_crossing(name.substr(open + 9, name.size() - open - 10), whole);
        name = name.substr(0, open);
        return;
    }
    const auto dot = name.rfind('.');
    if (dot == std::string_view::npos) return;
    for (const Word& word : words)
        if (name.substr(dot + 1) == word.name) {
            q.kind = word.kind, q.statistic = std::string(word.name);
            name = name.substr(0, dot);
            return;
        }
}

bool all_finite(const Curve& c) {
    return std::all_of(c.y.begin(), c.y.end(), [](real y) { return std::isfinite(y); });
}

/// Time average of f(y), by the trapezoidal rule.
real average(const Curve& c, const std::function<real(real)>& f) {
    if (c.size() == 1) return f(c.y[0]);
    real sum = 0;
    for (std::size_t i = 1; i < c.size(); ++i) sum += 0.5 * (c.x[i] - c.x[i - 1]) * (f(c.y[i]) + f(c.y[i - 1]));
    return sum / (c.x.back() - c.x.front());
}

real largest_distance(const Curve& c) {
    real most = 0;
    for (const real y : c.y) most = std::max(most, std::abs(y - c.y.front()));
    return most;
}

/// The vertex of the parabola through sample i and its neighbours, where i is the largest of the three.
real vertex(const Curve& c, std::size_t i) {
    if (i == 0 || i + 1 == c.size()) return c.x[i];
    const real left = c.x[i - 1] - c.x[i], right = c.x[i + 1] - c.x[i];
    const real a = c.y[i - 1] - c.y[i], b = c.y[i + 1] - c.y[i];
    const real curvature = (a / left - b / right) / (left - right), slope = a / left - curvature * left;
    return curvature < 0 ? c.x[i] - 0.5 * slope / curvature : c.x[i];
}

real time_of_max(const Curve& c) { return vertex(c, static_cast<std::size_t>(std::max_element(c.y.begin(), c.y.end()) - c.y.begin())); }

Curve negative(Curve c) {
    for (real& y : c.y) y = -y;
    return c;
}

/// Times at which the series rises above the level; its first sample where it begins above.
std::vector<real> rises(const Curve& c, real level, bool with_first) {
    std::vector<real> times;
    if (with_first && c.y[0] > level) times.push_back(c.x[0]);
    for (std::size_t i = 1; i < c.size(); ++i)
        if (c.y[i - 1] <= level && c.y[i] > level)
            times.push_back(c.x[i - 1] + (c.x[i] - c.x[i - 1]) * (level - c.y[i - 1]) / (c.y[i] - c.y[i - 1]));
    return times;
}

real time_of(const Curve& c, const Crossing& crossing) {
    const auto times = crossing.above ? rises(c, crossing.level, true) : rises(negative(c), -crossing.level, true);
    const auto wanted = static_cast<std::size_t>(crossing.number);
    return times.size() < wanted ? std::nan("") : times[wanted - 1];
}

real period(const Curve& c) {
    const auto times = rises(c, average(c, [](real y) { return y; }), false);
    if (times.size() < 2) return std::nan("");
    return (times.back() - times.front()) / static_cast<real>(times.size() - 1);
}

}  // namespace

NamedQuantity parse_quantity(std::string_view text) {
    NamedQuantity q{.text = std::string(text)};
    std::string_view name = text;
    if (const auto at = name.rfind('@'); at != std::string_view::npos) {
        q.when = parse_window(name.substr(at + 1), text);
        name = name.substr(0, at);
    }
    if (name.empty()) refuse(text, "the name is missing");
    take_statistic(name, q, text);
    if (name.starts_with("probe.")) name.remove_prefix(6);  // as metrics of cases name probes
    if (name.empty()) refuse(text, "the name is missing");
    q.series = std::string(name);
    if (q.kind == Statistic::picture && !q.when.one_time() && (q.when.first > -infinity || q.when.last < infinity))
        refuse(text, "a picture is of one time; write @2.5, or nothing for the end");
    if (q.when.one_time() && q.kind != Statistic::end && q.kind != Statistic::picture)
        refuse(text, fmt::format("{} of one time means nothing; write an interval, such as @{}..", q.statistic, q.when.first));
    return q;
}

Curve within(const Curve& series, const Window& window) {
    Curve part{.label = series.label};
    if (series.x.empty()) return part;
    const real begin = series.x.front(), end = series.x.back();
    const real row = series.size() > 1 ? end - series.x[series.size() - 2] : 0;  // the end of a run lies at most a row after the last one
    const real late = std::max(row * (1 - 1e-6), 1e-9 * std::abs(end));
    const auto known = [&](real t) { return !std::isfinite(t) || (t >= begin - 1e-9 * std::abs(begin) && t <= end + late); };
    if (!known(window.first) || !known(window.last)) return part;
    const real first = std::clamp(window.first, begin, end), last = std::clamp(window.last, begin, end);
    const auto add = [&](real t, real y) { part.x.push_back(t), part.y.push_back(y); };
    add(first, interpolate(series, first));
    for (std::size_t i = 0; i < series.size(); ++i)
        if (series.x[i] > first && series.x[i] < last) add(series.x[i], series.y[i]);
    if (last > first) add(last, interpolate(series, last));
    return part;
}

real statistic_of(const Curve& series, const NamedQuantity& q) {
    const Curve c = within(series, q.when);
    if (c.y.empty() || !all_finite(c)) return std::nan("");
    const real first = c.y.front(), last = c.y.back();
    const auto [least, most] = std::minmax_element(c.y.begin(), c.y.end());
    switch (q.kind) {
        case Statistic::end:
            return last;
        case Statistic::max:
            return *most;
        case Statistic::min:
            return *least;
        case Statistic::range:
            return *most - *least;
        case Statistic::mean:
            return average(c, [](real y) { return y; });
        case Statistic::rms:
            return std::sqrt(average(c, [](real y) { return y * y; }));
        case Statistic::drift:
            return largest_distance(c) / std::abs(first);
        case Statistic::change:
            return (last - first) / std::abs(first);
        case Statistic::time_of_max:
            return time_of_max(c);
        case Statistic::time_of_min:
            return time_of_max(negative(c));
        case Statistic::time_of:
            return time_of(c, q.crossing);
        case Statistic::period:
            return period(c);
        case Statistic::curve:
        case Statistic::picture:
            break;
    }
    throw BadInput(fmt::format("quantity {}: a {} is no single number", scene::quote(q.text), q.statistic));
}

std::vector<real> sampled(const Curve& series, const std::vector<real>& times) {
    std::vector<real> values;
    for (const real t : times) values.push_back(interpolate(series, t));
    return values;
}

std::string unit_of(const NamedQuantity& q, const std::string& unit) {
    if (q.is_time()) return "s";
    return q.kind == Statistic::drift || q.kind == Statistic::change ? "" : unit;
}

}  // namespace weir::validation
