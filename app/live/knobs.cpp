#include "app/live/knobs.hpp"

#include "scene/steer.hpp"
#include "sim/registry.hpp"

#include <algorithm>
#include <cmath>

namespace weir::live {

Knobs::Knobs(const scene::Scene& scene) {
    const auto& schema = sim::kind_named(scene.solver()).schema;
    const auto keys = scene::keys_of(schema);
    for (const auto& path : scene::steerable_keys(scene.root(), schema)) {
        const scene::Value* value = scene.root().find(path);
        if (!value || path == "time.end") continue;
        const scene::Key& key = *scene::key_at(keys, path);
        Knob knob{.key = path,
                  .values = {},
                  .integer = key.type == scene::Type::integer,
                  .min = key.min,
                  .max = key.max,
                  .min_open = key.min_open};
        if (const auto* list = std::get_if<std::vector<double>>(value)) {
            knob.values = *list, knob.is_list = true;
            for (std::size_t c = 0; c < list->size(); ++c) knob.component = static_cast<int>(c), knobs_.push_back(knob);
        } else if (knob.integer || std::holds_alternative<double>(*value)) {
            knob.values = {scene.number(path)};
            knobs_.push_back(knob);
        }
    }
    const auto gravity =
        std::find_if(knobs_.begin(), knobs_.end(), [](const Knob& k) { return k.key == "effects.gravity.g" && k.component == 1; });
    if (gravity != knobs_.end()) chosen_ = static_cast<std::size_t>(gravity - knobs_.begin());
}

void Knobs::choose(int step) {
    if (empty()) return;
    const int n = static_cast<int>(knobs_.size());
    chosen_ = static_cast<std::size_t>(((static_cast<int>(chosen_) + step) % n + n) % n);
}

std::optional<scene::Override> Knobs::turn(int direction) {
    if (empty()) return std::nullopt;
    Knob& knob = knobs_[chosen_];
    const double was = knob.value();
    double largest = std::abs(was);
    if (knob.is_list)
        for (const double v : knob.values) largest = std::max(largest, std::abs(v));
    double now = knob.integer ? was + direction : was + direction * 0.1 * (largest > 0 ? largest : 1);
    if (!knob.integer && std::abs(now) < 1e-9 * largest) now = 0;
    if (knob.min && knob.min_open && now <= *knob.min) return std::nullopt;
    if (knob.min) now = std::max(now, *knob.min);
    if (knob.max) now = std::min(now, *knob.max);
    if (now == was) return std::nullopt;
    for (Knob& other : knobs_)
        if (other.key == knob.key) other.values[knob.is_list ? static_cast<std::size_t>(knob.component) : 0] = now;
    if (knob.is_list) return scene::Override{knob.key, scene::to_toml(scene::Value(knob.values))};
    if (knob.integer) return scene::Override{knob.key, scene::to_toml(scene::Value(static_cast<std::int64_t>(now)))};
    return scene::Override{knob.key, scene::to_toml(scene::Value(now))};
}

}  // namespace weir::live
