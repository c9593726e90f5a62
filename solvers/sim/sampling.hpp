// Values of cell and face fields at points: multilinear interpolation; constant extrapolation past the outermost samples.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"

#include <array>
#include <span>

namespace weir::sim {

/// The sample positions of one component: n along each axis, the first at `first`. One sample along z in 2D.
struct Lattice {
    std::array<int, 3> n{1, 1, 1};
    Vec<3> first{};
    std::array<real, 3> spacing{1, 1, 1};
    /// Centres of cells.
    static Lattice of_cells(const GridView& grid);
    /// Centres of the faces across `axis`.
    static Lattice of_faces(const GridView& grid, int axis);
    static Lattice of(const FieldView& field, const GridView& grid, int component);
    std::size_t linear(const std::array<int, 3>& I) const {
        return static_cast<std::size_t>(I[0]) +
               static_cast<std::size_t>(n[0]) *
                   (static_cast<std::size_t>(I[1]) + static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(I[2]));
    }
    Vec<3> position(const std::array<int, 3>& I) const {
        return {{first[0] + spacing[0] * I[0], first[1] + spacing[1] * I[1], first[2] + spacing[2] * I[2]}};
    }
};

/// Interpolates the samples of a lattice at x.
real sample(std::span<const real> values, const Lattice& lattice, const Vec<3>& x);
/// The same, with linear extrapolation past the outermost samples: to the walls, half a cell away.
real sample_to_wall(std::span<const real> values, const Lattice& lattice, const Vec<3>& x);
/// The lower one of the two planes across an axis that are interpolated.
int plane_below(const Lattice& lattice, int axis, const Vec<3>& x);
/// One component of a cell or face field at x.
real sample(const FieldView& field, const GridView& grid, int component, const Vec<3>& x);
/// Upper corner of the domain [m].
Vec<3> upper_corner(const GridView& grid);
/// Volume of a cell [m^3]; per metre of depth in 2D [m^2].
real cell_volume(const GridView& grid);

}  // namespace weir::sim
