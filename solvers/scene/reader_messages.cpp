// The reader's message for each kind of error: what was found, what is allowed, and a suggestion.
#include "scene/names.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::scene {
namespace {

std::string with_unit(double value, const std::string& unit) {
    return unit.empty() ? number_text(value) : fmt::format("{} {}", number_text(value), unit);
}

std::string length_text(int length, int dim) {
    const int n = length == -1 ? dim : length;
    if (n > 0) return fmt::format("{} ", n);
    return length == -1 ? "2 or 3 " : "";
}

std::string solvers_have_it(const std::vector<std::string>& names) {
    return names.size() == 1 ? fmt::format("solver {} has it", quote_all(names)) : fmt::format("solvers {} have it", quote_all(names));
}

std::vector<std::string> variant_names(const std::vector<Variant>& variants) {
    std::vector<std::string> names;
    for (const Variant& v : variants) names.push_back(v.name);
    return names;
}

}  // namespace

std::string expected(const Key& key, int dim) {
    const std::string unit = key.unit.empty() ? "" : fmt::format(" [{}]", key.unit);
    const std::string n = length_text(key.length, dim);
    switch (key.type) {
        case Type::flag:
            return "true or false";
        case Type::integer:
            return "an integer" + unit;
        case Type::number:
            return "a number" + unit;
        case Type::text:
            return "a text";
        case Type::choice:
            return key.choices.size() > 4 ? "a text" : fmt::format("one of {}", quote_all(key.choices));
        case Type::numbers:
            return fmt::format("a list of {}numbers{}", n, unit);
        case Type::integers:
            return fmt::format("a list of {}integers{}", n, unit);
        case Type::texts:
            return fmt::format("a list of {}texts", n);
        case Type::table:
        case Type::named:
            return "a table";
        case Type::tables:
            return "a list of tables";
        case Type::any:
            return "a value";
    }
    return {};
}

std::string allowed_range(const Key& key) {
    if (key.min && key.max) {
        if (key.type == Type::integer && *key.max == *key.min + 1)
            return fmt::format("{} or {}", number_text(*key.min), number_text(*key.max));
        if (key.min_open) return fmt::format("greater than {} and at most {}", number_text(*key.min), with_unit(*key.max, key.unit));
        return fmt::format("between {} and {}", number_text(*key.min), with_unit(*key.max, key.unit));
    }
    if (key.min) return fmt::format("{} {}", key.min_open ? "greater than" : "at least", with_unit(*key.min, key.unit));
    if (key.max) return fmt::format("at most {}", with_unit(*key.max, key.unit));
    return {};
}

std::string found(const Node& node) {
    switch (node.kind) {
        case Node::Kind::flag:
            return node.flag ? "true" : "false";
        case Node::Kind::integer:
            return fmt::format("the integer {}", node.integer);
        case Node::Kind::number:
            return fmt::format("the number {}", number_text(node.number));
        case Node::Kind::text:
            return fmt::format("the text {}", quote(node.text));
        case Node::Kind::date:
            return "a date or time";
        case Node::Kind::list:
            return node.list.empty() ? "an empty list" : fmt::format("a list of {}", node.list.size());
        case Node::Kind::table:
            return "a table";
    }
    return {};
}

void Reader::wrong_type(const Node& node, const Key& key, const std::string& path) {
    std::string hint;
    const bool named_table = !key.selector.empty() && key.type == Type::table;
    if (key.type == Type::tables && node.kind == Node::Kind::table) hint = fmt::format("[[{}]] begins an entry of a list", path);
    if ((key.type == Type::number || key.type == Type::integer) && node.kind == Node::Kind::text) hint = "write a number without quotes";
    if (key.type == Type::flag && node.kind == Node::Kind::text) hint = "write true and false without quotes";
    if (hint.empty() && !key.example.empty() && !(key.length == -1 && dim_ == 3)) hint = "such as " + key.example;
    report(node.place,
           fmt::format("{} must be {}{}; found {}", path, expected(key, dim_),
                       named_table ? fmt::format(" with a \"{}\"", key.selector) : "", found(node)),
           hint);
}

bool Reader::in_range(double v, const Node& node, const Key& key, const std::string& path) {
    const auto range = allowed_range(key);
    if (!std::isfinite(v)) {
        report(node.place, fmt::format("{} is {}; it must be a finite number{}", path, number_text(v), range.empty() ? "" : ", " + range));
        return false;
    }
    const bool low = key.min && (key.min_open ? v <= *key.min : v < *key.min);
    const bool high = key.max && v > *key.max;
    if (low || high) report(node.place, fmt::format("{} is {}; it must be {}", path, with_unit(v, key.unit), range));
    return !low && !high;
}

bool Reader::right_length(const Node& node, const Key& key, const std::string& path) {
    const std::size_t n = node.list.size();
    const bool by_dim = key.length == -1;
    if (key.length == 0 || (by_dim && !dim_ && (n == 2 || n == 3))) return true;
    const auto wanted = static_cast<std::size_t>(by_dim ? dim_ : key.length);
    if (n == wanted && wanted > 0) return true;
    const std::string entries = n == 1 ? "1 entry" : fmt::format("{} entries", n);
    if (by_dim && dim_)
        report(node.place, fmt::format("{} has {}; with dim = {} it must have {}", path, entries, dim_, wanted));
    else
        report(node.place, fmt::format("{} has {}; it must have {}", path, entries, by_dim ? "2 or 3" : std::to_string(wanted)));
    return false;
}

std::vector<std::string> Reader::solvers_with(std::string_view key, bool effect) const {
    std::vector<std::string> names;
    if (!solvers_) return names;
    for (const SolverSchema& s : *solvers_) {
        const bool has_effect = std::any_of(s.effects.begin(), s.effects.end(), [&](const Variant& v) { return v.name == key; });
        if (s.name != solver_ && (effect ? has_effect : find_key(s.keys, key) != nullptr)) names.push_back(s.name);
    }
    return names;
}

void Reader::unknown_key(const Member& member, const Allowed& allowed, const std::string& path) {
    std::vector<std::string> names;
    if (allowed.owner) names.push_back(allowed.owner->selector);
    for (const Key* key : allowed.keys)
        if (!key->only_dim || !dim_ || key->only_dim == dim_) names.push_back(key->name);
    const std::string kind = allowed.variant ? fmt::format(" of {} {}", allowed.owner->selector, quote(allowed.name())) : "";

    std::vector<std::string> elsewhere;  // the same key in other variants of this table
    if (allowed.owner)
        for (const Variant& v : variants_of(*allowed.owner))
            if (find_key(v.keys, member.key)) elsewhere.push_back(v.name);
    if (!elsewhere.empty()) {
        const std::string has = elsewhere.size() == 1 ? fmt::format("{} {} has it", allowed.owner->selector, quote_all(elsewhere))
                                                      : fmt::format("{}s {} have it", allowed.owner->selector, quote_all(elsewhere));
        return report(member.place, fmt::format("{}{} has no {}; {}", path, kind, quote(member.key), has), known(names));
    }
    const std::string full = path.empty() ? member.key : path + "." + member.key;
    if (const SolverSchema* s = without(full); s && !s->why_without.empty())
        return report(member.place, fmt::format("solver \"{}\" does not support {}", solver_, full), s->why_without);
    if (const auto others = solvers_with(member.key, false); path.empty() && !others.empty()) {
        if (!solver_.empty())
            report(member.place, fmt::format("solver \"{}\" has no key \"{}\"; {}", solver_, member.key, solvers_have_it(others)),
                   known(names));
        return;
    }
    if (without(full)) return report(member.place, fmt::format("solver \"{}\" does not support {}", solver_, full), known(names));
    std::string meant = did_you_mean(member.key, names);
    if (const auto there = place_elsewhere(member.key); meant.empty() && !there.empty()) meant = fmt::format("; did you mean {}?", there);
    report(member.place, fmt::format("unknown key {}{}{}{}", quote(member.key), path.empty() ? "" : " in " + path, kind, meant),
           known(names));
}

/// The scene's solver, if it does not use the key.
const SolverSchema* Reader::without(std::string_view path) const {
    if (!solvers_) return nullptr;
    for (const SolverSchema& s : *solvers_)
        if (s.name == solver_ && is_without(s, path)) return &s;
    return nullptr;
}

/// A key that belongs to another table ("viscosity" at the top level is fluid.viscosity); empty where there is none.
std::string Reader::place_elsewhere(const std::string& key) const {
    if (!root_keys_) return {};
    for (const Key& table : *root_keys_) {
        if (table.type == Type::table && table.selector.empty() && find_key(table.keys, key)) return fmt::format("{}.{}", table.name, key);
        if (table.type == Type::named && find_variant(table, key)) return fmt::format("{}.{}", table.name, key);
    }
    return find_key(*root_keys_, key) ? fmt::format("{} outside of all tables", key) : std::string();
}

void Reader::unknown_choice(const Node& node, const Key& key, const std::string& path) {
    const auto dot = path.rfind('.');
    const bool entry = path.ends_with(']');
    const std::string around = entry ? path.substr(0, path.rfind('[')) : dot == std::string::npos ? "" : path.substr(0, dot);
    report(node.place,
           fmt::format("unknown {} {}{}{}", entry ? "entry" : key.name, quote(node.text), around.empty() ? "" : " in " + around,
                       did_you_mean(node.text, key.choices)),
           known(key.choices));
}

void Reader::unknown_variant(const Node& node, const Key& key, std::string_view name, const std::string& path) {
    const auto names = variant_names(variants_of(key));
    report(node.place, fmt::format("unknown {} {} in {}{}", key.selector, quote(name), path, did_you_mean(name, names)), known(names));
}

void Reader::unknown_effect(const Member& member, const Key& key, const std::string& path) {
    const auto names = variant_names(variants_of(key));
    const std::string noun = key.name.ends_with('s') ? key.name.substr(0, key.name.size() - 1) : key.name;
    const auto others = solvers_with(member.key, true);
    if (!solver_.empty() && !others.empty()) {
        report(member.place, fmt::format("solver \"{}\" has no {} {}; {}", solver_, noun, quote(member.key), solvers_have_it(others)),
               known(names));
    } else if (!solver_.empty() || !solvers_) {
        const std::string whose = solver_.empty() ? " in " + path : fmt::format(" for solver \"{}\"", solver_);
        report(member.place, fmt::format("unknown {} {}{}{}", noun, quote(member.key), whose, did_you_mean(member.key, names)),
               known(names));
    } else if (others.empty()) {
        report(member.place, fmt::format("unknown {} {}", noun, quote(member.key)));
    }
}

}  // namespace weir::scene
