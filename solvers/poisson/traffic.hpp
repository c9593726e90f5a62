// Estimate of what a solve sends in parallel.
#pragma once
#include "core/types.hpp"
#include "parallel/traffic.hpp"

#include <array>

namespace weir::poisson {

/// Counts the messages of one rank in a solve of `iterations` iterations by a distributed "multigrid", from a nonzero guess, with the
/// partition of the tally. `closed`: the fluid has no coupling to p = 0. Not counted: where the residual is recomputed unexpectedly, two
/// further messages and half a cycle.
template <int D>
void tally_multigrid(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, bool closed, int iterations,
                     Tally& tally);

/// Number of runs of fluid cells in a rank's own rows, all connected, and in the plane below its first.
struct Runs {
    std::size_t own = 0, below = 0;
};
/// Setup of "multigrid" with distributed storage, face weights and a coupling of the fluid to p = 0: counts one rank's messages for its
/// runs and for each level's matrix.
template <int D>
void tally_multigrid_setup(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, const Runs& runs,
                           Tally& tally);

}  // namespace weir::poisson
