#include "validation/cost/recommend.hpp"

#include "core/error.hpp"
#include "output/machine.hpp"
#include "sim/registry.hpp"
#include "validation/report/command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

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

/// What settings of a method are multiples of: cells along the sweep's axis that leave whole numbers along the others, or iterations.
real grain_of(const Variant& method) {
    const Sweep& sweep = *method.sweep;
    if (sweep.key.find("iterations") != std::string::npos) return 1;
    if (sweep.key != "grid.cells") return 0;
    Variant plain = method;
    plain.sweep.reset();
    const auto cells = scene_of(plain, 0, sim::schemas()).root().numbers("grid.cells");
    const auto along = static_cast<std::int64_t>(cells.at(static_cast<std::size_t>(sweep.axis)));
    std::int64_t common = along;
    for (std::size_t a = 0; a < cells.size(); ++a)
        if (std::find(sweep.keep.begin(), sweep.keep.end(), static_cast<int>(a)) == sweep.keep.end())
            common = std::gcd(common, static_cast<std::int64_t>(cells[a]));
    return static_cast<real>(along / common);
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
    if (found == units.end()) throw BadInput(fmt::format("--budget {}: a time has a unit, us, ms or s", text));
    return value * found->second;
}

real parse_error(const std::string& text) {
    const auto [value, unit] = number_and_unit(text, "error");
    if (unit != "%" && !unit.empty()) throw BadInput(fmt::format("--error {}: a number, or per cent", text));
    return unit.empty() ? value : value / 100;
}

std::vector<CostCurve> read_cost_table(const Study& study, const std::filesystem::path& folder) {
    const auto file = table_file(folder, study.name);
    std::ifstream in(file);
    std::vector<std::string> head;
    std::vector<CostCurve> curves;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        const auto cells = cells_of(line);
        if (head.empty()) {
            head = cells;
            continue;
        }
        const auto cell = [&](const char* name) {
            const auto at = static_cast<std::size_t>(std::find(head.begin(), head.end(), name) - head.begin());
            return at < cells.size() ? cells[at] : std::string();
        };
        if (!cell("failure").empty() || cell("setting").empty()) continue;
        auto curve = std::find_if(curves.begin(), curves.end(), [&](const CostCurve& c) { return c.method == cell("method"); });
        if (curve == curves.end()) {
            const Variant* method = method_named(study, cell("method"));
            const bool iterations = method && method->sweep && method->sweep->key.find("iterations") != std::string::npos;
            curve = curves.insert(curves.end(), {cell("method"), iterations, {}});
            if (method && method->sweep) curve->grain = grain_of(*method);
        }
        curve->points.push_back(
            {std::stod(cell("setting")), std::stod(cell("error")), std::stod(cell("seconds_per_second")), std::stod(cell("ms_per_step"))});
    }
    if (head.empty() || curves.empty()) throw BadInput(file.string() + ": no setting in this table can be read");
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
    const auto time = curve.counts_iterations ? by_line : by_power;
    const auto error = curve.counts_iterations ? by_factor : by_power;
    const auto read = [&](auto how, auto Priced::*of) { return how(setting, a.setting, b.setting, a.*of, b.*of); };
    return Priced{setting, read(error, &Priced::error), read(time, &Priced::seconds_per_second), read(time, &Priced::ms_per_step)};
}

double seconds_of(const Priced& p, Price price, const Budget& budget) {
    const double step = 1e-3 * p.ms_per_step;
    return price == Price::step ? step : std::max(step, p.seconds_per_second * budget.frame);
}

Recommendation recommend(const std::vector<CostCurve>& curves, Price price, const Budget& budget) {
    std::vector<Choice> all;
    const auto consider = [&](const CostCurve& c, const Priced& p, bool measured) {
        all.push_back({&c, p, seconds_of(p, price, budget), measured});
    };
    for (const CostCurve& c : curves)
        for (std::size_t i = 0; i < c.points.size(); ++i) {
            consider(c, c.points[i], true);
            if (i == 0) continue;
            const real from = c.points[i - 1].setting, to = c.points[i].setting;
            real last = from;
            for (int k = 1; k < between; ++k) {
                const real setting = rounded(by_power(k, 1, between, from, to), c.grain);
                if (setting <= last || setting >= to) continue;
                last = setting;
                if (const auto p = predict(c, setting)) consider(c, *p, false);
            }
        }
    const auto cheaper = [](const Choice& a, const Choice& b) { return a.seconds < b.seconds; };
    const auto better = [](const Choice& a, const Choice& b) { return a.at.error < b.at.error; };
    const auto best = [&](auto holds, auto less) {
        std::optional<Choice> found;
        for (const Choice& c : all)
            if (holds(c) && (!found || less(c, *found))) found = c;
        return found;
    };
    const auto in_time = [&](const Choice& c) { return c.seconds <= budget.seconds; };
    const auto good = [&](const Choice& c) { return c.at.error <= budget.error; };
    Recommendation r;
    r.take = best([&](const Choice& c) { return in_time(c) && good(c); }, cheaper);
    if (r.take) return r;
    const auto any = [](const Choice&) { return true; };
    auto within = best(in_time, better), enough = best(good, cheaper);
    r.nearest.push_back(within ? *within : *best(any, cheaper));
    const Choice second = enough ? *enough : *best(any, better);
    const auto same = [&](const Choice& c) { return c.curve == r.nearest[0].curve && c.at.setting == r.nearest[0].at.setting; };
    const auto other = best([&](const Choice& c) { return c.curve != r.nearest[0].curve && in_time(c); }, better);
    if (!same(second))
        r.nearest.push_back(second);
    else if (other)
        r.nearest.push_back(*other);  // one setting is nearest in both ways: the best of another method
    return r;
}

namespace {

std::string setting_text(const Choice& c, const Study& study) {
    const Variant* method = method_named(study, c.curve->method);
    const std::string key = method && method->sweep ? method->sweep->key : "setting";
    std::string also;
    if (method && method->sweep)
        for (const auto& follower : method->sweep->also) also += fmt::format(" ({} goes with it)", follower.key);
    return fmt::format("{}{}{} = {:g}{}{}", c.curve->method, c.curve->method.empty() ? "" : ", ", key, c.at.setting,
                       key == "grid.cells" ? " along x" : "", also);
}

std::string priced_text(const Choice& c, const Study& study) {
    return fmt::format("{}: {} {:.3g}, {:.3g} ms a {} ({:.3g} ms a step){}", setting_text(c, study), study.error, c.at.error,
                       1e3 * c.seconds, study.price == Price::step ? "step" : "frame", c.at.ms_per_step,
                       c.measured ? "" : ", read between two measured settings");
}

/// Says whose tables these are, where they are not this machine's.
std::string machine_text(const PlanOptions& options, const std::string& name) {
    for (const auto& file : {options.tables / "json" / (name + ".json"), options.tables / (name + ".json")}) {
        std::ifstream in(file);
        if (!in) continue;
        const auto tables = nlohmann::json::parse(in, nullptr, false);
        if (!tables.is_object()) continue;
        const std::string machine = tables.value("machine", ""), here = output::this_machine().processor;
        const std::string whose =
            fmt::format("measured on {}, {} thread(s), commit {}\n", machine, tables.value("threads", 1), tables.value("commit", ""));
        return machine.find(here) != std::string::npos
                   ? whose
                   : whose + fmt::format("this machine is {}: measure its own with `weir cost {} --publish`\n", here, name);
    }
    return {};
}

}  // namespace

int plan_command(const PlanOptions& options) {
    if (options.error.empty()) throw BadInput("weir plan needs --error: how wrong the result may be, such as 2%");
    const Study study = read_study(find_case(options.name), options.size);
    const Budget budget{parse_seconds(options.budget), parse_error(options.error), parse_seconds(options.frame)};
    const auto curves = read_cost_table(study, options.tables);
    const Recommendation r = recommend(curves, study.price, budget);
    fmt::print("{}: {} at most {:g} for {:g} ms of computing a {}\n", study.name, study.error, budget.error, 1e3 * budget.seconds,
               study.price == Price::step ? std::string("step") : fmt::format("frame of {:.3g} ms", 1e3 * budget.frame));
    if (r.take) {
        fmt::print("take {}\n", priced_text(*r.take, study));
    } else {
        fmt::print("no setting of the table reaches it; the nearest two:\n");
        for (const Choice& c : r.nearest) fmt::print("  {}\n", priced_text(c, study));
    }
    fmt::print("{}", machine_text(options, study.name));
    return r.take ? exit_success : exit_claim_failed;
}

}  // namespace weir::validation
