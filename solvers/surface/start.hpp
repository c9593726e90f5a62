// What a scene of liquid begins with, whatever solves for it: the level set of its shapes, the way up, and what no solver with a free
// surface takes.
#pragma once
#include "geometry/shape.hpp"
#include "geometry/solids.hpp"
#include "scene/scene.hpp"
#include "surface/level_set.hpp"

namespace weir::surface {

/// Longest over shortest edge of a cell up to which a free surface keeps its energy. Beyond, a splash has been seen to gain more than a
/// fifth of its energy (cases/hard_water): a surface that falls by several cells from one column to the next is not resolved across them.
inline constexpr real flattest_cell = 4;

template <int D>
void refuse_flat_cells(const scene::Scene& scene, const Frame<D>& frame);

/// The scene's solids; none where it names none.
template <int D>
geometry::Solids<D> solids_of(const scene::Scene& scene) {
    return geometry::Solids<D>(scene);
}

/// What the effect gravity says [m/s²]; none where the scene does not name it.
template <int D>
Vec<D> gravity_of(const scene::Scene& scene) {
    const auto* gravity = scene.effect("gravity");
    return gravity ? gravity->template vec<D>("g") : Vec<D>{};
}

/// The axis that gravity is most along, y without it.
template <int D>
int up_axis(const Vec<D>& g) {
    int up = 1;
    for (int a = 0; a < D; ++a)
        if (std::abs(g[a]) > std::abs(g[up])) up = a;
    return up;
}

/// φ of the free surface of a shape of liquid: distance to that part of the shape's boundary which is not a wall or a solid.
template <int D>
void start_level_set(const geometry::Shape<D>& liquid, const geometry::Solids<D>& solids, const Frame<D>& frame, LevelSet<D>& surface);

/// The schema of the effect volume_control: LevelSet::regain() in every step.
scene::Variant volume_control();

/// Says why shapes of liquid make none: they lie in solids, outside, or are thinner than a cell.
template <int D>
[[noreturn]] void refuse_no_volume(const scene::Scene& scene, const geometry::Shape<D>& liquid, const Frame<D>& frame);

}  // namespace weir::surface
