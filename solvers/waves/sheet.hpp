// The surface as a sheet of points over the cells of the horizontal axes, x fastest, and a model's result for one point. In 2D there is one
// row of points.
#pragma once
#include "core/types.hpp"
#include "parallel/grid.hpp"
#include "scene/scene.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace weir::waves {

/// The motion of the surface point with rest position (x, z): displacement, velocity, and derivatives of the horizontal displacement.
struct Motion {
    Vec<3> moved{};               // displacement [m]
    Vec<3> velocity{};            // [m/s]
    real xx = 0, zz = 0, xz = 0;  // derivatives of the horizontal displacement
    /// Relative area of a patch; negative where the surface is folded.
    real jacobian() const { return (1 + xx) * (1 + zz) - xz * xz; }
};

/// Cells of the scene's grid along the three axes; in 2D one cell along z.
struct Box {
    int dim = 2;
    std::array<int, 3> cells{1, 1, 1};
    Vec<3> origin{}, spacing{};
    OwnPlanes own{};  // rows of the sheet (z), in 2D layers of cells (y); all of them without a partition
    explicit Box(const scene::Scene& scene);
    /// The box with this rank's planes and their storage.
    Box(const scene::Scene& scene, const Partition& planes);
    int nx() const { return cells[0]; }
    int ny() const { return cells[1]; }
    int nz() const { return cells[2]; }
    std::size_t points() const { return static_cast<std::size_t>(nx()) * static_cast<std::size_t>(nz()); }
    /// This rank's rows of the sheet; in 2D its single row is replicated.
    OwnPlanes rows() const { return dim == 3 ? own : OwnPlanes{}; }
    /// This rank's layers of cells; in 3D all.
    PlaneRange layers() const { return dim == 3 ? PlaneRange{0, ny()} : PlaneRange{own.lower(0), own.upper(ny())}; }
    /// Extents of fields on the sheet and on the cells: entries per plane, and planes along the partitioned axis.
    Extent<2> of_sheet() const { return {{{nx(), nz()}}, rows()}; }
    Extent<2> of_cells() const { return {dim == 3 ? Index<2>{{nx() * ny(), nz()}} : Index<2>{{nx(), ny()}}, own}; }
    real x(int i) const { return origin[0] + (i + 0.5) * spacing[0]; }
    real y(int j) const { return origin[1] + (j + 0.5) * spacing[1]; }
    real z(int k) const { return dim == 3 ? origin[2] + (k + 0.5) * spacing[2] : 0; }
};

/// In parallel: partition of the sheet's rows (z), in 2D of the layers of cells in the water (y); none where these are fewer than ranks.
Partition partition_of_box(const Box& box, int ranks);

/// In parallel: returns whether fields can have distributed storage: not where whole fields are read on all ranks.
bool holds_own_planes(const scene::Scene& scene, const Partition& cut);

/// f(k) for this rank's rows of the sheet.
template <class F>
void for_own_rows(const Box& box, F&& f) {
    for_each_plane(box.rows(), 0, box.nz(), f);
}

/// f of every row of the sheet: sum in row order, and maximum.
template <class F>
real sum_of_rows(const Box& box, F&& f) {
    return plane_sum(box.rows(), box.nz(), f);
}
template <class F>
real most_of_rows(const Box& box, F&& f) {
    return plane_max(box.rows(), box.nz(), f);
}

/// Distributed storage in parallel (parallel/plane_store.hpp): rows of the sheet in 3D, layers of cells in 2D.
using Values = Grid<real, 2>;

/// The requested fields; others are empty.
struct Wanted {
    bool velocity = true;
    bool sideways = false;  // horizontal displacement and the Jacobian
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
