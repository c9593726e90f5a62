// docs/scene.md: one table of keys per section, one section per top-level key, then shapes, motions, solvers and their effects.
#include "scene/describe.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>

namespace weir::scene {
namespace {

std::string escaped(std::string text) {  // '|' would end a cell
    for (auto at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
    return text;
}

std::string row(const Key& key, const std::string& path) {
    const auto fallback = default_text(key);
    const std::string absent = key.required ? "required" : fallback.empty() ? "" : fmt::format("`{}`", fallback);
    const std::string dim = key.only_dim ? fmt::format(" Only in {}D.", key.only_dim) : "";
    const char* steers = key.steerable ? " *May change during a run.*" : "";
    return fmt::format("| `{}` | {} | {} | {}{}{} |\n", path, escaped(value_text(key)), escaped(absent), escaped(key.doc), dim, steers);
}

/// One row per key; keys of nested tables without variants by their dotted names.
std::string rows(const std::vector<Key>& keys, const std::string& path) {
    std::string out;
    for (const Key& key : keys) {
        const std::string full = path.empty() ? key.name : fmt::format("{}.{}", path, key.name);
        const bool only_nested = key.type == Type::table && key.selector.empty() && !key.keys.empty();
        if (!only_nested) out += row(key, full);
        if (key.type == Type::table && key.selector.empty()) out += rows(key.keys, full);
        if (key.type == Type::tables && key.selector.empty()) out += rows(key.keys, full + "[]");
    }
    return out;
}

std::string key_table(const std::vector<Key>& keys) {
    const auto body = rows(keys, "");
    return body.empty() ? "" : "\n| key | value | if absent | meaning |\n|---|---|---|---|\n" + body;
}

std::string variant_section(const Variant& v, const std::string& level) {
    return fmt::format("\n{} `{}`\n{}\n{}", level, v.name, v.doc, key_table(v.keys));
}

std::string variants_section(const Key& key, const std::string& level) {
    std::string out;
    for (const Variant& v : variants_of(key)) out += variant_section(v, level);
    return out;
}

bool has_own_section(const Key& key) { return key.variants_from == &shapes || key.variants_from == &motions; }

/// The variants of a key's nested keys ("sides", "initial"): each once, even if several keys share them.
std::string nested_variants(const Key& key) {
    std::string out;
    const std::vector<Variant>* last = nullptr;
    for (const Key& k : key.keys) {
        if (k.selector.empty() || has_own_section(k) || &variants_of(k) == last) continue;
        const bool many = k.variants_from != nullptr;
        last = &variants_of(k);
        out += fmt::format("\nThe {} of {}:\n{}", k.selector, many ? "each" : fmt::format("`{}.{}`", key.name, k.name),
                           variants_section(k, "####"));
    }
    return out;
}

std::string top_section(const Key& key) {
    std::string out = fmt::format("\n### `{}`\n{}", key.name, key.doc);
    if (key.required) out += " Required.";
    out += "\n";
    if (!key.example.empty()) out += fmt::format("```toml\n{}\n```\n", key.example);
    out += key_table(key.keys) + nested_variants(key);
    if (!key.selector.empty() && !has_own_section(key)) out += variants_section(key, "####");
    if (key.variants_from == &shapes) out += "\nEach entry is a [shape](#shapes) with these additional keys.\n";
    return out;
}

/// Variants added by a solver, as a list: name, meaning, keys.
std::string choice_list(const OwnKeys::Choice& choice) {
    std::string paths;
    for (const auto& path : choice.paths) paths += (paths.empty() ? "`" : ", `") + path + "`";
    std::string out = fmt::format("\nA {} that {} may contain here:\n\n", choice.selector, paths);
    for (const Variant& v : choice.variants) {
        out += fmt::format("- `{}`{}\n", v.name, v.doc.empty() ? "" : ": " + v.doc);
        for (const Key& k : v.keys) {
            const auto fallback = default_text(k);
            const std::string absent = k.required ? "; required" : fallback.empty() ? "" : fmt::format("; `{}` if absent", fallback);
            out += fmt::format("  - `{}`, {}{}{}\n", k.name, value_text(k), absent, k.doc.empty() ? "" : ": " + k.doc);
        }
    }
    return out;
}

std::string solver_section(const SolverSchema& solver) {
    std::string out = fmt::format("\n### Solver `{}`\n{} Works with dim = {}.\n", solver.name, solver.doc, fmt::join(solver.dims, " or "));
    const OwnKeys own = own_keys(solver);
    if (!own.leaves.empty()) out += "\n| key | value | if absent | meaning |\n|---|---|---|---|\n";
    for (const auto& leaf : own.leaves) {
        out += row(leaf.key, leaf.path);
        if (leaf.key.selector.empty()) continue;
        out += rows(leaf.key.keys, leaf.path + (leaf.key.type == Type::tables ? "[]" : ""));  // common to all variants
    }
    for (const auto& choice : own.choices) out += choice_list(choice);
    if (!solver.without.empty())
        out += fmt::format("\nIt does not support `{}`, and refuses a scene that contains them.\n", fmt::join(solver.without, "`, `"));
    if (!solver.effects.empty()) out += fmt::format("\nEffects of `{}`:\n", solver.name);
    for (const Variant& effect : solver.effects) out += variant_section(effect, "####");
    return out;
}

constexpr const char* introduction = R"(# Scenes
<!-- Written by `weir describe --markdown`; do not edit. -->
A scene is a [TOML](https://toml.io) file that defines the initial state and the effects. Units are SI: metres, seconds, kilograms,
kelvins. No effect is active by default: an effect that is not named costs nothing. Lists called "dim numbers" have two entries in 2D
and three in 3D.

All errors in a file are reported together, each with its line, the allowed values, and the nearest known name; nothing is run or written.

Any key can be changed on the command line: `--set grid.cells=[64,64]`, `--set solids[0].radius=0.2`, `--set scheme.poisson.method=cg`.
`--set bodies[:]=3` keeps the first three entries of a list.

A table that only chooses a `shape`, a `kind` or a `name` may be given as that name: `sides.x_max = "outflow"`.

## Keys of every scene
)";

}  // namespace

std::string manual(const std::vector<SolverSchema>& solvers) {
    std::string out = introduction;
    std::vector<Key> plain;
    for (const Key& key : common_keys())
        if (key.type != Type::table && key.type != Type::tables) plain.push_back(key);
    out += key_table(plain);
    for (const Key& key : common_keys())
        if (key.type == Type::table || key.type == Type::tables) out += top_section(key);
    out += "\n## Shapes\nFor `liquid`, `solids` and `emitters`; a union or difference may contain any of them again.\n";
    for (const Variant& v : shapes()) out += variant_section(v, "###");
    out += "\n## Motions\nFor `solids`, as `motion = { kind = ... }`.\n";
    for (const Variant& v : motions()) out += variant_section(v, "###");
    out += "\n## Solvers\n";
    for (const SolverSchema& s : solvers)
        if (!s.study) out += solver_section(s);
    out += "\n## Problems of the validation suite\nThey measure one part of a method and are no solvers of flows.\n";
    for (const SolverSchema& s : solvers)
        if (s.study) out += solver_section(s);
    return out;
}

}  // namespace weir::scene
