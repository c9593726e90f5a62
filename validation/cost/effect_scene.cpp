#include "validation/cost/effect_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace weir::validation {
namespace {

using scene::Key;
using scene::Type;
using Names = std::vector<std::string>;

constexpr real viscosity_of = 0.01;  // strength 0.1: an oil in a box of a metre

/// "<0.5>" becomes "[0.5, 0.5]".
std::string for_dim(std::string text, int dim) {
    for (auto open = text.find('<'); open != std::string::npos; open = text.find('<', open)) {
        const auto close = text.find('>', open);
        const std::string list =
            "[" + fmt::format("{}", fmt::join(Names(static_cast<std::size_t>(dim), text.substr(open + 1, close - open - 1)), ", ")) + "]";
        text.replace(open, close - open + 1, list);
    }
    return text;
}

/// A key of an effect: its strength, its example, or some value that it takes; empty where it may be left out.
std::string key_text(const Key& key, bool is_strength, real strength) {
    if (!is_strength && !key.required) return {};
    if (!is_strength && !key.example.empty()) return key.example;
    const real value = is_strength ? std::clamp(strength, key.min.value_or(strength), std::max(strength, key.max.value_or(strength))) : 0.5;
    switch (key.type) {
        case Type::number:
            return fmt::format("{} = {:g}", key.name, value);
        case Type::numbers:
            return key.length == -1 ? fmt::format("{} = <{:g}>", key.name, value) : fmt::format("{} = [{:g}]", key.name, value);
        case Type::integer:
            return fmt::format("{} = 1", key.name);
        case Type::choice:
            return fmt::format("{} = \"{}\"", key.name, key.choices.front());
        default:
            throw std::logic_error("the effects' key " + key.name + " needs an example");
    }
}

const scene::Variant& effect_of(const scene::SolverKind& kind, const std::string& name) {
    for (const scene::Variant& v : kind.schema.effects)
        if (v.name == name) return v;
    throw std::logic_error("solver " + kind.schema.name + " has no effect " + name);
}

std::string effect_text(const scene::Variant& effect, real strength) {
    Names keys;
    for (const Key& key : effect.keys) {
        const bool is_strength = std::find(effect.strength.begin(), effect.strength.end(), key.name) != effect.strength.end();
        if (std::string text = key_text(key, is_strength, strength); !text.empty()) keys.push_back(std::move(text));
    }
    return fmt::format("effects.{} = {{ {} }}\n", effect.name, fmt::join(keys, ", "));
}

scene::Scene make(const scene::SolverKind& kind, int dim, int cells, const Names& prepared_for, const Names& effects, real strength) {
    std::set<std::string> lines;  // two effects may need the same
    std::string viscosity;        // only where an effect reads it
    for (const Names& list : {prepared_for, effects})
        for (const std::string& name : list)
            if (const scene::Variant& effect = effect_of(kind, name); !effect.along_with.empty()) lines.insert(effect.along_with + "\n");
    std::string text = fmt::format("solver = \"{}\"\ndim = {}\ngrid = {{ cells = <{}>, size = <1.0> }}\ntime = {{ end = 1.0 }}\n",
                                   kind.schema.name, dim, cells);
    text += kind.plain.scene + "\n" + fmt::format("{}", fmt::join(lines, ""));
    for (const std::string& name : effects) {
        const scene::Variant& effect = effect_of(kind, name);
        text += effect_text(effect, strength);
        if (std::count(effect.strength.begin(), effect.strength.end(), "fluid.viscosity") > 0)
            viscosity = fmt::format("fluid.viscosity = {:g}\n", viscosity_of * strength);
    }
    if (!scene::is_without(kind.schema, "fluid")) text += "fluid.density = 1000.0\n" + viscosity;
    return scene::parse(for_dim(text, dim), kind.schema.name + ".toml", {kind.schema});
}

}  // namespace

scene::Scene plain_scene(const scene::SolverKind& kind, int dim, int cells, const Names& prepared_for) {
    return make(kind, dim, cells, prepared_for, {}, 0);
}

scene::Scene scene_with(const scene::SolverKind& kind, int dim, int cells, const Names& effects, real strength) {
    return make(kind, dim, cells, {}, effects, strength);
}

}  // namespace weir::validation
