// Curvature where heights fail: a paraboloid over the plane of a cell, fitted by least squares to the middles of the planes of 5^D cells
// (Renardy & Renardy 2002; Popinet 2009, section 5.1).
#pragma once
#include "two_phase/curvature.hpp"

namespace weir::two_phase {

/// The unit normal out of the liquid in physical space: that of the plane of a cell, or of the gradient in a full cell.
template <int D>
Vec<D> physical_normal(const Interface<D>& interface, const Index<D>& I);

/// The middle of the polygon (2D: segment) in which a plane cuts its cell, in [0, 1]^D. False where it does not.
template <int D>
bool middle_of_cut(const Plane<D>& plane, Vec<D>& middle);

/// Curvature [1/m], at most (D − 1)/h; no_curvature in cells without a plane or with too few neighbours.
template <int D>
real curvature_by_fit(const Interface<D>& interface, const Index<D>& I);

}  // namespace weir::two_phase
