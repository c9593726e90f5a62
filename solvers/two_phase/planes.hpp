// Planes in cells: the interface of a mixed cell (piecewise-linear interface calculation). The cell is the unit cube [0, 1]^D, the liquid
// is {x : m·x < α}, Σ|m| = 1. Normals: mixed Youngs-centred (Aulisa et al. 2007). Cut volumes and their inverse: Scardovelli & Zaleski
// 2000, with powers factored so that a small component of m loses no digits.
#pragma once
#include "core/types.hpp"

#include <array>

namespace weir::two_phase {

/// A cell whose liquid fraction is within this distance of 0 or 1 has no plane.
inline constexpr real pure = 1e-12;
inline bool is_empty(real fraction) { return fraction <= pure; }
inline bool is_full(real fraction) { return fraction >= 1 - pure; }
inline bool is_mixed(real fraction) { return !is_empty(fraction) && !is_full(fraction); }

/// The liquid is {x in [0, 1]^D : m·x < alpha}; m points out of it.
template <int D>
struct Plane {
    Vec<D> m{};
    real alpha = 0;
};

/// Volume of {x in [0, 1]^D : m·x < alpha}, for components of any sign and sum.
template <int D>
real volume_below(Vec<D> m, real alpha);

/// alpha with volume_below(m, alpha) = fraction; m must not be zero.
template <int D>
real plane_constant(Vec<D> m, real fraction);

/// Distances in memory to the next cell along each axis.
template <int D>
using Strides = std::array<std::ptrdiff_t, D>;

/// The normal of a cell out of its liquid, Σ|m| = 1, from the fractions of 3^D cells; `f` points at the middle one.
template <int D>
Vec<D> normal_at(const real* f, const Strides<D>& stride);

/// The plane of a mixed cell.
template <int D>
Plane<D> plane_at(const real* f, const Strides<D>& stride);

/// The liquid fraction of the box [lo, hi] within a cell.
template <int D>
real fraction_of_box(const Plane<D>& plane, const Vec<D>& lo, const Vec<D>& hi);

/// The same for the slab of width `width` at the lower (end 0) or upper (end 1) side of the cell along an axis.
template <int D>
real fraction_of_slab(const Plane<D>& plane, int axis, int end, real width);

/// The same for any cell, with or without a plane.
template <int D>
real fraction_of_slab(const real* f, const Strides<D>& stride, int axis, int end, real width);

}  // namespace weir::two_phase
