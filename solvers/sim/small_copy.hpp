// Scenes with fewer cells that are otherwise alike: built in their place where bytes or seconds per cell are measured.
#pragma once
#include "scene/scene.hpp"
#include "scene/solver_kind.hpp"

#include <string>
#include <vector>

namespace weir::sim {

double number_of_cells(const std::vector<double>& cells);
/// Number of boundary faces of the cells: ghosts and coarsest multigrid levels scale with it.
double number_of_boundary_faces(const std::vector<double>& cells);

/// How a copy is made smaller. similar: one factor for all axes, for particles. like_rows: rows of cells with similar padding and number of
/// halvings, for grids. like_columns: fewer columns of the same height, where columns are stored whole.
enum class Copy { similar, like_rows, like_columns };
/// The scene with about `cells` cells, in a box that contains the scene's own, with about the same part of it filled by liquid. Returns the
/// scene itself where it has no more cells than that.
scene::Scene small_copy(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, double cells, Copy how);

/// The liquid volume fraction: the part of the domain's cells whose centres lie in liquid and outside solids, from a sample.
double liquid_fraction(const scene::Scene& scene);

/// A pool that fills this part of the domain, including a partial layer of cells: the value of a scene's key "liquid".
std::string pool_text(const std::vector<double>& origin, const std::vector<double>& size, const std::vector<double>& cells, double part);

/// Largest ratio of width to height of a copy: tall cells reject domains longer than four times their thickness.
inline constexpr double widest_copy = 3.9;

}  // namespace weir::sim
