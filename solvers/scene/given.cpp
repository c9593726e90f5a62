#include "scene/given.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::scene {
namespace {

std::string join(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }
bool has_common_variants(const Key& key) {
    const auto& variants = variants_of(key);
    return !key.selector.empty() && !variants.empty() && (find_variant(key, "box") != nullptr || key.variants_from == &motions);
}
/// "emitters" for its own keys, "<box>" for those of its shape.
std::string of_variant(const Key& key, const std::string& schema, const std::string& variant) {
    return has_common_variants(key) ? "<" + variant + ">" : schema + "<" + variant + ">";
}

/// Walks through a table and its allowed keys.
class Walk {
public:
    explicit Walk(std::vector<GivenKey>& out) : out_(out) {}

    void table(const Table& t, const std::vector<Key>& keys, const std::string& path, const std::string& schema) {
        for (const auto& name : t.keys())
            if (const Key* key = find_key(keys, name)) value(t, *key, join(path, name), join(schema, name));
    }

private:
    void value(const Table& around, const Key& key, const std::string& path, const std::string& schema) {
        const Value& v = *around.find(key.name);
        if (const auto* inner = std::get_if<Table>(&v)) {
            key.type == Type::named ? named(*inner, key, path, schema) : chosen(*inner, key, path, schema);
        } else if (const auto* list = std::get_if<std::vector<Table>>(&v)) {
            for (std::size_t i = 0; i < list->size(); ++i) chosen((*list)[i], key, fmt::format("{}[{}]", path, i), schema);
        } else if (around.place(key.name).column > 0) {
            out_.push_back({path, schema, key.doc, around.was_read(key.name)});
        }
    }
    /// A table, with the keys of the selected variant, if any.
    void chosen(const Table& t, const Key& key, const std::string& path, const std::string& schema) {
        table(t, key.keys, path, schema);
        if (key.selector.empty() || !t.has(key.selector)) return;
        const std::string& name = std::get<std::string>(*t.find(key.selector));
        const std::string variant = of_variant(key, schema, name);
        if (t.place(key.selector).column > 0) out_.push_back({join(path, key.selector), variant, key.doc, t.was_read(key.selector)});
        if (const Variant* v = find_variant(key, name)) table(t, v->keys, path, variant);
    }
    void named(const Table& t, const Key& key, const std::string& path, const std::string& schema) {
        for (const Variant& v : variants_of(key)) {
            if (!t.has(v.name)) continue;
            out_.push_back({join(path, v.name), join(schema, v.name), v.doc, t.was_read(v.name)});
            table(std::get<Table>(*t.find(v.name)), v.keys, join(path, v.name), join(schema, v.name));
        }
    }

    std::vector<GivenKey>& out_;
};

void list_keys(const std::vector<Key>& keys, const std::string& schema, std::vector<std::string>& out) {
    const auto once = [&](const std::string& name) {
        const bool first = std::find(out.begin(), out.end(), name) == out.end();
        if (first) out.push_back(name);
        return first;
    };
    for (const Key& key : keys) {
        const std::string full = join(schema, key.name);
        const bool is_table = key.type == Type::table || key.type == Type::tables || key.type == Type::named;
        if (!is_table) once(full);
        list_keys(key.keys, full, out);
        for (const Variant& v : variants_of(key)) {
            const std::string variant = key.type == Type::named ? join(full, v.name) : of_variant(key, full, v.name);
            if (once(variant)) list_keys(v.keys, variant, out);
        }
    }
}

/// Keys of the run instead of the solver: the frame writers read them after the start.
bool is_read_by_writers(const std::string& path) {
    const auto known = {
        "title", "solver", "dim", "output.format", "output.fields", "output.faces", "output.precision", "output.compression"};
    return std::find(known.begin(), known.end(), path) != known.end() || path.starts_with("output.surface");
}

}  // namespace

std::vector<GivenKey> given_keys(const Scene& scene, const SolverSchema& schema) {
    std::vector<GivenKey> list;
    Walk(list).table(scene.root(), keys_of(schema), "", "");
    for (GivenKey& key : list) key.read = key.read || is_read_by_writers(key.path);
    return list;
}

std::vector<std::string> every_key(const SolverSchema& schema) {
    std::vector<std::string> list;
    list_keys(keys_of(schema), "", list);
    return list;
}

std::vector<Problem> ignored_keys(const Scene& scene, const SolverSchema& schema) {
    std::vector<Problem> problems;
    for (const GivenKey& key : given_keys(scene, schema))
        if (!key.read) problems.push_back(scene.problem(key.path, fmt::format("{} has no effect in this scene", key.path), key.doc));
    return problems;
}

}  // namespace weir::scene
