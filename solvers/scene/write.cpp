// A table as text: the parsed scene, for run.json and for tests that read it back.
#include "scene/names.hpp"
#include "scene/scene.hpp"

#include <fmt/format.h>

#include <cmath>

namespace weir::scene {
namespace {

/// A quoted string by the rules common to TOML's basic strings and JSON.
std::string escaped(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out += '\\', out += c;
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            out += c;
    }
    return out + "\"";
}

std::string number(double v) {
    const auto text = number_text(v);
    return std::isfinite(v) && text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

struct Style {
    const char *open, *close, *assign;
    bool quote_keys;
};
constexpr Style toml{"{ ", " }", " = ", false};
constexpr Style json{"{", "}", ": ", true};

std::string write(const Table& table, const Style& style);

template <class List, class Text>
std::string write_list(const List& list, Text text) {
    std::string out = "[";
    for (const auto& entry : list) out += (out.size() > 1 ? ", " : "") + text(entry);
    return out + "]";
}

std::string write(const Value& value, const Style& style) {
    struct Visitor {
        const Style& style;
        std::string operator()(bool v) const { return v ? "true" : "false"; }
        std::string operator()(std::int64_t v) const { return std::to_string(v); }
        std::string operator()(double v) const { return number(v); }
        std::string operator()(const std::string& v) const { return escaped(v); }
        std::string operator()(const std::vector<double>& v) const { return write_list(v, number_text); }
        std::string operator()(const std::vector<std::string>& v) const { return write_list(v, escaped); }
        std::string operator()(const Table& v) const { return write(v, style); }
        std::string operator()(const std::vector<Table>& v) const {
            return write_list(v, [this](const Table& t) { return write(t, style); });
        }
    };
    return std::visit(Visitor{style}, value);
}

std::string write(const Table& table, const Style& style) {
    std::string out;
    for (const auto& key : table.keys())
        out += (out.empty() ? "" : ", ") + (style.quote_keys ? escaped(key) : key) + style.assign + write(*table.find(key), style);
    return out.empty() ? "{}" : style.open + out + style.close;
}

}  // namespace

std::string to_toml(const Value& value) { return write(value, toml); }

namespace {

bool is_given(const Place& place) { return place.column > 0; }

/// The given values of a table, without defaults.
Table given(const Table& table) {
    Table out;
    for (const auto& key : table.keys()) {
        const Value& value = *table.find(key);
        const Place place = table.place(key);
        if (const auto* inner = std::get_if<Table>(&value)) {
            Table part = given(*inner);
            if (is_given(place) || !part.keys().empty()) out.set(key, std::move(part), place);
        } else if (const auto* list = std::get_if<std::vector<Table>>(&value)) {
            std::vector<Table> parts;
            for (const Table& t : *list) parts.push_back(given(t));
            if (is_given(place) || !parts.empty()) out.set(key, std::move(parts), place);
        } else if (is_given(place)) {
            out.set(key, value, place);
        }
    }
    return out;
}

/// One line, or for a list of tables one per entry.
std::string scene_lines(const std::string& path, const Value& value) {
    const auto* list = std::get_if<std::vector<Table>>(&value);
    if (!list || list->empty()) return path + " = " + write(value, toml) + "\n";
    std::string out = path + " = [\n";
    for (const Table& t : *list) out += "    " + write(t, toml) + ",\n";
    return out + "]\n";
}

}  // namespace

std::string to_scene_text(const Table& root) {
    std::string out;
    const Table said = given(root);
    for (const auto& key : said.keys()) {
        const Value& value = *said.find(key);
        if (key != "effects") {
            out += scene_lines(key, value);
            continue;
        }
        for (const auto& effect : std::get<Table>(value).keys()) {
            const auto& table = std::get<Table>(*std::get<Table>(value).find(effect));
            if (table.keys().empty()) out += "effects." + effect + " = {}\n";
            for (const auto& inner : table.keys()) out += scene_lines("effects." + effect + "." + inner, *table.find(inner));
        }
    }
    return out;
}

std::string to_json(const Table& table) { return write(table, json); }

std::string to_toml(const Table& table) {
    std::string out;
    for (const auto& key : table.keys()) out += key + " = " + write(*table.find(key), toml) + "\n";
    return out;
}

}  // namespace weir::scene
