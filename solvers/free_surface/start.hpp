// Initial state of a scene with liquid, for all solvers with a free surface: the level set of its shapes, the upward axis, and unsupported
// keys.
#pragma once
#include "free_surface/level_set.hpp"
#include "geometry/shape.hpp"
#include "geometry/solids.hpp"
#include "scene/scene.hpp"

namespace weir::free_surface {

/// Largest aspect ratio of a cell for which a free surface keeps its energy. Beyond, a splash gained more than a fifth of its energy
/// (cases/hard_water): a surface that falls by several cells between adjacent columns is not resolved.
inline constexpr real flattest_cell = 4;

template <int D>
void refuse_flat_cells(const scene::Scene& scene, const Frame<D>& frame);

/// The scene's solids; empty where it has none.
template <int D>
geometry::Solids<D> solids_of(const scene::Scene& scene) {
    return geometry::Solids<D>(scene);
}

/// The acceleration of the effect gravity [m/s²]; zero where the scene does not have it.
template <int D>
Vec<D> gravity_of(const scene::Scene& scene) {
    const auto* gravity = scene.effect("gravity");
    return gravity ? gravity->template vec<D>("g") : Vec<D>{};
}

/// The axis closest to gravity; y without gravity.
template <int D>
int up_axis(const Vec<D>& g) {
    int up = 1;
    for (int a = 0; a < D; ++a)
        if (std::abs(g[a]) > std::abs(g[up])) up = a;
    return up;
}

/// φ of the free surface of a liquid shape: distance to the part of its boundary that is not a wall or a solid.
template <int D>
void start_level_set(const geometry::Shape<D>& liquid, const geometry::Solids<D>& solids, const Frame<D>& frame, LevelSet<D>& surface);

/// The schema of the effect volume_control: LevelSet::regain() in every step.
scene::Variant volume_control();

/// The reason why liquid shapes contain no liquid: they lie in solids, outside, or are thinner than a cell.
template <int D>
[[noreturn]] void refuse_no_volume(const scene::Scene& scene, const geometry::Shape<D>& liquid, const Frame<D>& frame);

}  // namespace weir::free_surface
