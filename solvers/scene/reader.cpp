#include "scene/reader.hpp"

#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::scene {
namespace {

std::string join(const std::string& path, std::string_view key) {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

bool is_text_key(const Key& key) { return key.type == Type::text || key.type == Type::choice; }

}  // namespace

void Reader::report(Place place, std::string message, std::string hint, int width) {
    problems_.push_back({.file = file_, .place = place, .width = width, .message = std::move(message), .hint = std::move(hint)});
}

Table Reader::root(const Node& node, const std::vector<Key>& keys) {
    root_keys_ = &keys;
    return table(node, keys, "");
}

Table Reader::table(const Node& node, const std::vector<Key>& keys, const std::string& path) {
    Allowed allowed;
    for (const Key& key : keys) allowed.keys.push_back(&key);
    Table out;
    fill(node, allowed, path, out);
    return out;
}

void Reader::fill(const Node& node, const Allowed& allowed, const std::string& path, Table& out) {
    out.stands_in(folder_);
    for (const Member& member : node.members) {
        const auto key = std::find_if(allowed.keys.begin(), allowed.keys.end(), [&](const Key* k) { return k->name == member.key; });
        if (key == allowed.keys.end()) {
            if (!allowed.owner || member.key != allowed.owner->selector) unknown_key(member, allowed, path);
        } else if ((*key)->only_dim && dim_ && (*key)->only_dim != dim_) {
            report(member.place,
                   fmt::format("{} exists only in {}D; this scene has dim = {}", join(path, member.key), (*key)->only_dim, dim_));
        } else if (auto v = value(member.value, **key, join(path, member.key))) {
            out.set(member.key, std::move(*v), member.value.place);
        }
    }
    for (const Key* key : allowed.keys)
        if (!node.member(key->name) && !(key->only_dim && key->only_dim != dim_) && !misspelt(node, allowed, *key))
            absent(*key, node, join(path, key->name), path, out);
}

/// Returns whether an unknown key of this table was reported with this one as a suggestion: it is then not reported as missing.
bool Reader::misspelt(const Node& node, const Allowed& allowed, const Key& key) const {
    std::vector<std::string> names;
    for (const Key* k : allowed.keys) names.push_back(k->name);
    const auto known_name = [&](const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); };
    return key.required && std::any_of(node.members.begin(), node.members.end(),
                                       [&](const Member& m) { return !known_name(m.key) && nearest(m.key, names) == key.name; });
}

/// A key missing in the scene: its default, a table of defaults, or a problem.
void Reader::absent(const Key& key, const Node& around, const std::string& path, const std::string& owner_path, Table& out) {
    if (key.required) {
        if (!complete_) return;
        const bool fits = !(key.length == -1 && dim_ == 3) && !key.example.empty();  // examples are two-dimensional
        const std::string asks =
            fits ? fmt::format("{}, such as {}", expected(key, dim_), key.example) : fmt::format("{}: {}", key.name, expected(key, dim_));
        if (owner_path.empty())
            report({}, fmt::format("\"{}\" is missing", key.name), asks);
        else
            report(around.place, fmt::format("{} has no \"{}\"", owner_path, key.name), asks);
        return;
    }
    const bool optional_table = !key.selector.empty() && key.fallback.index() == 0;
    if (key.type == Type::table && !optional_table) {
        const bool needs_more = std::any_of(key.keys.begin(), key.keys.end(), [](const Key& k) { return k.required; });
        if (needs_more) return;
        Node empty;
        empty.place = {};
        if (auto t = table_of(empty, key, path)) out.set(key.name, std::move(*t), {});
    } else if (key.type == Type::named) {
        out.set(key.name, Table{}, {});
    } else if (key.type == Type::tables) {
        out.set(key.name, std::vector<Table>{}, {});
    } else if (key.fallback.index() != 0 && key.type != Type::table) {
        out.set(key.name, default_value(key), {});
    }
}

Value Reader::default_value(const Key& key) const {
    return std::visit(
        [&](const auto& v) -> Value {
            using T = std::decay_t<decltype(v)>;
            if constexpr (std::is_same_v<T, std::monostate>) {
                return false;
            } else if constexpr (std::is_same_v<T, std::vector<double>>) {
                if (key.length == -1 && v.size() == 1) return std::vector<double>(static_cast<std::size_t>(std::max(dim_, 2)), v[0]);
                return v;
            } else if constexpr (std::is_same_v<T, std::int64_t>) {
                if (key.type == Type::number) return static_cast<double>(v);
                return v;
            } else {
                return v;
            }
        },
        key.fallback);
}

std::optional<Value> Reader::value(const Node& node, const Key& key, const std::string& path) {
    switch (key.type) {
        case Type::numbers:
        case Type::integers:
        case Type::texts:
            return list(node, key, path);
        case Type::table:
            return table_of(node, key, path);
        case Type::tables:
            return tables(node, key, path);
        case Type::named:
            return named(node, key, path);
        case Type::any:
            return any(node, key, path);
        default:
            return scalar(node, key, path);
    }
}

std::optional<Value> Reader::scalar(const Node& node, const Key& key, const std::string& path) {
    using Kind = Node::Kind;
    if (key.type == Type::flag && node.kind == Kind::flag) return node.flag;
    if (is_text_key(key) && node.kind == Kind::text) {
        const auto& c = key.choices;
        if (c.empty() || std::find(c.begin(), c.end(), node.text) != c.end()) return node.text;
        unknown_choice(node, key, path);
        return std::nullopt;
    }
    if (key.type == Type::integer && node.kind == Kind::integer) {
        if (!in_range(static_cast<double>(node.integer), node, key, path)) return std::nullopt;
        return node.integer;
    }
    if (key.type == Type::number && (node.kind == Kind::integer || node.kind == Kind::number)) {
        const double v = node.kind == Kind::integer ? static_cast<double>(node.integer) : node.number;
        if (!in_range(v, node, key, path)) return std::nullopt;
        return v;
    }
    wrong_type(node, key, path);
    return std::nullopt;
}

/// Any value except a table; lists contain numbers or texts.
std::optional<Value> Reader::any(const Node& node, const Key& key, const std::string& path) {
    using Kind = Node::Kind;
    const auto as = [&](Type type) {
        Key one = key;
        one.type = type;
        return value(node, one, path);
    };
    switch (node.kind) {
        case Kind::flag:
            return as(Type::flag);
        case Kind::integer:
            return as(Type::integer);
        case Kind::number:
            return as(Type::number);
        case Kind::text:
            return as(Type::text);
        case Kind::list:
            return as(!node.list.empty() && node.list.front().kind == Kind::text ? Type::texts : Type::numbers);
        default:
            wrong_type(node, key, path);
            return std::nullopt;
    }
}

std::optional<Value> Reader::list(const Node& node, const Key& key, const std::string& path) {
    if (node.kind != Node::Kind::list) return wrong_type(node, key, path), std::nullopt;
    if (!right_length(node, key, path)) return std::nullopt;
    Key entry = key;
    entry.type = key.type == Type::numbers    ? Type::number
                 : key.type == Type::integers ? Type::integer
                 : key.choices.empty()        ? Type::text
                                              : Type::choice;
    std::vector<double> numbers;
    std::vector<std::string> texts;
    bool good = true;
    for (std::size_t i = 0; i < node.list.size(); ++i) {
        const auto v = scalar(node.list[i], entry, fmt::format("{}[{}]", path, i));
        if (!v)
            good = false;
        else if (const auto* text = std::get_if<std::string>(&*v))
            texts.push_back(*text);
        else
            numbers.push_back(std::holds_alternative<double>(*v) ? std::get<double>(*v) : static_cast<double>(std::get<std::int64_t>(*v)));
    }
    if (!good) return std::nullopt;
    if (key.type == Type::texts) return texts;
    return numbers;
}

std::optional<Table> Reader::table_of(const Node& node, const Key& key, const std::string& path) {
    if (!key.selector.empty()) return chosen(node, key, path);
    if (node.kind != Node::Kind::table) return wrong_type(node, key, path), std::nullopt;
    return table(node, key.keys, path);
}

/// A table with a selector: { shape = "sphere", ... }; or only its name, as a text.
std::optional<Table> Reader::chosen(const Node& node, const Key& key, const std::string& path) {
    const Node* name = &node;
    if (node.kind == Node::Kind::table) {
        const Member* selector = node.member(key.selector);
        name = selector ? &selector->value : nullptr;
    } else if (node.kind != Node::Kind::text) {
        return wrong_type(node, key, path), std::nullopt;
    }
    std::string choice = std::holds_alternative<std::string>(key.fallback) ? std::get<std::string>(key.fallback) : std::string();
    if (name && name->kind != Node::Kind::text) {
        wrong_type(*name, {.name = key.selector, .type = Type::text}, join(path, key.selector));
        return std::nullopt;
    }
    if (name) choice = name->text;
    if (!name && choice.empty()) {
        std::vector<std::string> names;
        for (const Variant& v : variants_of(key)) names.push_back(v.name);
        report(node.place, fmt::format("{} has no \"{}\"", path, key.selector), known(names));
        return std::nullopt;
    }
    Allowed allowed{.keys = {}, .owner = &key, .variant = find_variant(key, choice)};
    if (!allowed.variant) return unknown_variant(*name, key, choice, path), std::nullopt;
    for (const Key& k : allowed.variant->keys) allowed.keys.push_back(&k);
    for (const Key& k : key.keys) allowed.keys.push_back(&k);
    Table out;
    out.set(key.selector, choice, name ? name->place : Place{});
    fill(node, allowed, path, out);
    return out;
}

std::optional<Table> Reader::named(const Node& node, const Key& key, const std::string& path) {
    if (node.kind != Node::Kind::table) return wrong_type(node, key, path), std::nullopt;
    Table out;
    for (const Member& member : node.members) {
        const Variant* variant = find_variant(key, member.key);
        if (!variant)
            unknown_effect(member, key, path);
        else if (member.value.kind != Node::Kind::table)
            wrong_type(member.value, {.name = member.key, .type = Type::table}, join(path, member.key));
        else
            out.set(member.key, table(member.value, variant->keys, join(path, member.key)), member.value.place);
    }
    return out;
}

std::optional<Value> Reader::tables(const Node& node, const Key& key, const std::string& path) {
    if (node.kind != Node::Kind::list) return wrong_type(node, key, path), std::nullopt;
    std::vector<Table> out;
    for (std::size_t i = 0; i < node.list.size(); ++i) {
        Key one = key;
        one.type = Type::table;
        auto t = table_of(node.list[i], one, fmt::format("{}[{}]", path, i));
        out.push_back(t ? std::move(*t) : Table{});  // an empty table replaces an invalid one: rules refer to entries by index
    }
    if (key.required && node.list.empty()) report(node.place, fmt::format("{} is an empty list; it needs at least one entry", path));
    return out;
}

}  // namespace weir::scene
