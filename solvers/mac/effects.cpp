#include "mac/effects.hpp"

#include <algorithm>

namespace weir::mac {

const std::vector<EffectKind>& effect_kinds() {
    static const std::vector<EffectKind> kinds{gravity(), buoyancy(), confinement(), diffusion(), cooling(), decay(), viscosity()};
    return kinds;
}

std::vector<scene::Variant> effect_schemas(const std::vector<std::string>& names) {
    std::vector<scene::Variant> list;
    for (const auto& kind : effect_kinds())
        if (std::find(names.begin(), names.end(), kind.schema.name) != names.end()) list.push_back(kind.schema);
    return list;
}

template <int D>
Effects<MacState<D>> make_effects(const scene::Scene& scene) {
    Effects<MacState<D>> effects;
    for (const auto& kind : effect_kinds()) {
        const scene::Table* table = scene.effect(kind.schema.name);
        if (!table) continue;
        if constexpr (D == 2)
            effects.add(kind.schema.name, kind.make_2d(*table, scene));
        else
            effects.add(kind.schema.name, kind.make_3d(*table, scene));
    }
    return effects;
}

template Effects<MacState<2>> make_effects(const scene::Scene&);
template Effects<MacState<3>> make_effects(const scene::Scene&);

}  // namespace weir::mac
