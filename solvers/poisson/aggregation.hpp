// Coarsening by pairing strongly connected unknowns (Notay 2010; Napov & Notay 2012): two unknowns that no open face joins never meet in
// one aggregate, whatever the walls look like.
#pragma once
#include "poisson/system.hpp"

namespace weir::poisson {

/// aggregate of each unknown, −1 for one that the smoother alone solves.
struct Aggregation {
    std::vector<int> of;
    int count = 0;
};

/// Pairs, then pairs of pairs, and once more where many stayed alone: aggregates of up to eight.
Aggregation aggregate(const Matrix& A);

/// Galerkin product with piecewise constant transfers: sums of weights, and of what joins the unknowns to p = 0.
Matrix coarsen(const Matrix& A, const Aggregation& groups);

}  // namespace weir::poisson
