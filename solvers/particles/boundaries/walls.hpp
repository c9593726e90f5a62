// Walls in kernel sums: the part of a kernel behind a plane, as a function of the distance alone. It replaces sampled boundary particles
// (Akinci et al. 2012) for planes, and follows density maps (Koschier & Bender 2017) for shapes. It is exact for a plane and smooth, and
// needs no particles to sort or visit. It enters the density and the gradient.
#pragma once
#include "particles/state/kernels.hpp"

#include <array>
#include <vector>

namespace weir::particles {

inline constexpr int wall_terms = 14;
using WallSeries = std::array<real, wall_terms>;

/// Coefficients c of f(s) = u^2 sum_k c_k T_k(2 u - 1), u = 1 - s / h in [0, 1].
template <int D>
WallSeries behind_series(const Kernel<D>& kernel);
/// The same for the integral over the plane, minus d(behind)/ds.
template <int D>
WallSeries plane_series(const Kernel<D>& kernel);

}  // namespace weir::particles
