#include "sim/wall_fit.hpp"

#include "core/slabs.hpp"
#include "sim/sampling.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <vector>

namespace weir::sim {

namespace {

constexpr real reach = 2.6;    // spacings: two layers of samples along any direction, three along the axes
constexpr real contact = 1.5;  // spacings: liquid whose nearest sample is farther away does not touch the wall

template <int D>
struct Sample {
    Vec<D> offset;  // from the wall's point [spacings]
    real value, weight;
};

/// The wall's point nearest to x.
template <int D>
Vec<D> nearest_wall(const GridView& grid, const geometry::Solids<D>& solids, const Vec<D>& x) {
    Vec<D> best = x;
    real nearest = infinity;
    for (int a = 0; a < D; ++a)
        for (const real side : {grid.origin[static_cast<std::size_t>(a)], upper_corner(grid)[a]})
            if (std::abs(x[a] - side) < nearest) nearest = std::abs(x[a] - side), best = x, best[a] = side;
    if (solids.empty() || std::abs(solids.distance(x)) >= nearest) return best;
    const real eps = 1e-3 * grid.spacing[0];  // of the normal's central differences: small beside a cell, large beside rounding
    return x - solids.distance(x) * solids.normal(x, eps);
}

template <int D>
void add(std::vector<Sample<D>>& list, const Vec<D>& offset, real value) {
    const real r2 = dot(offset, offset) / (reach * reach);
    if (r2 < 1) list.push_back({offset, value, (1 - r2) * (1 - r2)});
}

/// Centres of cells within reach that hold liquid (all do, where there is no level set) and are outside solids. Where each rank holds its
/// own planes alone, each gives those of its planes: in the order of the ranks that is the order of the grid.
template <int D>
std::vector<Sample<D>> cells_beside(const FieldSet& fields, const geometry::Solids<D>& solids, const Vec<D>& wall) {
    const GridView& grid = fields.grid;
    const Lattice lattice = Lattice::of_cells(grid);
    const auto pressure = fields.find("", "pressure")->data[0];
    const FieldView* level_set = fields.find(level_set_name);
    std::vector<Sample<D>> list;
    std::array<int, 3> lo{}, hi{1, 1, 1}, I{};
    for (int d = 0; d < D; ++d) {
        const auto a = static_cast<std::size_t>(d);
        const real place = (wall[d] - lattice.first[d]) / lattice.spacing[a];
        lo[a] = std::max(0, static_cast<int>(std::ceil(place - reach)));
        hi[a] = std::min(lattice.n[a], static_cast<int>(std::floor(place + reach)) + 1);
    }
    if (fields.cut) {
        lo[D - 1] = std::max(lo[D - 1], fields.cut->begin(slabs().rank()));
        hi[D - 1] = std::min(hi[D - 1], fields.cut->end(slabs().rank(), lattice.n[D - 1]));
    }
    for (I[2] = lo[2]; I[2] < hi[2]; ++I[2])
        for (I[1] = lo[1]; I[1] < hi[1]; ++I[1])
            for (I[0] = lo[0]; I[0] < hi[0]; ++I[0]) {
                const std::size_t cell = lattice.linear(I);
                if (level_set && !(level_set->data[0][cell] < 0)) continue;
                const Vec<3> centre = lattice.position(I);
                Vec<D> x, offset;
                for (int d = 0; d < D; ++d) x[d] = centre[d], offset[d] = (x[d] - wall[d]) / lattice.spacing[static_cast<std::size_t>(d)];
                if (solids.empty() || solids.distance(x) > 0) add(list, offset, pressure[cell]);
            }
    return fields.cut ? of_all_ranks(list) : list;
}

template <int D>
std::vector<Sample<D>> particles_beside(const FieldSet& fields, const Vec<D>& wall) {
    const auto& position = fields.find(particle_set_name, "position")->data;
    const auto pressure = fields.find(particle_set_name, "pressure")->data[0];
    std::vector<Sample<D>> list;
    for (std::size_t i = 0; i < pressure.size(); ++i) {
        Vec<D> offset;
        for (int d = 0; d < D; ++d)
            offset[d] = (position[static_cast<std::size_t>(d)][i] - wall[d]) / fields.grid.spacing[static_cast<std::size_t>(d)];
        add(list, offset, pressure[i]);
    }
    return list;
}

/// The fit at the wall's point itself; the weighted mean where the samples do not tell a gradient.
template <int D>
real fit(const std::vector<Sample<D>>& list) {
    Eigen::Matrix<real, D + 1, D + 1> normal = Eigen::Matrix<real, D + 1, D + 1>::Zero();
    Eigen::Matrix<real, D + 1, 1> right = Eigen::Matrix<real, D + 1, 1>::Zero();
    for (const Sample<D>& s : list) {
        Eigen::Matrix<real, D + 1, 1> row;
        row[0] = 1;
        for (int d = 0; d < D; ++d) row[d + 1] = s.offset[d];
        normal += s.weight * row * row.transpose();
        right += s.weight * s.value * row;
    }
    // Where samples lie in one plane, or there are few, the gradient across it is not told: a pivot far below the weights in the matrix.
    Eigen::FullPivLU<Eigen::Matrix<real, D + 1, D + 1>> lu(normal);
    lu.setThreshold(1e-6);
    return lu.isInvertible() ? lu.solve(right)[0] : right[0] / normal(0, 0);
}

}  // namespace

template <int D>
real wall_pressure(const FieldSet& fields, const geometry::Solids<D>& solids, const Vec<D>& at) {
    const Vec<D> wall = nearest_wall(fields.grid, solids, at);
    const auto list = fields.find("", "pressure") ? cells_beside(fields, solids, wall) : particles_beside(fields, wall);
    const bool wet = std::any_of(list.begin(), list.end(), [](const Sample<D>& s) { return dot(s.offset, s.offset) < contact * contact; });
    return wet ? fit(list) : 0;
}

template real wall_pressure(const FieldSet&, const geometry::Solids<2>&, const Vec<2>&);
template real wall_pressure(const FieldSet&, const geometry::Solids<3>&, const Vec<3>&);

}  // namespace weir::sim
