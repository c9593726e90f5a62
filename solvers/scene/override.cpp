// `--set key=value`: a path of keys and list indices and a TOML value, applied to the scene's tree before it is checked. `bodies[:]=12`
// keeps the first twelve entries of a list.
#include "scene/document.hpp"
#include "scene/names.hpp"
#include "scene/reader.hpp"
#include "scene/source_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace weir::scene {

namespace {

struct Step {
    std::string key;
    int index = -1;  // of a list, or how_many; then `key` is empty
    int column = 0;  // in "key=value"
};

/// "[:]": the value is the number of entries to keep.
constexpr int how_many = -2;

bool is_key_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; }

/// Splits "solids[0].centre" into steps; returns an error message and its column, or an empty text.
std::string split(std::string_view path, std::vector<Step>& steps, int& column) {
    constexpr std::size_t max_steps = 16;
    std::size_t i = 0;
    while (true) {
        const std::size_t begin = i;
        while (i < path.size() && is_key_letter(path[i])) ++i;
        column = static_cast<int>(i) + 1;
        if (i == begin) return "a key is missing";
        steps.push_back({std::string(path.substr(begin, i - begin)), -1, static_cast<int>(begin) + 1});
        while (i < path.size() && path[i] == '[') {
            int index = -1;
            column = static_cast<int>(i) + 1;
            const auto close = path.find(']', i);
            if (close == std::string_view::npos) return "']' is missing";
            const auto [end, error] = std::from_chars(path.data() + i + 1, path.data() + close, index);
            if (path.substr(i, close + 1 - i) == "[:]") {
                if (close + 1 != path.size()) return "[:] ends a key";
                steps.push_back({"", how_many, static_cast<int>(i) + 1});
                return "";
            }
            if (error != std::errc() || end != path.data() + close || index < 0)
                return fmt::format("[{}] is not an index", path.substr(i + 1, close - i - 1));
            steps.push_back({"", index, static_cast<int>(i) + 1});
            i = close + 1;
        }
        column = static_cast<int>(i) + 1;
        if (i == path.size()) return steps.size() <= max_steps ? "" : "the key has too many parts";
        if (path[i] != '.') return fmt::format("unexpected {} in the key", quote(path.substr(i, 1)));
        ++i;
    }
}

bool is_bare_word(std::string_view value) {
    return !value.empty() && (std::isalpha(static_cast<unsigned char>(value[0])) || value[0] == '_') && value != "true" &&
           value != "false" && value != "inf" && value != "nan" && std::all_of(value.begin(), value.end(), is_key_letter);
}

/// Sets the position of every node of an override's value: a column of "key=value".
void stamp(Node& node, int number, int offset) {
    const auto moved = [&](Place p) { return Place{0, std::max(1, p.column + offset), number}; };
    node.place = moved(node.place);
    for (Node& n : node.list) stamp(n, number, offset);
    for (Member& m : node.members) m.place = moved(m.place), stamp(m.value, number, offset);
}

std::string beyond_list(const std::string& path, std::size_t n) {
    if (n == 0) return fmt::format("{} has no entries; [0] adds one", path);
    const std::string last = n == 1 ? "only [0]" : fmt::format("only [0] to [{}]", n - 1);
    return fmt::format("{} has {} entr{}; {} or, to add one, [{}] can be set", path, n, n == 1 ? "y" : "ies", last, n);
}

Node new_table(Place place) {
    Node node;
    node.place = place;
    return node;
}

}  // namespace

Override to_override(std::string_view text) {
    const auto equals = text.find('=');
    const auto trim = [](std::string_view s) {
        while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
        while (!s.empty() && s.back() == ' ') s.remove_suffix(1);
        return std::string(s);
    };
    if (equals == std::string_view::npos) throw BadInput(fmt::format("--set {}: '=' is missing; write --set key=value", text));
    Override change{trim(text.substr(0, equals)), trim(text.substr(equals + 1))};
    if (change.key.empty()) throw BadInput(fmt::format("--set {}: the key is missing; write --set key=value", text));
    return change;
}

bool override_value(const Override& change, int number, Node& value, std::vector<Problem>& problems) {
    const int value_column = count_characters(change.key) + 2;
    const auto refuse = [&](int column, const std::string& message) {
        problems.push_back({.place = {0, column, number}, .width = 1, .message = message});
        return false;
    };
    if (change.value.find_first_not_of(' ') == std::string::npos) return refuse(value_column, "the value is missing");
    std::string error;
    Place where;
    if (is_bare_word(change.value)) {
        value.kind = Node::Kind::text;
        value.text = change.value;
        value.place = {0, value_column, number};
    } else if (parse_value(change.value, value, error, where)) {
        stamp(value, number, value_column - 5);  // it was parsed after "v = "
    } else {
        return refuse(std::max(value_column, where.column + value_column - 5), error);
    }
    return true;
}

/// Keeps the first entries of a list; returns an error message, or an empty text.
std::string cut(Node& list, const std::string& path, const Node& keep) {
    if (list.kind != Node::Kind::list) return fmt::format("{} is {}, not a list", path, found(list));
    const auto entries = static_cast<std::int64_t>(list.list.size());
    if (keep.kind != Node::Kind::integer || keep.integer < 0 || keep.integer > entries)
        return fmt::format("{}[:] is the number of entries of {} to keep, from 0 to {}; found {}", path, path, entries, found(keep));
    list.list.resize(static_cast<std::size_t>(keep.integer));
    return "";
}

void apply_override(Node& root, const Override& change, int number, std::vector<Problem>& problems) {
    const auto refuse = [&](int column, const std::string& message, const std::string& hint = "") {
        problems.push_back({.place = {0, column, number}, .width = 1, .message = message, .hint = hint});
    };
    std::vector<Step> steps;
    int column = 1;
    if (const auto error = split(change.key, steps, column); !error.empty())
        return refuse(column, error, "a key looks like grid.cells or solids[0].centre");

    Node value;
    if (!override_value(change, number, value, problems)) return;

    Node* at = &root;
    std::string path;
    for (const Step& step : steps) {
        const Place place{0, step.column, number};
        if (step.index == how_many) {
            if (const auto error = cut(*at, path, value); !error.empty()) refuse(step.column, error);
            return;
        }
        if (step.index < 0) {
            if (at->kind != Node::Kind::table) return refuse(step.column, fmt::format("{} is {}, not a table", path, found(*at)));
            Member* member = at->member(step.key);
            if (!member) member = &at->members.emplace_back(Member{step.key, place, new_table(place)});
            member->place = place;
            at = &member->value;
            path += (path.empty() ? "" : ".") + step.key;
        } else {
            if (at->kind == Node::Kind::table && at->members.empty()) at->kind = Node::Kind::list;  // created by this path
            if (at->kind != Node::Kind::list) return refuse(step.column, fmt::format("{} is {}, not a list", path, found(*at)));
            if (step.index > static_cast<int>(at->list.size())) return refuse(step.column, beyond_list(path, at->list.size()));
            if (step.index == static_cast<int>(at->list.size())) at->list.push_back(new_table(place));
            at = &at->list[static_cast<std::size_t>(step.index)];
            path += fmt::format("[{}]", step.index);
        }
    }
    *at = value;
}

}  // namespace weir::scene
