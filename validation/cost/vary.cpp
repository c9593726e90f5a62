// --vary: settings of the user's own in place of a study's.
#include "validation/cost/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace weir::validation {
namespace {

struct Settings {
    std::string key;
    std::vector<std::string> values;
};

/// "key=a,b,[c, d]" with commas inside brackets and quotes left alone.
Settings split(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw BadInput(fmt::format("--vary {}: expected key=value,value,...", text));
    Settings s{.key = text.substr(0, equals), .values = {""}};
    int depth = 0;
    bool quoted = false;
    for (const char c : text.substr(equals + 1)) {
        if (c == '"') quoted = !quoted;
        if (!quoted) depth += (c == '[') - (c == ']');
        if (c == ',' && depth == 0 && !quoted)
            s.values.emplace_back();
        else
            s.values.back() += c;
    }
    return s;
}

/// How a method's scene takes key = value: it does, its solver knows the key but not the value, or it does not know the key.
enum class Answer { taken, refused, unknown_key };

Answer try_on(const Variant& method, const std::string& key, const std::string& value, const std::vector<scene::SolverSchema>& schemas) {
    if (key == "grid.cells" && !value.starts_with('[')) return Answer::taken;  // a count along an axis: the sweep's own form
    Variant tried = method;
    tried.sweep.reset();
    tried.overrides.push_back({key, value});
    try {
        scene_of(tried, 0, schemas);
        return Answer::taken;
    } catch (const scene::BadScene& bad) {
        const auto unknown = [](const scene::Problem& p) { return p.message.starts_with("unknown key"); };
        return std::all_of(bad.problems.begin(), bad.problems.end(), unknown) ? Answer::unknown_key : Answer::refused;
    } catch (const BadInput&) {
        return Answer::refused;
    }
}

/// The whole name of a key, or nothing where the method's solver does not know it.
std::optional<std::string> whole_key(const Settings& s, const Variant& method, const std::vector<scene::SolverSchema>& schemas) {
    if (s.key.find('.') != std::string::npos)
        return try_on(method, s.key, s.values.front(), schemas) == Answer::unknown_key ? std::nullopt : std::optional(s.key);
    for (const char* prefix : {"scheme.", "scheme.poisson.", "time."})
        if (try_on(method, prefix + s.key, s.values.front(), schemas) == Answer::taken) return prefix + s.key;
    return std::nullopt;
}

/// No method takes it: what the reader says of a whole key, or where a name without a dot was looked for.
[[noreturn]] void refuse(const Settings& s, const Variant& method, const std::vector<scene::SolverSchema>& schemas) {
    if (s.key.find('.') != std::string::npos) {
        Variant tried = method;
        tried.sweep.reset();
        tried.overrides.push_back({s.key, s.values.front()});
        scene_of(tried, 0, schemas);  // throws
    }
    throw BadInput(
        fmt::format("--vary {}: {} takes no such value in scheme, scheme.poisson or time; give the whole key, as `weir describe` shows it",
                    s.key, method.scene.string()));
}

std::vector<real> numbers(const Settings& s) {
    std::vector<real> list;
    for (const std::string& text : s.values) {
        real value = 0;
        const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (wrong != std::errc() || end != text.data() + text.size()) return {};
        list.push_back(value);
    }
    return list;
}

}  // namespace

void vary(Study& study, const std::vector<std::string>& changes, const Solvers& solvers) {
    const auto schemas = scene::schemas_of(solvers);
    bool swept = false;
    for (const std::string& change : changes) {
        const Settings s = split(change);
        const std::vector<real> values = numbers(s);
        std::vector<Variant> methods;
        bool taken = false;
        for (const Variant& method : study.methods) {
            const auto whole = whole_key(s, method, schemas);
            if (!whole) {
                methods.push_back(method);
                continue;
            }
            taken = true;
            const std::string& key = *whole;
            if (!swept && !values.empty()) {
                methods.push_back(method);
                methods.back().sweep = Sweep{.key = key, .values = values};
                continue;
            }
            for (const std::string& value : s.values) {
                methods.push_back(method);
                methods.back().overrides.push_back({key, value});
                methods.back().name += fmt::format("{}{}={}", method.name.empty() ? "" : " ", s.key, value);
            }
        }
        if (!taken) refuse(s, study.methods.front(), schemas);
        study.methods = std::move(methods);
        swept = swept || !values.empty();
    }
}

}  // namespace weir::validation
