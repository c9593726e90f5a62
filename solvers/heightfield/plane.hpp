// The columns of a height field: one along y for each place of the horizontal plane; on a line along x in 2D, on x and z in 3D.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace weir::heightfield {

/// Values of all columns, x fastest.
using Field = std::vector<real>;

struct Plane {
    int dim = 2;         // of the scene: 2 has one row of columns, a metre wide
    int nx = 0, nz = 1;  // columns
    real x0 = 0, z0 = 0, dx = 1, dz = 1;
    real floor = 0, ceiling = 0;  // of the domain along y [m]

    explicit Plane(const scene::Scene& scene) : dim(scene.dim()) {
        const auto n = scene.root().numbers("grid.cells"), size = scene.root().numbers("grid.size"),
                   origin = scene.root().numbers("grid.origin");
        nx = static_cast<int>(n[0]), x0 = origin[0], dx = size[0] / n[0];
        floor = origin[1], ceiling = origin[1] + size[1];
        if (dim == 3) nz = static_cast<int>(n[2]), z0 = origin[2], dz = size[2] / n[2];
    }
    std::size_t count() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(nz); }
    std::size_t at(int i, int k) const { return static_cast<std::size_t>(k) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i); }
    real x(int i) const { return x0 + (i + 0.5) * dx; }
    real z(int k) const { return dim == 3 ? z0 + (k + 0.5) * dz : 0; }
    real area() const { return dx * dz; }  // of a column [m^2]; in 2D per metre of depth [m]
    /// The grid as others see it: one cell along y.
    GridView view() const {
        GridView g{.dim = dim, .cells = {nx, 1, nz}, .origin = {x0, floor, z0}, .spacing = {dx, ceiling - floor, dz}};
        if (dim == 2) g.spacing[2] = 0;
        return g;
    }
};

}  // namespace weir::heightfield
