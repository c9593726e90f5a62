// Effects on the staggered grid: a kind is a schema and a maker, and a solver is a list of kinds. One registration feeds the scene's schema
// and the solver; what no scene names allocates nothing.
#pragma once
#include "core/effects.hpp"
#include "core/hand.hpp"
#include "scene/scene.hpp"
#include "staggered/state.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace weir::staggered {

template <int D>
using MacEffect = Effect<MacState<D>>;

/// An effect: its keys, and what makes it from the scene's table. `cfl` is the scene's, for limits that depend on it.
struct EffectKind {
    scene::Variant schema;
    std::function<std::unique_ptr<MacEffect<2>>(const scene::Table&, const scene::Scene&)> make_2d;
    std::function<std::unique_ptr<MacEffect<3>>(const scene::Table&, const scene::Scene&)> make_3d;
};

using EffectKinds = std::vector<EffectKind>;

/// Their schemas, in registry order: the order in which effects act in a stage.
std::vector<scene::Variant> schemas_of(const EffectKinds& kinds);

/// Those of the kinds that the scene names, for a solver that runs these stages.
template <int D>
Effects<MacState<D>> make_effects(const EffectKinds& kinds, const scene::Scene& scene, std::vector<Stage> runs);

/// du/dt = g: acts on every fluid.
EffectKind gravity();

/// What a hand can do in this scene: it heats where a substance is named, and takes hold of bodies.
std::initializer_list<HandKind> kinds_of_hand(const scene::Scene& scene);
/// The hand (geometry/hand.hpp), which acts at this stage.
template <int D>
std::unique_ptr<MacEffect<D>> hand_effect(std::shared_ptr<Hand> hand, Stage stage);

/// Registers the two instantiations of one template.
template <template <int> class E>
EffectKind effect_kind(scene::Variant schema) {
    return {std::move(schema), [](const scene::Table& t, const scene::Scene& s) { return std::make_unique<E<2>>(t, s); },
            [](const scene::Table& t, const scene::Scene& s) { return std::make_unique<E<3>>(t, s); }};
}

/// Mean of a cell field on the face on the lower side of I along a; on the sides of the domain the one cell that there is.
template <int D>
real at_face(const Grid<real, D>& q, const Index<D>& I, int a) {
    const Index<D> below = I - e<D>(a);
    if (I[a] == 0) return q(I);
    if (I[a] == q.extent()[a]) return q(below);
    return 0.5 * (q(below) + q(I));
}

/// A body force f [m/s²] starts motion from rest: the step after which it has moved the fluid by `cfl` cells, √(2 cfl h / f).
inline real acceleration_limit(real f, real h, real cfl) { return f > 0 ? std::sqrt(2 * cfl * h / f) : infinity; }

}  // namespace weir::staggered
