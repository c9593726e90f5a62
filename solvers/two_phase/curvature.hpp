// Curvature of the interface, κ = ∇·n with n out of the liquid: positive on a drop. By height functions (Cummins, Francois & Kothe 2005;
// Popinet 2009) in columns of at most 11 cells that end in a full and an empty cell; elsewhere by a fitted paraboloid (fit.hpp).
#pragma once
#include "two_phase/fractions.hpp"

namespace weir::two_phase {

/// Where no curvature is known.
inline constexpr real no_curvature = infinity;

/// Cells of a column of heights on either side of the middle one.
inline constexpr int column_reach = 5;

/// What curvature is computed from: the fractions of cells, in a grid and with three layers of ghosts. In parallel the grid needs
/// column_reach ghost planes.
template <int D>
struct Interface {
    const Grid<real, D>& f;
    const Padded<D>& padded;
    const Around<D>& around;
    Vec<D> h;  // [m]
};

/// First and second derivatives of a height over one axis (y: none) or two.
struct Graph {
    real x = 0, y = 0, xx = 0, yy = 0, xy = 0;
};
/// −(h_xx (1 + h_y²) + h_yy (1 + h_x²) − 2 h_xy h_x h_y) / (1 + h_x² + h_y²)^(3/2)
inline real curvature_of(const Graph& g) {
    const real steep = 1 + g.x * g.x + g.y * g.y;
    return -(g.xx * (1 + g.y * g.y) + g.yy * (1 + g.x * g.x) - 2 * g.xy * g.x * g.y) / (steep * std::sqrt(steep));
}

/// A cell beside which tension acts: mixed, or full beside an empty one.
template <int D>
bool is_interfacial(const Padded<D>& f, const Index<D>& I);

/// Curvature by heights along the axis closest to the normal for which all columns end [1/m]; no_curvature where there is none.
template <int D>
real curvature_by_heights(const Interface<D>& interface, const Index<D>& I);

/// For cells whose heights fail. `mean` uses the mean of the neighbours instead of the fit; it exists to show its error in tests.
enum class WithoutHeights { fit, mean };

/// κ of all cells [1/m], and the part of it that heights and fits gave; no_curvature elsewhere.
template <int D>
struct Curvature {
    Grid<real, D> found, kappa;
    std::size_t bytes() const { return found.bytes() + kappa.bytes(); }
};

/// Of all interfacial cells. Cells where neither heights nor fit succeed get the mean of their neighbours.
template <int D>
void find_curvature(const Interface<D>& interface, WithoutHeights otherwise, Curvature<D>& result);

}  // namespace weir::two_phase
