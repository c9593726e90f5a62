// The first matrix of aggregates, and the next ones: weights between aggregates are half of the Galerkin sums along coarsened axes.
#pragma once
#include "poisson/geometric/level.hpp"
#include "poisson/geometric/phase_aggregates.hpp"

namespace weir::poisson {

/// The cells as unknowns, and their clusters.
template <int D>
struct PhaseCells {
    PhaseUnknowns<D> unknowns;
    Clusters clusters;
    Vec<D> floor{};          // as in is_strong(), along each axis
    int light_clusters = 0;  // with a weight of at least a quarter of the largest: bubbles, pieces of thin films, the gas above the liquid
    std::size_t bytes() const { return unknowns.bytes() + clusters.bytes(); }
};

/// `light`: not 0 in cells of the lighter phase.
template <int D>
PhaseCells<D> find_phase_cells(const Natural<D>& problem, const std::uint8_t* light);
/// Clusters of the unknowns of a matrix.
template <int D>
Clusters clusters_of(const Matrix& A, const PhaseUnknowns<D>& at, real floor);

/// The matrix of aggregates of cells, or of unknowns of `fine`. Weights are rounded to single precision.
template <int D>
Matrix matrix_of_cells(const Natural<D>& problem, const Aggregation& groups, const std::array<bool, D>& halved);
template <int D>
Matrix matrix_of(const Matrix& fine, const PhaseUnknowns<D>& at, const Aggregation& groups, const std::array<bool, D>& halved);

}  // namespace weir::poisson
