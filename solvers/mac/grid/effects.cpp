#include "mac/grid/effects.hpp"

#include <utility>

namespace weir::mac {

std::vector<scene::Variant> schemas_of(const EffectKinds& kinds) {
    std::vector<scene::Variant> list;
    for (const auto& kind : kinds) list.push_back(kind.schema);
    return list;
}

template <int D>
Effects<MacState<D>> make_effects(const EffectKinds& kinds, const scene::Scene& scene, std::vector<Stage> runs) {
    Effects<MacState<D>> effects(scene.solver(), std::move(runs));
    for (const auto& kind : kinds) {
        const scene::Table* table = scene.effect(kind.schema.name);
        if (!table) continue;
        if constexpr (D == 2)
            effects.add(kind.schema.name, kind.make_2d(*table, scene));
        else
            effects.add(kind.schema.name, kind.make_3d(*table, scene));
    }
    return effects;
}

template Effects<MacState<2>> make_effects(const EffectKinds&, const scene::Scene&, std::vector<Stage>);
template Effects<MacState<3>> make_effects(const EffectKinds&, const scene::Scene&, std::vector<Stage>);

}  // namespace weir::mac
