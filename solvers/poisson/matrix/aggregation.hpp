// Coarsening by pairing strongly coupled unknowns (Notay 2010; Napov & Notay 2012): unknowns without an open face between them never share
// an aggregate, for any geometry of walls.
#pragma once
#include "poisson/matrix/system.hpp"

namespace weir::poisson {

/// The aggregate of each unknown, −1 for one that only the smoother solves.
struct Aggregation {
    std::vector<int> of;
    int count = 0;
};

/// Pairs, pairs of pairs, and a third pass where many stayed single: aggregates of up to eight.
Aggregation aggregate(const Matrix& A);

/// Galerkin product with piecewise constant transfers: sums of the weights, and of the couplings to p = 0.
Matrix coarsen(const Matrix& A, const Aggregation& groups);

/// Sorts the entries of the last, unfinished row of C by column.
void sort_last_row(Matrix& C);

}  // namespace weir::poisson
