#include "scene/describe.hpp"

#include "core/error.hpp"
#include "scene/names.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace weir::scene {
namespace {

constexpr std::size_t line_width = 100;

/// Words of a text, wrapped and indented.
std::string wrapped(const std::string& text, std::size_t indent) {
    std::istringstream words(text);
    std::string out, word, line;
    const std::string margin(indent, ' ');
    while (words >> word) {
        if (!line.empty() && indent + line.size() + 1 + word.size() > line_width) out += margin + line + "\n", line.clear();
        line += (line.empty() ? "" : " ") + word;
    }
    return out + (line.empty() ? "" : margin + line + "\n");
}

std::string any_of(const std::vector<std::string>& names) {  // "a", "b" or "c"
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) out += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + quote(names[i]);
    return out;
}

std::string key_text(const Key& key, std::size_t indent) {
    const auto fallback = default_text(key);
    const bool table = key.type == Type::table || key.type == Type::tables || key.type == Type::named;
    std::string line = fmt::format("{}{}: {}", std::string(indent, ' '), key.name, value_text(key));
    if (key.required) line += "; required";
    if (!fallback.empty()) line += fmt::format("; {} if absent", fallback);
    if (key.only_dim) line += fmt::format("; only in {}D", key.only_dim);
    if (key.steerable) line += "; may change during a run";
    line += "\n" + wrapped(key.doc, indent + 4);
    if (table)
        for (const Key& k : key.keys) line += key_text(k, indent + 4);
    return line;
}

std::string names_text(const std::vector<Variant>& variants, std::size_t indent) {
    std::size_t longest = 0;
    for (const Variant& v : variants) longest = std::max(longest, v.name.size());
    std::string out;
    for (const Variant& v : variants) out += fmt::format("{}{:{}}  {}\n", std::string(indent, ' '), v.name, longest, v.doc);
    return out;
}

std::string variant_text(const Variant& variant) {
    std::string out = "\n" + wrapped(variant.doc, 4);
    if (variant.keys.empty()) out += "    It has no keys.\n";
    for (const Key& k : variant.keys) out += key_text(k, 4);
    return out;
}

/// A key without its name: with its nested keys, and the names of its variants.
std::string topic_key_text(const Key& key) {
    std::string out = key_text(key, 0).substr(key.name.size());
    if (key.selector.empty() || variants_of(key).empty()) return out;
    return out + fmt::format("    {} is one of\n", key.selector) + names_text(variants_of(key), 8);
}

std::string solver_text(const SolverSchema& solver) {
    std::string out = fmt::format("solver \"{}\", dim = {}\n", solver.name, fmt::join(solver.dims, " or "));
    out += wrapped(solver.doc, 4);
    const OwnKeys own = own_keys(solver);
    if (!own.leaves.empty()) out += "\nKeys of this solver, in addition to the common ones:\n";
    for (const auto& leaf : own.leaves) out += "    " + leaf.path + key_text(leaf.key, 4).substr(4 + leaf.key.name.size());
    for (const auto& choice : own.choices)
        out += fmt::format("\n{} of {}:\n", choice.selector, fmt::join(choice.paths, ", ")) + names_text(choice.variants, 4);
    if (!solver.effects.empty()) out += "\nIts effects:\n" + names_text(solver.effects, 4);
    return out;
}

std::string overview(const std::vector<SolverSchema>& solvers) {
    std::string out = "A scene is a TOML file. Units are SI; no effect is active by default.\n\nKeys of every scene:\n";
    const auto first_sentence = [](const std::string& doc) {
        return doc.substr(0, doc.find(". ") == std::string::npos ? doc.size() : doc.find(". ") + 1);
    };
    for (const Key& k : common_keys()) out += fmt::format("    {:9} {}\n", k.name, first_sentence(k.doc));
    out += "\nSolvers:\n";
    for (const SolverSchema& s : solvers) {
        if (s.study) continue;
        std::vector<std::string> effects;
        for (const Variant& e : s.effects) effects.push_back(e.name);
        out += fmt::format("    {:9} {}\n", s.name, first_sentence(s.doc));
        if (!effects.empty()) out += wrapped(fmt::format("effects: {}", fmt::join(effects, ", ")), 14);
    }
    out += "\nProblems of the validation suite, as solvers:\n";
    for (const SolverSchema& s : solvers)
        if (s.study) out += fmt::format("    {:14} {}\n", s.name, first_sentence(s.doc));
    return out + "\nweir describe NAME describes a solver, an effect, a key such as time.cfl, a shape or a motion.\n";
}

/// The solvers that have an effect with this text: "solver \"mac\"", "solvers \"mac\" and \"mac_water\"".
std::string solvers_with(const std::vector<SolverSchema>& solvers, const std::string& text) {
    std::vector<std::string> names;
    for (const SolverSchema& s : solvers)
        if (std::any_of(s.effects.begin(), s.effects.end(), [&](const Variant& e) { return variant_text(e) == text; }))
            names.push_back(s.name);
    return (names.size() == 1 ? "solver " : "solvers ") + quote_all(names);
}

/// Collects everything named like the topic, alone or as the last part of a path; each text once.
class Finder {
public:
    explicit Finder(std::string_view topic) : topic_(topic) {}

    void offer(const std::string& name, const std::string& title, const std::string& body) {
        names_.push_back(name);
        const bool meant = name == topic_ || name.ends_with("." + topic_);
        if (!meant || std::find(bodies_.begin(), bodies_.end(), body) != bodies_.end()) return;
        bodies_.push_back(body);
        text_ += (text_.empty() ? "" : "\n") + title + body;
    }
    void keys(const std::vector<Key>& keys, const std::string& path, const std::string& solver) {
        const std::string suffix = solver.empty() ? "" : fmt::format(" (solver \"{}\")", solver);
        for (const Key& key : keys) {
            const std::string full = path.empty() ? key.name : fmt::format("{}.{}", path, key.name);
            offer(full, full + suffix, topic_key_text(key));
            if (key.type != Type::named) {
                this->keys(key.keys, full, solver);
                for (const Variant& v : variants_of(key)) {
                    const bool shape = key.variants_from == &shapes;
                    offer(v.name, fmt::format("{} \"{}\"{}{}", key.selector, v.name, shape ? "" : " of " + full, suffix), variant_text(v));
                    if (!shape) this->keys(v.keys, full, solver);
                }
            }
        }
    }
    const std::vector<std::string>& names() const { return names_; }
    const std::string& text() const { return text_; }

private:
    std::string topic_, text_;
    std::vector<std::string> names_, bodies_;
};

}  // namespace

std::string default_text(const Key& key) {
    struct Visitor {
        std::string operator()(std::monostate) const { return {}; }
        std::string operator()(bool v) const { return v ? "true" : "false"; }
        std::string operator()(std::int64_t v) const { return std::to_string(v); }
        std::string operator()(double v) const { return number_text(v); }
        std::string operator()(const std::string& v) const { return quote(v); }
        std::string operator()(const std::vector<double>& v) const { return fmt::format("[{}]", fmt::join(v, ", ")); }
        std::string operator()(const std::vector<std::string>& v) const { return fmt::format("[{}]", fmt::join(v, ", ")); }
    };
    if (const auto* list = std::get_if<std::vector<double>>(&key.fallback); list && key.length == -1 && list->size() == 1)
        return fmt::format("all {}", number_text(list->front()));
    return std::visit(Visitor{}, key.fallback);
}

std::string value_text(const Key& key) {
    if (key.type == Type::choice) return any_of(key.choices);
    std::string text = expected(key, 0);
    const bool shared = key.variants_from == &shapes;
    if (key.length == -1 && text.find("2 or 3 ") != std::string::npos) text.replace(text.find("2 or 3 "), 7, "dim ");
    if (!key.selector.empty() && key.type == Type::table) text = shared ? "a shape" : fmt::format("a table with a {}", key.selector);
    if (!key.selector.empty() && key.type == Type::tables)
        text = shared ? "a list of shapes" : fmt::format("a list of tables, each with a {}", key.selector);
    if (const auto range = allowed_range(key); !range.empty()) text += ", " + range;
    if (key.type == Type::texts && !key.choices.empty()) text += " out of " + any_of(key.choices);
    return text;
}

std::string describe(std::string_view topic, const std::vector<SolverSchema>& solvers) {
    if (topic.empty()) return overview(solvers);
    Finder finder(topic);
    for (const SolverSchema& s : solvers) finder.offer(s.name, "", solver_text(s));
    for (const SolverSchema& s : solvers)
        for (const Variant& e : s.effects) {
            finder.offer(e.name, fmt::format("effect \"{}\" of {}", e.name, solvers_with(solvers, variant_text(e))), variant_text(e));
            finder.keys(e.keys, "effects." + e.name, "");
        }
    finder.keys(common_keys(), "", "");
    for (const SolverSchema& s : solvers) finder.keys(overlay(common_keys(), s.keys), "", s.name);
    if (finder.text().empty()) throw BadInput(fmt::format("unknown name {}{}", quote(topic), did_you_mean(topic, finder.names())));
    return finder.text();
}

}  // namespace weir::scene
