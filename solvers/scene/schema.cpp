// Overlaying a solver's keys on the common ones, and look-ups in the schema.
#include "scene/schema.hpp"

#include "scene/names.hpp"

#include <algorithm>

namespace weir::scene {

const std::vector<Variant>& variants_of(const Key& key) { return key.variants_from ? key.variants_from() : key.variants; }

const Key* find_key(const std::vector<Key>& keys, std::string_view name) {
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == name; });
    return found == keys.end() ? nullptr : &*found;
}

const Variant* find_variant(const Key& key, std::string_view name) {
    const auto& list = variants_of(key);
    const auto found = std::find_if(list.begin(), list.end(), [&](const Variant& v) { return v.name == name; });
    return found == list.end() ? nullptr : &*found;
}

namespace {

std::vector<Variant> overlay_variants(std::vector<Variant> base, const std::vector<Variant>& more) {
    for (const Variant& v : more) {
        const auto same = std::find_if(base.begin(), base.end(), [&](const Variant& b) { return b.name == v.name; });
        if (same == base.end()) {
            base.push_back(v);
        } else {
            same->keys = overlay(same->keys, v.keys);
            if (!v.doc.empty()) same->doc = v.doc;
        }
    }
    return base;
}

/// Fields set in `more` replace those of `base`; the others are kept.
Key overlay_key(const Key& base, const Key& more) {
    if (base.type != more.type) return more;
    Key key = base;
    if (!more.doc.empty()) key.doc = more.doc;
    if (!more.unit.empty()) key.unit = more.unit;
    if (!more.choices.empty()) key.choices = more.choices;
    if (!more.example.empty()) key.example = more.example;
    if (more.fallback.index() != 0) key.fallback = more.fallback;
    if (more.min) key.min = more.min, key.min_open = more.min_open;
    if (more.max) key.max = more.max;
    if (more.only_dim) key.only_dim = more.only_dim;
    if (!more.selector.empty()) key.selector = more.selector;
    key.steerable = base.steerable || more.steerable;
    key.required = more.required || (base.required && more.fallback.index() == 0);
    key.keys = overlay(base.keys, more.keys);
    if (!variants_of(more).empty()) {
        key.variants = overlay_variants(variants_of(base), variants_of(more));
        key.variants_from = nullptr;
    }
    return key;
}

/// Removes the path from the keys, and from those of their variants.
void leave_out(std::vector<Key>& keys, std::string_view path) {
    const std::string_view part = first_part(path);
    if (path.empty()) {
        std::erase_if(keys, [&](const Key& k) { return k.name == part; });
        return;
    }
    for (Key& key : keys) {
        if (part != "*" && key.name != part) continue;
        leave_out(key.keys, path);
        auto variants = variants_of(key);
        bool had = false;
        for (Variant& v : variants) {
            const std::size_t before = v.keys.size();
            leave_out(v.keys, path);
            had = had || v.keys.size() != before;
        }
        if (had) key.variants = std::move(variants), key.variants_from = nullptr;
    }
}

}  // namespace

bool is_without(const SolverSchema& solver, std::string_view path) {
    return std::any_of(solver.without.begin(), solver.without.end(), [&](std::string_view without) {
        std::string_view rest = path;
        while (!without.empty() && !rest.empty()) {
            const std::string_view part = first_part(without), key = first_part(rest);
            if (part != "*" && part != key.substr(0, key.find('['))) return false;
        }
        return without.empty() && rest.empty();
    });
}

std::vector<Key> overlay(std::vector<Key> base, const std::vector<Key>& more) {
    for (const Key& key : more) {
        const auto same = std::find_if(base.begin(), base.end(), [&](const Key& b) { return b.name == key.name; });
        if (same == base.end())
            base.push_back(key);
        else
            *same = overlay_key(*same, key);
    }
    return base;
}

std::vector<Key> keys_of(const SolverSchema& solver) {
    auto keys = overlay(common_keys(), solver.keys);
    for (const auto& path : solver.without) leave_out(keys, path);
    keys.push_back({.name = "effects",
                    .type = Type::named,
                    .doc = "Forces, sources and other physics in addition to advection and pressure. An effect that is not named allocates "
                           "no field and runs no pass.",
                    .variants = solver.effects,
                    .example = "effects = { gravity = { g = [0.0, -9.81] } }"});
    return keys;
}

}  // namespace weir::scene
