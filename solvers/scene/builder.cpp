// Scenes constructed in code, as the text of a scene file.
#include "scene/scene.hpp"

#include <algorithm>

namespace weir::scene {

Builder::Line& Builder::line(const std::string& key) {
    const auto at = std::find_if(lines_.begin(), lines_.end(), [&](const Line& l) { return l.key == key; });
    return at != lines_.end() ? *at : lines_.emplace_back(Line{key, {}, false});
}

Builder& Builder::set(const std::string& key, const Value& value) {
    line(key) = {key, to_toml(value), false};
    return *this;
}

Builder& Builder::set(const std::string& key, std::initializer_list<double> values) { return set(key, Value(std::vector<double>(values))); }

Builder& Builder::set(const std::string& key, const std::vector<std::string>& values) { return set(key, Value(values)); }

Builder& Builder::name(const std::string& key) {
    line(key) = {key, "{}", false};
    return *this;
}

Builder& Builder::add(const std::string& list, const Builder& entry) {
    std::string table;
    for (const Line& l : entry.lines_) table += (table.empty() ? "{ " : ", ") + l.key + " = " + (l.list ? "[ " + l.text + " ]" : l.text);
    table = table.empty() ? "{}" : table + " }";
    Line& l = line(list);
    l = {list, l.list ? l.text + ", " + table : table, true};
    return *this;
}

std::string Builder::text() const {
    std::string all;
    for (const Line& l : lines_) all += l.key + " = " + (l.list ? "[ " + l.text + " ]" : l.text) + "\n";
    return all;
}

Scene Builder::scene(const std::vector<SolverSchema>& solvers, const std::string& file) const { return parse(text(), file, solvers); }

}  // namespace weir::scene
