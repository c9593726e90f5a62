// The numbers of a scene that a session may turn while it runs: one knob each, components of lists by themselves.
#pragma once
#include "scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace weir::live {

struct Knob {
    std::string key;
    int component = -1;  // of a list
    std::vector<double> values;
    bool integer = false, is_list = false;
    std::optional<double> min, max;
    bool min_open = false;

    std::string name() const { return is_list ? key + '[' + std::to_string(component) + ']' : key; }
    double value() const { return values[is_list ? static_cast<std::size_t>(component) : 0]; }
};

class Knobs {
public:
    explicit Knobs(const scene::Scene& scene);
    bool empty() const { return knobs_.empty(); }
    const Knob& chosen() const { return knobs_[chosen_]; }
    void choose(int step);
    /// Up or down by a tenth of itself, of one where it is zero or part of a list, or by one where it counts; within what the schema
    /// allows. What to change; nothing at the end of the range.
    std::optional<scene::Override> turn(int direction);

private:
    std::vector<Knob> knobs_;
    std::size_t chosen_ = 0;
};

}  // namespace weir::live
