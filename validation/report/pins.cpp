#include "validation/report/pins.hpp"

#include "output/atomic_file.hpp"
#include "output/machine.hpp"
#include "validation/page/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace weir::validation {
namespace {

using nlohmann::json;

constexpr real relative = 1e-6, round_off = 1e-9;

/// The nearest number of nine digits; what is not finite is null in JSON.
real nine_digits(real x) { return std::isfinite(x) ? std::strtod(fmt::format("{:.9g}", x).c_str(), nullptr) : x; }

real number_of(const json& x) { return x.is_number() ? x.get<real>() : std::nan(""); }

}  // namespace

json pins_json(const Numbers& numbers, double seconds_to_publish) {
    json pinned = json::object();
    for (const auto& [name, x] : numbers) pinned[name] = nine_digits(x);
    const output::Machine machine = output::this_machine();
    return {{"commit", machine.commit},
            {"rounding", machine.rounding},
            {"seconds_to_publish", std::ceil(seconds_to_publish)},
            {"numbers", pinned}};
}

void write_pins(const json& pins, const std::filesystem::path& published, const std::string& name) {
    const auto file = pins_file(published, name);
    std::filesystem::create_directories(file.parent_path());
    output::write_file(file, pins.dump(1) + "\n");
}

std::filesystem::path pins_file(const std::filesystem::path& published, const std::string& name) {
    return published / "pins" / (name + ".json");
}

bool same_number(real a, real b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
    const real larger = std::max(std::abs(a), std::abs(b));
    return a == b || larger <= round_off || (std::isfinite(larger) && std::abs(a - b) <= relative * larger);
}

std::string moved_text(const std::string& name, real published, real now) {
    const bool both = std::isfinite(published) && std::isfinite(now) && published != 0;
    const std::string by = both ? fmt::format(" by {:.2g}%", 100 * std::abs(now - published) / std::abs(published)) : "";
    return fmt::format("{} changed{}: {:.9g} published, {:.9g} now", name, by, published, now);
}

std::string rounds_otherwise(const json& pins) {
    const std::string here = output::this_machine().rounding, there = text_at(pins, "rounding");
    if (here == there) return "";
    return fmt::format("their values were computed on {}; this machine is {}, whose rounding differs",
                       there.empty() ? "an unnamed machine" : there, here);
}

Comparison compare_numbers(const Numbers& now, const json& pins) {
    Comparison c;
    const auto pinned = pins.is_object() ? pins.find("numbers") : pins.end();
    if (pinned == pins.end() || !pinned->is_object()) {
        c.not_compared = "none are published";
        return c;
    }
    c.seconds_to_publish = number_at(pins, "seconds_to_publish").value_or(0);
    for (const auto& [name, x] : now) {
        const auto at = pinned->find(name);
        if (at == pinned->end())
            c.moved.push_back(fmt::format("{} is not published: {:.9g}", name, x));
        else if (!same_number(number_of(*at), x))
            c.moved.push_back(moved_text(name, number_of(*at), x));
    }
    for (const auto& [name, x] : pinned->items())
        if (!now.count(name)) c.moved.push_back(fmt::format("{} is published but no longer measured", name));
    if (const std::string why = rounds_otherwise(pins); !why.empty())
        c.not_compared = fmt::format("{} ({} of {} differ)", why, c.moved.size(), pinned->size()), c.moved.clear();
    return c;
}

std::string comparison_text(const std::string& name, const std::string& command, const Comparison& c) {
    std::string s;
    if (!c.not_compared.empty()) s += fmt::format("{}: not compared with the published results: {}\n", name, c.not_compared);
    if (c.moved.empty()) return s;
    s += fmt::format("{}: published results are older than the code; publishing takes {:.0f} s: {}\n", name, c.seconds_to_publish, command);
    constexpr std::size_t most = 20;
    for (std::size_t i = 0; i < std::min(most, c.moved.size()); ++i) s += "    " + c.moved[i] + "\n";
    if (c.moved.size() > most) s += fmt::format("    and {} more\n", c.moved.size() - most);
    return s;
}

}  // namespace weir::validation
