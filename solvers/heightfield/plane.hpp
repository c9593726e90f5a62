// The columns of a height field: one along y for each cell of the horizontal plane; along x in 2D, on x and z in 3D. In parallel rows along
// x are distributed: the plane carries this rank's rows, and so do all fields and loops over it.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"
#include "parallel/grid.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace weir::heightfield {

/// Values of all columns, x fastest, in rows (parallel/plane_store.hpp).
using Field = Grid<real, 2>;

struct Plane {
    int dim = 2;         // of the scene: 2 has one row of columns, one metre wide
    int nx = 0, nz = 1;  // columns
    real x0 = 0, z0 = 0, dx = 1, dz = 1;
    real floor = 0, ceiling = 0;  // of the domain along y [m]
    OwnPlanes own{};              // rows; all of them unless the plane is of_rank

    explicit Plane(const scene::Scene& scene) : dim(scene.dim()) {
        const auto n = scene.root().numbers("grid.cells"), size = scene.root().numbers("grid.size"),
                   origin = scene.root().numbers("grid.origin");
        nx = static_cast<int>(n[0]), x0 = origin[0], dx = size[0] / n[0];
        floor = origin[1], ceiling = origin[1] + size[1];
        if (dim == 3) nz = static_cast<int>(n[2]), z0 = origin[2], dz = size[2] / n[2];
    }
    /// The plane with this rank's rows and their storage.
    Plane(const scene::Scene& scene, const Partition& rows);
    std::size_t count() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(nz); }
    Extent<2> extent() const { return {{{nx, nz}}, own}; }
    std::size_t at(int i, int k) const { return static_cast<std::size_t>(k) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i); }
    real x(int i) const { return x0 + (i + 0.5) * dx; }
    real z(int k) const { return dim == 3 ? z0 + (k + 0.5) * dz : 0; }
    real area() const { return dx * dz; }  // of a column [m^2]; in 2D per metre of depth [m]
    /// The grid for output: one cell along y.
    GridView view() const {
        GridView g{.dim = dim, .cells = {nx, 1, nz}, .origin = {x0, floor, z0}, .spacing = {dx, ceiling - floor, dz}};
        if (dim == 2) g.spacing[2] = 0;
        return g;
    }
};

/// Ghost rows on each side: as many as a stage of shallow water reads.
inline constexpr int rows_beside = 2;

/// Partition of the rows; none in 2D: a single row is replicated on every rank.
inline Partition partition_of_rows(const Plane& plane, int ranks) {
    return plane.dim == 3 ? equal_partition(plane.nz, ranks) : Partition{};
}

/// In parallel: returns whether rows have distributed storage: not where whole fields are read on all ranks.
bool holds_own_rows(const scene::Scene& scene, const Partition& cut);

/// This rank's rows and its ghost rows; all in one process.
std::vector<PlaneRange> rows_near(const Plane& plane);
/// The rows that this rank stores: those, or all without distributed storage.
std::vector<PlaneRange> rows_stored(const Plane& plane);

/// f(k) for these rows, threaded.
template <class F>
void for_each_row(const std::vector<PlaneRange>& of, F&& f) {
    for (const PlaneRange& rows : of) parallel_for(rows.begin, rows.end, f);
}

/// f(c) for their columns, serially.
template <class F>
void for_each_column(const Plane& plane, const std::vector<PlaneRange>& of, F&& f) {
    for (const PlaneRange& rows : of)
        for (std::size_t c = plane.at(0, rows.begin), end = plane.at(0, rows.end); c < end; ++c) f(c);
}

/// Integral of f over all columns, added row by row; in parallel over all ranks' rows.
template <class F>
real sum_of_columns(const Plane& plane, F&& f) {
    return plane.area() * plane_sum(plane.own, plane.nz, [&](int k) {
               real sum = 0;
               for (int i = 0; i < plane.nx; ++i) sum += f(plane.at(i, k));
               return sum;
           });
}

/// The smallest of the ranks' columns, each the first one found there; none: -1.
std::int64_t first_of_ranks(const Plane& plane, std::int64_t column);

}  // namespace weir::heightfield
