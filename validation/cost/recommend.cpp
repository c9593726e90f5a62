#include "validation/cost/recommend.hpp"

#include "backend/device.hpp"
#include "core/error.hpp"
#include "particles/threads/isa.hpp"
#include "sim/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <utility>

namespace weir::validation {
namespace {

/// Two entries whose errors are further apart than this do not tell how the error falls between them: one of them has converged to
/// round-off, or the other has not begun to.
constexpr real widest_step = 1e5;
constexpr int between = 8;  // settings that are tried between two entries

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells{""};
    bool quoted = false;
    for (const char c : line) {
        if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            cells.emplace_back();
        else
            cells.back() += c;
    }
    return cells;
}

std::filesystem::path table_file(const std::filesystem::path& folder, const std::string& name) {
    for (const auto& file : {folder / "csv" / (name + ".csv"), folder / (name + ".csv")})
        if (std::filesystem::exists(file)) return file;
    throw BadInput(fmt::format("{}: there is no table of {}; `weir cost {} --publish` measures one", folder.string(), name, name));
}

const Variant* method_named(const Study& study, const std::string& name) {
    for (const Variant& v : study.methods)
        if (v.name == name) return &v;
    return nullptr;
}

/// Whether the values of a key say how many: iterations, or entries of a list.
bool counts(const std::string& key) { return key.find("iterations") != std::string::npos || key.ends_with("[:]"); }

/// What settings of a method are multiples of: cells along the sweep's axis that leave whole numbers along the others, or one where they
/// count.
real grain_of(const Variant& method) {
    const Sweep& sweep = *method.sweep;
    if (counts(sweep.key)) return 1;
    if (sweep.key != "grid.cells") return 0;
    Variant plain = method;
    plain.sweep.reset();
    const auto cells = scene_of(plain, 0, sim::schemas()).root().numbers("grid.cells");
    const auto along = static_cast<std::int64_t>(cells.at(static_cast<std::size_t>(sweep.axis)));
    std::int64_t common = along;
    for (std::size_t a = 0; a < cells.size(); ++a)
        if (std::find(sweep.keep.begin(), sweep.keep.end(), static_cast<int>(a)) == sweep.keep.end())
            common = std::gcd(common, static_cast<std::int64_t>(cells[a]));
    const std::int64_t least = along / common;  // common divides it
    return static_cast<real>(least);
}

real by_power(real x, real x0, real x1, real y0, real y1) { return y0 * std::pow(y1 / y0, std::log(x / x0) / std::log(x1 / x0)); }
real by_factor(real x, real x0, real x1, real y0, real y1) { return y0 * std::pow(y1 / y0, (x - x0) / (x1 - x0)); }
real by_line(real x, real x0, real x1, real y0, real y1) { return y0 + (y1 - y0) * (x - x0) / (x1 - x0); }

/// "12.5 ms" into 12.5 and "ms".
std::pair<double, std::string> number_and_unit(const std::string& text, const char* what) {
    double value = 0;
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
    std::string unit(end, text.data() + text.size());
    unit.erase(std::remove(unit.begin(), unit.end(), ' '), unit.end());
    if (wrong != std::errc() || !(value > 0)) throw BadInput(fmt::format("--{} {}: expected a positive number and its unit", what, text));
    return {value, unit};
}

}  // namespace

double parse_seconds(const std::string& text) {
    static const std::map<std::string, double> units{{"us", 1e-6}, {"ms", 1e-3}, {"s", 1}};
    const auto [value, unit] = number_and_unit(text, "budget");
    const auto found = units.find(unit);
    if (found == units.end()) throw BadInput(fmt::format("--budget {}: a time requires a unit: us, ms or s", text));
    return value * found->second;
}

real parse_error(const std::string& text) {
    const auto [value, unit] = number_and_unit(text, "error");
    if (unit != "%" && !unit.empty())
        throw BadInput(fmt::format("--error {}: expected a number or a percentage, such as 0.02 or 2%", text));
    return unit.empty() ? value : value / 100;
}

namespace {

/// Which of a method's settings the table calls so, the only one where it has no sweep; runs() where it has none of that name.
std::size_t index_of(const Variant& method, const std::string& setting) {
    for (std::size_t i = 0; i < method.runs(); ++i)
        if (setting == (method.sweep ? fmt::format("{:g}", method.sweep->values[i]) : std::string())) return i;
    return method.runs();
}

/// Whether this machine has the device or the vector unit that a scene names.
bool runs_here(const scene::Scene& scene) {
    if (!scene.has("scheme.backend")) return true;
    const backend::Choice choice = backend::parse_choice(scene.text("scheme.backend"));
    if (choice.kind == backend::Choice::Kind::opencl) return static_cast<std::size_t>(choice.device) < backend::devices().size();
    const auto& here = particles::available_passes();
    return choice.isa == "auto" || std::any_of(here.begin(), here.end(), [&](const auto* p) { return p->name == choice.isa; });
}

struct TableFile {
    std::string title;                             // its first line
    std::vector<std::string> head;                 // names of the columns
    std::vector<std::vector<std::string>> rows{};  // cells

    std::string cell(std::size_t row, const char* name) const {
        const auto at = static_cast<std::size_t>(std::find(head.begin(), head.end(), name) - head.begin());
        return at < rows[row].size() ? rows[row][at] : std::string();
    }
};

TableFile read_table(const std::filesystem::path& file) {
    std::ifstream in(file);
    TableFile table;
    for (std::string line; std::getline(in, line);) {
        if (line.empty()) continue;
        if (line[0] == '#')
            table.title += line;
        else if (table.head.empty())
            table.head = cells_of(line);
        else
            table.rows.push_back(cells_of(line));
    }
    return table;
}

}  // namespace

Size size_of_table(const std::string& study, const std::filesystem::path& folder) {
    const bool full = read_table(table_file(folder, study)).title.find(" at full size") != std::string::npos;
    return full ? Size::full : Size::ci;
}

std::vector<CostCurve> read_cost_table(const Study& study, const std::filesystem::path& folder) {
    const auto file = table_file(folder, study.name);
    const TableFile table = read_table(file);
    const auto schemas = sim::schemas();
    std::vector<CostCurve> curves;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const auto cell = [&](const char* name) { return table.cell(row, name); };
        const Variant* method = method_named(study, cell("method"));
        if (!method || !cell("failure").empty()) continue;
        const std::size_t index = index_of(*method, cell("setting"));
        if (index == method->runs() || !runs_here(scene_of(*method, index, schemas))) continue;
        auto curve = std::find_if(curves.begin(), curves.end(), [&](const CostCurve& c) { return c.method == method->name; });
        if (curve == curves.end()) {
            const bool counting = method->sweep && counts(method->sweep->key);
            curve = curves.insert(curves.end(), {.method = method->name, .counts = counting, .points = {}});
            if (method->sweep) curve->grain = grain_of(*method);
        }
        curve->points.push_back({.setting = method->sweep ? method->sweep->values[index] : 0,
                                 .error = std::stod(cell("error")),
                                 .seconds_per_second = std::stod(cell("seconds_per_second")),
                                 .ms_per_step = std::stod(cell("ms_per_step")),
                                 .steps = std::stoll(cell("steps")),
                                 .threads = std::stoi(cell("threads")),
                                 .index = index});
    }
    if (curves.empty()) throw BadInput(file.string() + ": no configuration of this table can be run here");
    for (CostCurve& c : curves)
        std::sort(c.points.begin(), c.points.end(), [](const Priced& a, const Priced& b) { return a.setting < b.setting; });
    return curves;
}

namespace {

/// A setting that can be asked for: a multiple of the grain, or a number of two digits.
real rounded(real setting, real grain) {
    if (grain > 0) return grain * std::round(setting / grain);
    const real digit = std::pow(10, std::floor(std::log10(setting)) - 1);
    return digit * std::round(setting / digit);
}

}  // namespace

std::optional<Priced> predict(const CostCurve& curve, real setting) {
    const auto& p = curve.points;
    const auto above = std::find_if(p.begin(), p.end(), [&](const Priced& q) { return q.setting >= setting; });
    if (above == p.end()) return std::nullopt;
    if (above->setting == setting) return *above;
    if (above == p.begin()) return std::nullopt;
    const Priced &a = *(above - 1), &b = *above;
    const real ratio = a.error / b.error;
    if (!(a.error > 0 && b.error > 0) || std::max(ratio, 1 / ratio) > widest_step) return std::nullopt;
    const auto time = curve.counts ? by_line : by_power;
    const auto error = curve.counts ? by_factor : by_power;
    const auto read = [&](auto how, auto Priced::*of) { return how(setting, a.setting, b.setting, a.*of, b.*of); };
    return Priced{.setting = setting,
                  .error = read(error, &Priced::error),
                  .seconds_per_second = read(time, &Priced::seconds_per_second),
                  .ms_per_step = read(time, &Priced::ms_per_step),
                  .threads = a.threads};
}

double seconds_of(const Priced& p, Price price, const Budget& budget) {
    const double step = 1e-3 * p.ms_per_step;
    return price == Price::step ? step : std::max(step, p.seconds_per_second * budget.frame);
}

namespace {

std::vector<Choice> entries(const std::vector<CostCurve>& curves, Price price, const Budget& budget) {
    std::vector<Choice> all;
    for (const CostCurve& c : curves)
        for (const Priced& p : c.points) all.push_back({&c, p, seconds_of(p, price, budget)});
    return all;
}

/// Settings between two entries of a curve that a scene can take.
std::vector<Choice> between_entries(const std::vector<CostCurve>& curves, Price price, const Budget& budget) {
    std::vector<Choice> all;
    for (const CostCurve& c : curves)
        for (std::size_t i = 1; i < c.points.size(); ++i) {
            const real from = c.points[i - 1].setting, to = c.points[i].setting;
            real last = from;
            for (int k = 1; k < between; ++k) {
                const real setting = rounded((from > 0 ? by_power : by_line)(k, 1, between, from, to), c.grain);
                if (setting <= last || setting >= to) continue;
                last = setting;
                if (const auto p = predict(c, setting)) all.push_back({&c, *p, seconds_of(*p, price, budget)});
            }
        }
    return all;
}

template <class Holds, class Less>
std::optional<Choice> best(const std::vector<Choice>& all, Holds&& holds, Less&& less) {
    std::optional<Choice> found;
    for (const Choice& c : all)
        if (holds(c) && (!found || less(c, *found))) found = c;
    return found;
}

bool same(const Choice& a, const Choice& b) { return a.curve == b.curve && a.at.setting == b.at.setting; }

}  // namespace

Recommendation recommend(const std::vector<CostCurve>& curves, Price price, const Budget& budget) {
    const auto cheaper = [&](const Choice& a, const Choice& b) {
        return std::pair(a.seconds, budget.told(a.at.error)) < std::pair(b.seconds, budget.told(b.at.error));
    };
    const auto better = [&](const Choice& a, const Choice& b) {
        return std::pair(budget.told(a.at.error), a.seconds) < std::pair(budget.told(b.at.error), b.seconds);
    };
    const auto in_time = [&](const Choice& c) { return c.seconds <= budget.seconds; };
    const auto good = [&](const Choice& c) { return budget.told(c.at.error) <= budget.told(budget.error); };
    const auto both = [&](const Choice& c) { return in_time(c) && good(c); };
    const auto any = [](const Choice&) { return true; };
    const std::vector<Choice> all = entries(curves, price, budget);
    Recommendation r;
    if (budget.error == infinity)
        r.take = best(all, in_time, better);
    else
        r.take = best(all, both, cheaper);
    if (budget.error < infinity) r.between = best(between_entries(curves, price, budget), both, cheaper);
    if (r.take && r.between && !(r.between->seconds < r.take->seconds)) r.between.reset();
    if (r.take) return r;
    const auto within = best(all, in_time, better), enough = best(all, good, cheaper);
    r.nearest.push_back(within ? *within : *best(all, any, cheaper));
    const Choice second = enough ? *enough : *best(all, any, better);
    if (!same(second, r.nearest[0])) r.nearest.push_back(second);
    return r;
}

std::vector<Choice> recommendable(const std::vector<CostCurve>& curves, Price price, const Budget& budget) {
    const std::vector<Choice> all = entries(curves, price, budget);
    std::vector<Choice> list;
    for (const Choice& p : all) {
        const real error = budget.told(p.at.error);
        const auto beats = [&](const Choice& q) {
            const real other = budget.told(q.at.error);
            return q.seconds <= p.seconds && other <= error && (q.seconds < p.seconds || other < error || &q < &p);
        };
        if (std::none_of(all.begin(), all.end(), beats)) list.push_back(p);
    }
    return list;
}

}  // namespace weir::validation
