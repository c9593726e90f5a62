// Loops over the samples of a field on the grid, and its values on lines: what metrics need of a finished run.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"
#include "parallel/partition.hpp"
#include "validation/harness/curve.hpp"

#include <algorithm>
#include <array>

namespace weir::validation {

/// f(x, weight, i) for each sample of one component of a field on the grid: cell centres (face_axis < 0), or faces across an axis, where
/// the two on the boundary weigh half; in these planes of the slowest axis.
template <class F>
void for_each_sample(const GridView& g, int face_axis, const PlaneRange& planes, F&& f) {
    std::array<int, 3> n = g.cells, lo{}, hi{};
    if (face_axis >= 0) ++n[static_cast<std::size_t>(face_axis)];
    hi = n;
    const auto slowest = static_cast<std::size_t>(std::max(1, g.dim) - 1);
    lo[slowest] = planes.begin, hi[slowest] = planes.end;
    auto i = static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(lo[1] + n[1] * lo[2]);
    for (int z = lo[2]; z < hi[2]; ++z)
        for (int y = lo[1]; y < hi[1]; ++y)
            for (int x = 0; x < n[0]; ++x, ++i) {
                const std::array<int, 3> at{x, y, z};
                Vec<3> position{};
                for (int d = 0; d < g.dim; ++d) {
                    const auto u = static_cast<std::size_t>(d);
                    position[d] = g.origin[u] + g.spacing[u] * (at[u] + (d == face_axis ? 0.0 : 0.5));
                }
                const bool end = face_axis >= 0 && (at[static_cast<std::size_t>(face_axis)] == 0 ||
                                                    at[static_cast<std::size_t>(face_axis)] == n[static_cast<std::size_t>(face_axis)] - 1);
                f(position, end ? 0.5 : 1.0, i);
            }
}

/// In all of them.
template <class F>
void for_each_sample(const GridView& g, int face_axis, F&& f) {
    const int axis = std::max(1, g.dim) - 1;
    for_each_sample(g, face_axis, {0, g.cells[static_cast<std::size_t>(axis)] + (face_axis == axis ? 1 : 0)}, f);
}

/// Volume of a cell [m^3]; in 2D per metre of depth.
real cell_volume(const GridView& g);
Vec<3> middle(const GridView& g);
/// Number of samples of a component along each axis.
std::array<int, 3> sample_counts(const GridView& g, int face_axis);
/// The value of sample (i, j, k).
real value_at(const FieldView& field, const GridView& g, int component, const std::array<int, 3>& I);

/// One component of a cell or face field along the line through `through` parallel to `axis`, at its own sample points: linear across.
Curve along_line(const FieldView& field, const GridView& g, int component, const Vec<3>& through, int axis);
/// The cubic through the four points of c nearest to `at`; c needs four points and ascending x.
real cubic(const Curve& c, real at);

/// Mean over the domain of |u|^2 / 2 [m^2/s^2].
real mean_kinetic_energy(const FieldSet& fields);
/// Largest |u| of any face [m/s]; where the solver shows a level set, of faces that touch liquid (those in air carry no fluid).
real max_speed(const FieldSet& fields);

}  // namespace weir::validation
