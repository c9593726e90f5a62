#include "validation/harness/variants.hpp"

#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::validation {

using scene::Problem;
using scene::Table;

void VariantReader::problem(scene::Place at, std::string message, std::string hint) {
    const auto same = [&](const Problem& p) { return p.place.line == at.line && p.place.column == at.column && p.message == message; };
    if (std::none_of(problems_.begin(), problems_.end(), same))  // what the file says for all is read again for each variant
        problems_.push_back({.file = file_, .place = at, .message = std::move(message), .hint = std::move(hint)});
}

std::string VariantReader::said(const Table& t, const std::string& key) {
    const std::string& text = t.text(key);
    if (text.find_first_not_of(" \t\n") == std::string::npos) problem(t.place(key), fmt::format("\"{}\" is empty", key));
    return text;
}

std::vector<real> VariantReader::numbers_of_size(const Table& t) const {
    return size_ == Size::ci && t.has("ci") ? t.numbers("ci") : t.numbers("values");
}

std::vector<Variant> VariantReader::over(const Table& t, const Variant& common, std::string_view names) {
    std::vector<Variant> chosen;
    for (const char* of : {"values", "ci"}) {  // both are read, so that a mistake is found at both sizes
        if (!t.has(of)) continue;
        std::vector<Variant> list;
        for (const std::string& value : t.texts(of)) {
            list.push_back(common);
            list.back().name = value;
            list.back().overrides.push_back({t.text("key"), value});
            check_name(t.place(of), list,
                       fmt::format("a value that is not a valid name requires an entry [[{}]] with name and set", names));
        }
        if (of == std::string("values") || size_ == Size::ci) chosen = std::move(list);
    }
    return chosen;
}

std::vector<Variant> VariantReader::read(const Table& root, std::string_view key, const More& more) {
    Variant common{.name = "", .scene = folder_ / "scene.toml"};
    merge(common, root, more);
    std::vector<Variant> list, of_size;
    if (root.has("over")) {
        list = of_size = over(root.table("over"), common, key);
        if (!root.tables(key).empty()) problem(root.table("over").place("key"), fmt::format("give [over] or [[{}]], not both", key));
    }
    for (const Table& t : root.tables(key)) {
        list.push_back(common);
        list.back().name = said(t, "name");
        check_name(t.place("name"), list);
        merge(list.back(), t, more);
        if (!t.has("size") || t.text("size") == name(size_)) of_size.push_back(list.back());
    }
    return list.empty() ? std::vector<Variant>{common} : of_size;
}

/// It names a folder and stands in figures: so no spaces, no slashes, no quotes.
void VariantReader::check_name(scene::Place at, const std::vector<Variant>& list, const std::string& hint) {
    const std::string& n = list.back().name;
    if (n.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+.") != std::string::npos)
        problem(at, fmt::format("variant name {} may have letters, digits and _ - + . only", scene::quote(n)), hint);
    if (n.empty() || n == "." || n == "..")
        problem(at, fmt::format("{} is not a valid name of a variant: it must be usable as a folder name", scene::quote(n)), hint);
    if (std::count_if(list.begin(), list.end(), [&](const Variant& v) { return v.name == n; }) > 1)
        problem(at, fmt::format("two variants are called {}", scene::quote(n)));
}

/// Lays what a table says over `v`: changes add up, the rest replaces.
void VariantReader::merge(Variant& v, const Table& t, const More& more) {
    if (t.has("scene")) v.scene = (folder_ / t.text("scene")).lexically_normal();
    if (t.has("reference")) v.reference = t.text("reference");
    if (t.has("sweep")) v.sweep = sweep(t.table("sweep"));
    add_changes(v, t);
    for (const std::string_view size : {"ci", "full"}) {
        if (!t.has(size)) continue;
        Variant sized = v;  // read at both sizes, so that a mistake is found at both
        add_changes(sized, t.table(size));
        sized.time_limit = t.table(size).number_or("time_limit", v.time_limit);
        if (size == name(size_)) v = sized;
    }
    if (more) more(v, t);
}

void VariantReader::add_changes(Variant& v, const Table& t) {
    if (!t.has("set")) return;
    for (const std::string& change : t.texts("set")) try {
            v.overrides.push_back(scene::to_override(change));
        } catch (const BadInput& wrong) {
            problem(t.place("set"), wrong.what());
        }
}

Sweep VariantReader::sweep(const Table& t) {
    Sweep s{.key = t.text("key"), .values = numbers_of_size(t), .axis = t.text("axis").front() - 'x'};
    if (t.has("keep"))
        for (const auto& axis : t.texts("keep")) s.keep.push_back(axis.front() - 'x');
    if (s.values.empty()) problem(t.place("values"), "a sweep needs at least one value");
    for (std::size_t i = 1; i < s.values.size(); ++i)  // a value names the run's folder and its published numbers
        if (std::find(s.values.begin(), s.values.begin() + static_cast<std::ptrdiff_t>(i), s.values[i]) !=
            s.values.begin() + static_cast<std::ptrdiff_t>(i))
            problem(t.place("values"), fmt::format("the sweep has the value {} twice", s.values[i]));
    for (const Table& also : t.tables("also")) {
        s.also.push_back({also.text("key"), numbers_of_size(also)});
        const std::size_t count = s.also.back().values.size();
        if (count != s.values.size())
            problem(also.place("key"), fmt::format("\"{}\" has {} values at {} size, the sweep has {}", s.also.back().key, count,
                                                   name(size_), s.values.size()));
    }
    return s;
}

}  // namespace weir::validation
