// Volumes of particles are spread by the quadratic B-spline of their spacing (the "triangular-shaped cloud" of Hockney & Eastwood 1981). On
// a lattice the weights sum to one for any position of the line, and to one half at the face of a half-space. So a plane surface is located
// exactly at any offset between the particles. Noise of their positions is averaged over three particles along each axis.
#include "sim/particle_surface.hpp"

#include "sim/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace weir::sim {

namespace {

constexpr real support = 1.5;           // of the spline [spacings]
constexpr int per_spacing = 16;         // samples of the profile; linear interpolation between them: error at most 1/16^2 / 8 of a spacing
constexpr int below = 2 * per_spacing;  // samples of the liquid below a surface: two layers, since a single layer is not full

/// u in spacings.
real spline(real u) {
    u = std::abs(u);
    return u < 0.5 ? 0.75 - u * u : u < support ? 0.5 * (support - u) * (support - u) : 0;
}

/// Weight of a particle at p for the line at x across one axis. Mirror images behind the sides of the domain represent the liquid that the
/// walls exclude.
real weight_across(real p, real x, real lower, real upper, real h) {
    return spline((p - x) / h) + spline((2 * lower - p - x) / h) + spline((2 * upper - p - x) / h);
}

/// Weight of particle m for the line through x along an axis.
real weight_of(const FieldSet& fields, const std::vector<std::span<const real>>& position, std::size_t m, const Vec<3>& x, int axis) {
    const GridView& grid = fields.grid;
    const Vec<3> upper = upper_corner(grid);
    real weight = 1;
    for (std::size_t a = 0; a < position.size() && weight > 0; ++a)
        if (static_cast<int>(a) != axis) weight *= weight_across(position[a][m], x[a], grid.origin[a], upper[a], grid.spacing[a]);
    return weight;
}

/// Density of the particles' volumes along the line; sample i lies at lower + i h / per_spacing.
std::vector<real> profile(const FieldSet& fields, const Vec<3>& x, int axis) {
    const auto& position = fields.find(particle_set_name, "position")->data;
    const GridView& grid = fields.grid;
    const auto along = static_cast<std::size_t>(axis);
    const int count = grid.cells[along] * per_spacing + 1;
    std::vector<real> density(static_cast<std::size_t>(count), 0);
    for (std::size_t m = 0; m < position[0].size(); ++m) {
        const real weight = weight_of(fields, position, m, x, axis);
        if (!(weight > 0)) continue;
        const real place = (position[along][m] - grid.origin[along]) / grid.spacing[along];
        const int first = std::max(0, static_cast<int>(std::ceil((place - support) * per_spacing)));
        const int last = std::min(count - 1, static_cast<int>(std::floor((place + support) * per_spacing)));
        for (int i = first; i <= last; ++i)
            density[static_cast<std::size_t>(i)] += weight * spline(static_cast<real>(i) / per_spacing - place);
    }
    return density;
}

/// Minimum count of particles on a line, within two spacings below a surface, that are liquid. It is the weight of one particle half a
/// spacing from the line along each other axis, without the ninth of its spline above the surface.
real least_count(int dim) { return 0.88 * std::pow(0.5, dim - 1); }

}  // namespace

real highest_of_particles(const FieldSet& fields, const Vec<3>& x, int axis) {
    const std::vector<real> density = profile(fields, x, axis);
    const auto along = static_cast<std::size_t>(axis);
    const real step = fields.grid.spacing[along] / per_spacing;
    for (auto i = static_cast<std::ptrdiff_t>(density.size()) - 1; i >= 0; --i) {
        const auto here = density.begin() + i, lowest = here - std::min<std::ptrdiff_t>(i, below);
        if (!(*here > 0)) continue;
        const real half = 0.5 * std::min(1.0, *std::max_element(lowest, here + 1));
        if (*here < half || std::accumulate(lowest, here + 1, 0.0) < per_spacing * least_count(fields.grid.dim)) continue;
        const real beyond = here + 1 == density.end() ? half : *(here + 1);  // the liquid ends at the end of the domain
        const real part = *here > half && beyond < half ? (*here - half) / (*here - beyond) : 0;
        return fields.grid.origin[along] + step * (static_cast<real>(i) + part);
    }
    return fields.grid.origin[along];
}

/// Sums the lengths of the particles near the line, with the same weights.
real depth_of_particles(const FieldSet& fields, const Vec<3>& x, int axis) {
    const auto& position = fields.find(particle_set_name, "position")->data;
    real depth = 0;
    for (std::size_t m = 0; m < position[0].size(); ++m) depth += weight_of(fields, position, m, x, axis);
    return depth * fields.grid.spacing[static_cast<std::size_t>(axis)];
}

}  // namespace weir::sim
