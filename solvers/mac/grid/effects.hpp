// Effects on the staggered grid. A kind is a schema and a factory; a solver is a list of kinds. One registration serves the scene's schema
// and the solver; an effect that no scene names allocates nothing.
#pragma once
#include "core/brush.hpp"
#include "core/effects.hpp"
#include "mac/grid/state.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace weir::mac {

template <int D>
using MacEffect = Effect<MacState<D>>;

/// An effect: its keys and its factory. `cfl` is the scene's, for limits that depend on it.
struct EffectKind {
    scene::Variant schema;
    std::function<std::unique_ptr<MacEffect<2>>(const scene::Table&, const scene::Scene&)> make_2d;
    std::function<std::unique_ptr<MacEffect<3>>(const scene::Table&, const scene::Scene&)> make_3d;
};

using EffectKinds = std::vector<EffectKind>;

/// Their schemas, in registry order: the order in which effects act in a stage.
std::vector<scene::Variant> schemas_of(const EffectKinds& kinds);

/// The effects of these kinds that the scene names, for a solver that runs these stages.
template <int D>
Effects<MacState<D>> make_effects(const EffectKinds& kinds, const scene::Scene& scene, std::vector<Stage> runs);

/// du/dt = g on every fluid.
EffectKind gravity();

/// The forces in the frame of a tank that rolls (geometry/rotating_frame.hpp), for solvers whose forces act at the end of a step.
EffectKind rotating_frame();

/// The kinds of interactive forcing in this scene: heat needs a substance, grab needs bodies.
std::initializer_list<BrushKind> kinds_of_brush(const scene::Scene& scene);
/// Density of a face's volume [kg/m³], of velocity component a.
template <int D>
using FaceDensity = std::function<real(int a, const Index<D>& I)>;
/// Interactive forcing (geometry/brush.hpp), applied at this stage. `density`: empty if it is that of the state everywhere.
template <int D>
std::unique_ptr<MacEffect<D>> brush_effect(std::shared_ptr<BrushForcing> forcing, Stage stage, FaceDensity<D> density = {});

/// Registers the two instantiations of one template.
template <template <int> class E>
EffectKind effect_kind(scene::Variant schema) {
    return {std::move(schema), [](const scene::Table& t, const scene::Scene& s) { return std::make_unique<E<2>>(t, s); },
            [](const scene::Table& t, const scene::Scene& s) { return std::make_unique<E<3>>(t, s); }};
}

/// Mean of a cell field on the lower face of I along a; on the sides of the domain the single adjacent cell.
template <int D>
real at_face(const Grid<real, D>& q, const Index<D>& I, int a) {
    const Index<D> below = I - e<D>(a);
    if (I[a] == 0) return q(I);
    if (I[a] == q.extent()[a]) return q(below);
    return 0.5 * (q(below) + q(I));
}

/// Step limit of a body force f [m/s²] from rest: the time in which the fluid moves by `cfl` cells, √(2 cfl h / f).
inline real acceleration_limit(real f, real h, real cfl) { return f > 0 ? std::sqrt(2 * cfl * h / f) : infinity; }

}  // namespace weir::mac
