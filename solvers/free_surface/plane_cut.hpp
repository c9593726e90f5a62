// The volume fraction of a cell below a plane, the plane for a given fraction, and the part of that volume in a slab of the cell
// (Scardovelli & Zaleski 2000). The cell is the unit cube about 0, the liquid is {x : value + g·x < 0}.
#pragma once
#include "core/types.hpp"

#include <array>

namespace weir::free_surface {

/// Volume of {x in the unit cube about 0 : value + g·x < 0}. Inclusion and exclusion of corners (Scardovelli & Zaleski 2000).
template <int D>
real fraction_below_plane(real value, const Vec<D>& g);

/// The `value` of the plane with gradient g for the volume fraction `fraction` in (0, 1); g must not be zero.
template <int D>
real plane_with_fraction(real fraction, const Vec<D>& g);

/// Liquid volume in the slab of width `width` at the lower (end 0) or upper (end 1) side of the cell along an axis.
template <int D>
real liquid_in_slab(real value, Vec<D> g, int axis, int end, real width) {
    value += g[axis] * (end == 0 ? -0.5 * (1 - width) : 0.5 * (1 - width));
    g[axis] *= width;
    return width * fraction_below_plane(value, g);
}

}  // namespace weir::free_surface
