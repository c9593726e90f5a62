#include "sim/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace weir::sim {

Lattice Lattice::of_cells(const GridView& grid) {
    Lattice lattice;
    for (int a = 0; a < grid.dim; ++a) {
        const auto at = static_cast<std::size_t>(a);
        lattice.n[at] = grid.cells[at];
        lattice.spacing[at] = grid.spacing[at];
        lattice.first[a] = grid.origin[at] + 0.5 * grid.spacing[at];
    }
    return lattice;
}

Lattice Lattice::of_faces(const GridView& grid, int axis) {
    Lattice lattice = of_cells(grid);
    ++lattice.n[static_cast<std::size_t>(axis)];
    lattice.first[axis] = grid.origin[static_cast<std::size_t>(axis)];
    return lattice;
}

Lattice Lattice::of(const FieldView& field, const GridView& grid, int component) {
    return field.where == Where::face ? of_faces(grid, component) : of_cells(grid);
}

namespace {

/// Multilinear interpolation; `beyond` [cells]: distance of linear extrapolation past the outermost samples.
real multilinear(std::span<const real> values, const Lattice& lattice, const Vec<3>& x, real beyond) {
    std::array<int, 3> lower{}, upper{};
    std::array<real, 3> s{};
    for (std::size_t a = 0; a < 3; ++a) {
        const int last = lattice.n[a] - 1;
        const real out = last > 0 ? beyond : 0;
        const real place = std::clamp((x[a] - lattice.first[a]) / lattice.spacing[a], -out, last + out);
        lower[a] = std::clamp(static_cast<int>(std::floor(place)), 0, std::max(0, out > 0 ? last - 1 : last));
        upper[a] = std::min(lower[a] + 1, last);
        s[a] = place - lower[a];
    }
    const auto along_x = [&](int j, int k) {
        return (1 - s[0]) * values[lattice.linear({lower[0], j, k})] + s[0] * values[lattice.linear({upper[0], j, k})];
    };
    const auto along_y = [&](int k) { return (1 - s[1]) * along_x(lower[1], k) + s[1] * along_x(upper[1], k); };
    return (1 - s[2]) * along_y(lower[2]) + s[2] * along_y(upper[2]);
}

}  // namespace

real sample(std::span<const real> values, const Lattice& lattice, const Vec<3>& x) { return multilinear(values, lattice, x, 0); }

int plane_below(const Lattice& lattice, int axis, const Vec<3>& x) {
    const auto a = static_cast<std::size_t>(axis);
    const int last = lattice.n[a] - 1;
    const real out = last > 0 ? 0.5 : 0;
    const real place = std::clamp((x[a] - lattice.first[a]) / lattice.spacing[a], -out, last + out);
    return std::clamp(static_cast<int>(std::floor(place)), 0, std::max(0, last - 1));
}

real sample_to_wall(std::span<const real> values, const Lattice& lattice, const Vec<3>& x) { return multilinear(values, lattice, x, 0.5); }

real sample(const FieldView& field, const GridView& grid, int component, const Vec<3>& x) {
    return sample(field.data[static_cast<std::size_t>(component)], Lattice::of(field, grid, component), x);
}

Vec<3> upper_corner(const GridView& grid) {
    Vec<3> corner{};
    for (std::size_t a = 0; a < 3; ++a) corner[a] = grid.origin[a] + grid.cells[a] * grid.spacing[a];
    return corner;
}

real cell_volume(const GridView& grid) {
    real volume = 1;
    for (int a = 0; a < grid.dim; ++a) volume *= grid.spacing[static_cast<std::size_t>(a)];
    return volume;
}

}  // namespace weir::sim
