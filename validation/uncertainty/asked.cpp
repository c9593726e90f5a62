#include "validation/uncertainty/asked.hpp"

#include "core/error.hpp"
#include "scene/names.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

namespace weir::validation {
namespace {

constexpr int samples_of_curve = 100;
constexpr int widest_2d = 64, widest_3d = 16;  // samples of a picture along an axis

std::string picture_name(std::size_t number, std::size_t line) { return fmt::format("weir_picture_{}_{}", number, line); }

/// The times at which a curve is sampled: none at the start, where all grids agree.
std::vector<real> times_of_curve(const Curve& series, const Window& window) {
    if (series.x.empty()) return {};
    const real first = std::max(window.first, real(0)), last = std::min(window.last, series.x.back());
    std::vector<real> times;  // alike on all grids; before its first value a series has that value
    for (int i = 1; i <= samples_of_curve; ++i)
        times.push_back(std::clamp(first + (last - first) * i / samples_of_curve, series.x.front(), series.x.back()));
    return times;
}

/// What a percentage refers to: the range of the series, or its size where it does not vary or cannot be negative. A series at the level of
/// round-off is measured by the largest one of its unit.
void set_scale(Value& value, const NamedQuantity& quantity, const RecordedSeries& series, const RecordedRun& run) {
    if (quantity.is_time() || quantity.kind == Statistic::drift || quantity.kind == Statistic::change) {
        value.scale = std::abs(value.samples.at(0)), value.scale_of = "its value";
        return;
    }
    const Curve part = within(series.curve, quantity.when.one_time() ? Window{} : quantity.when);
    const auto [least, most] = std::minmax_element(part.y.begin(), part.y.end());
    if (part.y.empty()) return;
    const real range = *most - *least, largest = std::max(std::abs(*least), std::abs(*most));
    const bool positive = series.integral && *least >= 0;
    value.scale = positive || range < no_variation * largest ? largest : range;
    value.scale_of = positive || range < no_variation * largest ? "its largest value" : "its range";
    if (const real of_unit = largest_of_unit(run, series.unit); value.scale < round_off * of_unit)
        value.scale = of_unit, value.scale_of = "the largest value in " + series.unit + ", since it is round-off";
}

Value picture_of(const RecordedRun& run, const Asked& asked, std::size_t number) {
    Value value;
    const std::string prefix = fmt::format("weir_picture_{}_", number);
    real least = infinity, most = -infinity;
    for (const RecordedSeries& s : run.series) {
        if (!s.name.starts_with(prefix)) continue;
        const real t = asked.quantity.when.one_time() ? asked.quantity.when.first : s.curve.x.back();
        value.samples.push_back(interpolate(s.curve, t));
        value.unit = s.unit;
        if (!std::isfinite(value.samples.back())) value.unknown = fmt::format("the field is not known everywhere at t = {:g} s", t);
        least = std::min(least, value.samples.back()), most = std::max(most, value.samples.back());
    }
    if (value.samples.empty()) value.unknown = "no sample of the field";
    value.scale = most - least, value.scale_of = "its range";
    return value;
}

}  // namespace

real largest_of_unit(const RecordedRun& run, const std::string& unit) {
    real largest = 0;
    for (const RecordedSeries& s : run.series)
        for (const real y : s.curve.y)
            if (s.unit == unit && std::isfinite(y)) largest = std::max(largest, std::abs(y));
    return largest;
}

Wish parse_wish(const std::string& text) {
    Wish wish{.text = text};
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), wish.value);
    std::string unit(end, text.data() + text.size());
    unit.erase(std::remove(unit.begin(), unit.end(), ' '), unit.end());
    static const std::map<std::string, std::pair<std::string, real>> units{{"mm", {"m", 1e-3}},  {"cm", {"m", 1e-2}}, {"um", {"m", 1e-6}},
                                                                           {"ms", {"s", 1e-3}},  {"us", {"s", 1e-6}}, {"kPa", {"Pa", 1e3}},
                                                                           {"mbar", {"Pa", 100}}};
    const bool no_unit = unit != "%" && unit.find_first_of("%,;:\"'") != std::string::npos;
    if (wrong != std::errc() || !(wish.value > 0) || !std::isfinite(wish.value) || no_unit)
        throw BadInput(fmt::format("--error {}: expected a positive number, such as 5%, 2mm or 0.02", text));
    wish.relative = unit == "%";
    if (wish.relative)
        wish.value /= 100;
    else if (const auto found = units.find(unit); found != units.end())
        wish.unit = found->second.first, wish.value *= found->second.second;
    else
        wish.unit = unit;
    return wish;
}

std::vector<Asked> parse_asked(const std::vector<std::string>& of) {
    if (of.empty()) throw BadInput("--of is missing: which quantity of the scene? such as --of right.height.max");
    std::vector<Asked> all;
    for (const auto& text : of) {
        if (find_metric(text))
            all.push_back({.quantity = {.text = text, .series = text}, .is_metric = true});
        else
            all.push_back({.quantity = parse_quantity(text)});
    }
    return all;
}

std::vector<scene::Override> picture_probes(const std::vector<Asked>& asked, const scene::Scene& scene) {
    std::vector<scene::Override> probes;
    std::size_t count = scene.root().tables("probes").size();
    const auto& size = scene.root().numbers("grid.size");
    const auto& cells = scene.root().numbers("grid.cells");
    const int widest = scene.dim() == 2 ? widest_2d : widest_3d;
    const std::vector<double> origin = scene.has("grid.origin") ? scene.root().numbers("grid.origin") : std::vector<double>(size.size(), 0);
    std::array<int, 3> n{1, 1, 1};
    for (std::size_t a = 0; a < cells.size(); ++a) n[a] = std::min(widest, static_cast<int>(cells[a]));
    for (std::size_t q = 0; q < asked.size(); ++q) {
        const NamedQuantity& quantity = asked[q].quantity;
        if (quantity.kind != Statistic::picture) continue;
        const real when = quantity.when.one_time() ? quantity.when.first : scene.number("time.end");
        if (!(when > 0)) throw BadInput(fmt::format("{}: a picture requires a time after the start, such as @2.5", quantity.text));
        std::size_t line = 0;
        for (int k = 0; k < n[2]; ++k)
            for (int j = 0; j < n[1]; ++j) {
                const auto at = [&](std::size_t axis, int i) { return origin[axis] + size[axis] * (i + 0.5) / n[axis]; };
                const auto point = [&](int i) {
                    return cells.size() == 2 ? fmt::format("[{}, {}]", at(0, i), at(1, j))
                                             : fmt::format("[{}, {}, {}]", at(0, i), at(1, j), at(2, k));
                };
                probes.push_back(
                    {fmt::format("probes[{}]", count++),
                     fmt::format("{{name = \"{}\", kind = \"line\", field = \"{}\", from = {}, to = {}, count = {}, every = {}}}",
                                 picture_name(q, line++), quantity.series, point(0), point(n[0] - 1), n[0], when)});
            }
    }
    return probes;
}

Value value_of(const RecordedRun& run, const Asked& asked, std::size_t number) {
    const NamedQuantity& quantity = asked.quantity;
    Value value;
    if (run.failure) {
        value.unknown = *run.failure;
        return value;
    }
    if (asked.is_metric) {
        const real measured = run.measured.at(quantity.text);
        value = {.samples = {measured}, .unit = find_metric(quantity.text)->unit, .scale = std::abs(measured), .scale_of = "its value"};
        if (!std::isfinite(measured)) value.unknown = "it has no finite value";
        return value;
    }
    if (quantity.kind == Statistic::picture) return picture_of(run, asked, number);
    const RecordedSeries& series = series_named(run.series, quantity.series);
    value.unit = unit_of(quantity, series.unit);
    if (quantity.is_vector())
        value.samples = sampled(series.curve, times_of_curve(series.curve, quantity.when));
    else
        value.samples = {statistic_of(series.curve, quantity)};
    const bool known =
        !value.samples.empty() && std::all_of(value.samples.begin(), value.samples.end(), [](real v) { return std::isfinite(v); });
    if (known)
        set_scale(value, quantity, series, run);
    else if (within(series.curve, quantity.when).y.empty())
        value.unknown = "the run does not cover the asked times";
    else
        value.unknown = quantity.is_time() ? "there is no such event in the run" : "it has no finite value";
    return value;
}

std::vector<real> whole_series(const RecordedRun& run, const Asked& asked) {
    if (run.failure || asked.is_metric || asked.quantity.kind == Statistic::picture) return {};
    const Curve& curve = series_named(run.series, asked.quantity.series).curve;
    return sampled(curve, times_of_curve(curve, asked.quantity.when.one_time() ? Window{} : asked.quantity.when));
}

real absolute(const Wish& wish, const Value& value) {
    if (wish.relative) return wish.value * value.scale;
    if (!wish.unit.empty() && wish.unit != value.unit)
        throw BadInput(fmt::format("--error {}: the quantity has the unit {}", wish.text, value.unit.empty() ? "1" : value.unit));
    return wish.value;
}

}  // namespace weir::validation
