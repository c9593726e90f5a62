// The first matrix of aggregates, and the next ones: weights between aggregates are half of the Galerkin sums along coarsened axes.
#pragma once
#include "poisson/geometric/level.hpp"
#include "poisson/geometric/light_components.hpp"
#include "poisson/geometric/phase_aggregates.hpp"

namespace weir::poisson {

/// The mean weight along each axis of faces between cells of the heavier phase, 0: none.
template <int D>
Vec<D> mean_heavy_weight(const Natural<D>& problem, const LightComponents& light);

/// Clusters of cells, and of the unknowns of a matrix; `floor` as in is_strong(), along each axis of the cells.
template <int D>
Clusters clusters_of_cells(const Natural<D>& problem, const PhaseUnknowns<D>& cells, const Vec<D>& floor);
template <int D>
Clusters clusters_of(const Matrix& A, const PhaseUnknowns<D>& at, real floor);

/// The matrix of aggregates of cells, or of unknowns of `fine`. Weights are rounded to single precision.
template <int D>
Matrix matrix_of_cells(const Natural<D>& problem, const Aggregation& groups, const std::array<bool, D>& halved);
template <int D>
Matrix matrix_of(const Matrix& fine, const PhaseUnknowns<D>& at, const Aggregation& groups, const std::array<bool, D>& halved);

}  // namespace weir::poisson
