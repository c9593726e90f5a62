#include "thermo/ambient.hpp"

#include "scene/names.hpp"

#include <algorithm>

namespace weir::thermo {

using scene::Key;
using scene::Type;

namespace {

Key temperature_key(const char* doc) {
    return {.name = "temperature", .type = Type::number, .doc = doc, .unit = "K", .min = 0, .min_open = true};
}

/// Returns whether all keyframes give this value; throws for the first one without it where another has it.
bool all_say(const scene::Scene& scene, const std::vector<scene::Table>& frames, const char* what) {
    const auto says = [&](const scene::Table& frame) { return frame.has(what); };
    if (std::none_of(frames.begin(), frames.end(), says)) return false;
    for (std::size_t i = 0; i < frames.size(); ++i)
        if (!says(frames[i])) {
            const std::string path = "heat.ambient.keyframes[" + std::to_string(i) + "]";
            scene.refuse(path, path + " has no " + what + ", but other keyframes do", "give it in each keyframe, or in none");
        }
    return true;
}

Key ambient_key(const char* doc, const char* pressure_doc) {
    return {
        .name = "ambient",
        .type = Type::table,
        .doc = "The surroundings.",
        .keys = {temperature_key("Temperature of the surroundings, used by walls with an `exchange`."),
                 {.name = "keyframes",
                  .type = Type::tables,
                  .doc = doc,
                  .keys = {{.name = "t", .type = Type::number, .doc = "Time of the keyframe.", .unit = "s", .required = true},
                           temperature_key("Temperature of the surroundings."),
                           {.name = "pressure", .type = Type::number, .doc = pressure_doc, .unit = "Pa", .min = 0, .min_open = true}}}}};
}

}  // namespace

Key ambient_key() {
    return ambient_key("Temperature and pressure over time, interpolated linearly between keyframes.",
                       "Pressure of melting and boiling, instead of heat.pressure.");
}

Key ambient_key_of_particles() {
    return ambient_key("Temperature and pressure over time, interpolated linearly between keyframes.",
                       "Pressure of boiling, instead of heat.pressure. Only with heat.vapour; latent heats, heat capacities and the "
                       "melting point are those of the lowest pressure.");
}

Ambient::Ambient(const scene::Scene& scene) {
    pressure_ = {{0, scene.number("heat.pressure")}};
    if (!scene.has("heat.ambient")) return;
    const scene::Table& table = scene.root().table("heat.ambient");
    if (table.has("temperature")) temperature_ = {{0, table.number("temperature")}};
    if (!table.has("keyframes")) return;
    const auto& frames = table.tables("keyframes");
    for (std::size_t i = 1; i < frames.size(); ++i)
        if (!(frames[i].number("t") > frames[i - 1].number("t"))) {
            const std::string path = "heat.ambient.keyframes[" + std::to_string(i) + "].t";
            scene.refuse(path, path + " is " + scene::number_text(frames[i].number("t")) + " s; it must be after " +
                                   scene::number_text(frames[i - 1].number("t")) + " s of the previous keyframe");
        }
    const auto take = [&](std::vector<Frame>& list, const char* what) {
        if (frames.empty() || !all_say(scene, frames, what)) return;
        list.clear();
        for (const auto& frame : frames) list.push_back({frame.number("t"), frame.number(what)});
    };
    if (table.has("temperature") && !frames.empty() && frames[0].has("temperature"))
        scene.refuse("heat.ambient.temperature", "the keyframes already define a temperature", "give one of the two");
    take(temperature_, "temperature");
    take(pressure_, "pressure");
}

real Ambient::at(const std::vector<Frame>& frames, real t) {
    const auto next = std::find_if(frames.begin(), frames.end(), [&](const Frame& frame) { return frame.t > t; });
    if (next == frames.begin()) return next->value;
    const Frame& last = *(next - 1);
    if (next == frames.end()) return last.value;
    return last.value + (t - last.t) / (next->t - last.t) * (next->value - last.value);
}

real Ambient::lowest_pressure() const {
    return std::min_element(pressure_.begin(), pressure_.end(), [](const Frame& a, const Frame& b) { return a.value < b.value; })->value;
}
real Ambient::highest_pressure() const {
    return std::max_element(pressure_.begin(), pressure_.end(), [](const Frame& a, const Frame& b) { return a.value < b.value; })->value;
}

real Ambient::to_next_frame(real t) const {
    real least = infinity;
    for (const auto* frames : {&temperature_, &pressure_})
        for (const Frame& frame : *frames)
            if (t < frame.t * (1 - 1e-9)) least = std::min(least, frame.t - t);  // tolerance for a sum of rounded steps that ends there
    return least;
}

}  // namespace weir::thermo
