// The surface as a sheet of points over the cells of the horizontal axes, x fastest, and what a model says of one of its points. In a scene
// of two dimensions there is one row of points.
#pragma once
#include "core/held_planes.hpp"
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace weir::waves {

/// What becomes of the point of the surface that rests at (x, z): where it is, how fast it moves, and how its neighbours were moved.
struct Motion {
    Vec<3> moved{};               // [m]
    Vec<3> velocity{};            // [m/s]
    real xx = 0, zz = 0, xz = 0;  // derivatives of the sideways displacement
    /// What became of a patch's area; negative where the surface is folded over.
    real jacobian() const { return (1 + xx) * (1 + zz) - xz * xz; }
};

/// Cells of the scene's grid along the three axes, in 2D one along z.
struct Box {
    int dim = 2;
    std::array<int, 3> cells{1, 1, 1};
    Vec<3> origin{}, spacing{};
    explicit Box(const scene::Scene& scene);
    int nx() const { return cells[0]; }
    int ny() const { return cells[1]; }
    int nz() const { return cells[2]; }
    std::size_t points() const { return static_cast<std::size_t>(nx()) * static_cast<std::size_t>(nz()); }
    /// Of a field on the sheet and of one on the cells: entries of a plane, and planes along the axis that ranks cut.
    Index<2> of_sheet() const { return {{nx(), nz()}}; }
    Index<2> of_cells() const { return dim == 3 ? Index<2>{{nx() * ny(), nz()}} : Index<2>{{nx(), ny()}}; }
    real x(int i) const { return origin[0] + (i + 0.5) * spacing[0]; }
    real y(int j) const { return origin[1] + (j + 0.5) * spacing[1]; }
    real z(int k) const { return dim == 3 ? origin[2] + (k + 0.5) * spacing[2] : 0; }
};

/// Over ranks: where the sheet's rows are cut (z), in 2D the layers of cells in the water (y); nowhere where these are fewer than ranks.
Cut cut_of_box(const Box& box, int ranks);

/// What of it is this rank's: the sheet's rows, its one row in 2D being everybody's, and the layers of cells, in 3D all.
PlaneRange own_rows(const Box& box);
PlaneRange own_layers(const Box& box);

/// f(k) for those rows.
template <class F>
void for_own_rows(const Box& box, F&& f) {
    const PlaneRange rows = own_rows(box);
    parallel_for(rows.begin, rows.end, f);
}

/// f of every row of the sheet: their sum in their order, and the largest.
template <class F>
real sum_of_rows(const Box& box, F&& f) {
    return box.dim == 2 ? ordered_sum(1, f) : plane_sum(box.nz(), f);
}
template <class F>
real most_of_rows(const Box& box, F&& f) {
    return box.dim == 2 ? ordered_max(1, f) : plane_max(box.nz(), f);
}

/// Over ranks that hold their own planes alone, those (core/plane_store.hpp): rows of the sheet in 3D, layers of cells in 2D.
using Values = Grid<real, 2>;

/// What of the surface is wanted; what is not has no values.
struct Wanted {
    bool velocity = true;
    bool sideways = false;  // displacement along x and z, and the Jacobian
};

struct Sheet {
    Values height;            // above the mean level [m]
    Values moved_x, moved_z;  // [m]
    Values jacobian;
    std::array<Values, 3> velocity{};  // [m/s]
    Sheet(const Box& box, const Wanted& wanted);
    std::size_t bytes() const;
};

}  // namespace weir::waves
