#include "scene/steer.hpp"

#include "scene/document.hpp"
#include "scene/names.hpp"
#include "scene/reader.hpp"
#include "scene/rules.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::scene {
namespace {

/// The steerable keys under `keys` whose tables exist in the scene.
void collect(const std::vector<Key>& keys, const Table& table, const std::string& path, std::vector<std::string>& out) {
    for (const Key& key : keys) {
        const std::string full = path.empty() ? key.name : path + "." + key.name;
        if (key.steerable) out.push_back(full);
        const Value* inner = table.find(key.name);
        const auto* t = inner ? std::get_if<Table>(inner) : nullptr;
        if (!t) continue;
        collect(key.keys, *t, full, out);
        if (key.type == Type::named)
            for (const Variant& v : variants_of(key))
                if (const Value* named = t->find(v.name)) collect(v.keys, std::get<Table>(*named), full + "." + v.name, out);
    }
}

/// The reason why a key is not steerable.
std::string reason(std::string_view path) {
    const std::string_view top = path.substr(0, path.find_first_of(".["));
    for (const char* key : {"solver", "dim", "grid"})
        if (top == key) return "the layout of the state depends on it";
    for (const char* key : {"initial", "liquid", "terrain"})
        if (top == key) return "it is read only at the start";
    for (const char* key : {"title", "probes", "output"})
        if (top == key) return "the output of a run is one series from start to end";
    return "data built for it, or computed from it, cannot be converted";
}

}  // namespace

const Key* key_at(const std::vector<Key>& keys, std::string_view path) {
    const std::string_view part = first_part(path);
    const Key* key = find_key(keys, part);
    if (!key || path.empty()) return key;
    if (key->type == Type::named) {
        const Variant* v = find_variant(*key, first_part(path));
        return v && !path.empty() ? key_at(v->keys, path) : nullptr;
    }
    return key_at(key->keys, path);
}

std::vector<TimedChange> changes_of(const Table& root) {
    std::vector<TimedChange> list;
    for (const Table& t : root.tables("changes")) {
        t.mark_read("value");
        list.push_back({t.number("time"), {t.text("key"), to_toml(*t.find("value"))}});
    }
    return list;
}

double end_after(double end, const std::vector<TimedChange>& changes) {
    for (std::size_t next = 0; next < changes.size() && changes[next].time < end; ++next)
        if (changes[next].what.key == "time.end") end = std::stod(changes[next].what.value);
    return end;
}

std::string why_not_steerable(const Table& root, const SolverSchema& solver, std::string_view path) {
    const auto keys = keys_of(solver);
    const Key* key = key_at(keys, path);
    if (key && key->steerable) {
        const auto dot = path.rfind('.');
        const std::string around(path.substr(0, dot == std::string_view::npos ? 0 : dot));
        return around.empty() || root.has(around) ? "" : fmt::format("{} is not named in this scene", around);
    }
    if (!key && !root.has(path)) return fmt::format("there is no such key{}", did_you_mean(path, steerable_keys(root, solver)));
    return reason(path);
}

std::vector<std::string> steerable_keys(const Table& root, const SolverSchema& solver) {
    std::vector<std::string> list;
    collect(keys_of(solver), root, "", list);
    return list;
}

void steer(Table& root, int dim, const SolverSchema& solver, const Override& change, int number, std::vector<Problem>& problems) {
    const auto report = [&](std::string message, std::string hint = "") {
        problems.push_back({.place = {0, 1, number}, .width = 1, .message = std::move(message), .hint = std::move(hint)});
    };
    if (const auto why = why_not_steerable(root, solver, change.key); !why.empty())
        return report(fmt::format("{} cannot change during a run: {}", change.key, why), known(steerable_keys(root, solver)));
    Node node;
    if (!override_value(change, number, node, problems)) return;
    const auto keys = keys_of(solver);
    std::vector<Problem> found;
    const auto value = Reader("", dim, true, found).one(node, *key_at(keys, change.key), change.key);
    problems.insert(problems.end(), found.begin(), found.end());
    if (!value) return;
    const auto dot = change.key.rfind('.');
    Table& around = dot == std::string::npos ? root : *root.find_table(change.key.substr(0, dot));
    around.set(dot == std::string::npos ? change.key : change.key.substr(dot + 1), *value, {0, 1, number});
    std::vector<Problem> broken;
    check_rules(root, dim, "", broken);
    for (auto& p : broken) report(std::move(p.message), std::move(p.hint));
}

void check_changes(const Table& root, int dim, const std::string& file, const SolverSchema& solver, std::vector<Problem>& problems) {
    if (!root.has("changes") || root.tables("changes").empty()) return;
    const auto& tables = root.tables("changes");
    Table then = root;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const Table& t = tables[i];
        if (!t.has("time") || !t.has("key") || !t.has("value")) continue;  // reported by the reader
        const auto at = [&](const char* key, std::string message, std::string hint = "") {
            problems.push_back({.file = file, .place = t.place(key), .message = std::move(message), .hint = std::move(hint)});
        };
        if (i > 0 && tables[i - 1].has("time") && t.number("time") < tables[i - 1].number("time"))
            at("time", fmt::format("changes[{}] is at {} s, before the previous one at {} s", i, number_text(t.number("time")),
                                   number_text(tables[i - 1].number("time"))));
        std::vector<Problem> wrong;
        const Override change{t.text("key"), to_toml(*t.find("value"))};
        const bool can = why_not_steerable(then, solver, change.key).empty();
        steer(then, dim, solver, change, 0, wrong);
        for (auto& p : wrong) at(can ? "value" : "key", std::move(p.message), std::move(p.hint));
    }
}

}  // namespace weir::scene
