// What a solve sends over ranks, by formula.
#pragma once
#include "core/traffic.hpp"
#include "core/types.hpp"

#include <array>

namespace weir::poisson {

/// A solve of so many iterations by "multigrid" over ranks that share the planes, from a guess that is not 0: what a rank sends in it, to
/// the tally, whose cut is the grid's. `closed`: nothing joins the fluid to p = 0. Where the residual has to be found anew without the last
/// iteration having been expected to be it, that is two messages more, and half a cycle, which are not counted.
template <int D>
void tally_multigrid(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, bool closed, int iterations,
                     Tally& tally);

/// Runs of fluid cells of a rank's own rows, all joined, and of the plane below its first.
struct Runs {
    std::size_t own = 0, below = 0;
};
/// Setting up "multigrid" where each rank holds its own planes alone, with weights on faces and some of the fluid joined to p = 0: what a
/// rank sends of its runs and of each level's matrix.
template <int D>
void tally_multigrid_setup(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, const Runs& runs,
                           Tally& tally);

}  // namespace weir::poisson
