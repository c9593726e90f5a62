#include "scene/describe.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::scene {
namespace {

bool same(const std::vector<Key>& a, const std::vector<Key>& b);

bool same(const Key& a, const Key& b) {
    return a.name == b.name && a.doc == b.doc && value_text(a) == value_text(b) && default_text(a) == default_text(b) &&
           same(a.keys, b.keys);
}

bool same(const std::vector<Key>& a, const std::vector<Key>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Key& x, const Key& y) { return same(x, y); });
}

bool same(const std::vector<Variant>& a, const std::vector<Variant>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Variant& x, const Variant& y) { return x.name == y.name && x.doc == y.doc && same(x.keys, y.keys); });
}

void add_choice(OwnKeys& own, const std::string& path, const std::string& selector, const std::vector<Variant>& variants) {
    for (auto& choice : own.choices)
        if (same(choice.variants, variants)) return choice.paths.push_back(path);
    own.choices.push_back({{path}, selector, variants});
}

void collect(OwnKeys& own, const std::vector<Key>& keys, const std::vector<Key>& common, const std::string& path) {
    for (const Key& key : keys) {
        const Key* base = find_key(common, key.name);
        const Key full = base ? overlay({*base}, {key}).front() : key;
        const std::string name = path.empty() ? key.name : fmt::format("{}.{}", path, key.name);
        const bool chooses = !full.selector.empty();
        if (full.type == Type::table && !chooses) {
            collect(own, key.keys, base ? base->keys : std::vector<Key>{}, name);
            continue;
        }
        if (!base || !chooses || full.required != base->required) own.leaves.push_back({name, full});
        if (chooses && !variants_of(key).empty() && key.variants_from != &shapes) add_choice(own, name, full.selector, variants_of(key));
    }
}

}  // namespace

OwnKeys own_keys(const SolverSchema& solver) {
    OwnKeys own;
    collect(own, solver.keys, common_keys(), "");
    return own;
}

}  // namespace weir::scene
