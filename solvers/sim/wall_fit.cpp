#include "sim/wall_fit.hpp"

#include "parallel/communicator.hpp"
#include "sim/sampling.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace weir::sim {

namespace {

constexpr real reach = 2.6;    // spacings: two layers of samples along any direction, three along the axes
constexpr real contact = 1.5;  // spacings: liquid does not touch the wall where its nearest sample is farther away
constexpr real support = 4.0;  // spacings: range within which particles push on the wall
constexpr real window = 2.0;   // spacings: radius of the averaging window around the wall's point

template <int D>
struct Sample {
    Vec<D> offset;  // from the wall's point [spacings]
    real value, weight;
};

template <int D>
struct Wall {
    Vec<D> at;      // [m]
    Vec<D> normal;  // into the fluid
};

/// The wall's point nearest to x.
template <int D>
Wall<D> nearest_wall(const GridView& grid, const geometry::Solids<D>& solids, const Vec<D>& x) {
    Wall<D> best{x, {}};
    real nearest = infinity;
    for (int a = 0; a < D; ++a)
        for (const bool upper : {false, true}) {
            const real side = upper ? upper_corner(grid)[a] : grid.origin[static_cast<std::size_t>(a)];
            if (std::abs(x[a] - side) >= nearest) continue;
            nearest = std::abs(x[a] - side), best = {x, {}};
            best.at[a] = side, best.normal[a] = upper ? -1 : 1;
        }
    if (solids.empty() || std::abs(solids.distance(x)) >= nearest) return best;
    const real eps = 1e-3 * grid.spacing[0];  // for central differences of the normal: small beside a cell, large beside rounding
    const Vec<D> normal = solids.normal(x, eps);
    return {x - solids.distance(x) * normal, normal};
}

template <int D>
void add(std::vector<Sample<D>>& list, const Vec<D>& offset, real value) {
    const real r2 = dot(offset, offset) / (reach * reach);
    if (r2 < 1) list.push_back({offset, value, (1 - r2) * (1 - r2)});
}

/// Cells whose centres lie within `far` spacings of x along each axis.
template <int D>
std::pair<std::array<int, 3>, std::array<int, 3>> box_around(const Lattice& lattice, const Vec<D>& x, real far) {
    std::array<int, 3> lo{}, hi{1, 1, 1};
    for (int d = 0; d < D; ++d) {
        const auto a = static_cast<std::size_t>(d);
        const real place = (x[d] - lattice.first[d]) / lattice.spacing[a];
        lo[a] = std::max(0, static_cast<int>(std::ceil(place - far)));
        hi[a] = std::min(lattice.n[a], static_cast<int>(std::floor(place + far)) + 1);
    }
    return {lo, hi};
}

/// Centres of liquid cells within reach and outside solids (all cells are liquid where there is no level set). With distributed storage
/// each rank returns those of its planes: in rank order they are in the order of the grid.
template <int D>
std::vector<Sample<D>> cells_beside(const FieldSet& fields, const geometry::Solids<D>& solids, const Vec<D>& wall) {
    const GridView& grid = fields.grid;
    const Lattice lattice = Lattice::of_cells(grid);
    const auto pressure = fields.find("", "pressure")->data[0];
    const FieldView* level_set = fields.find(level_set_name);
    std::vector<Sample<D>> list;
    auto [lo, hi] = box_around(lattice, wall, reach);
    std::array<int, 3> I{};
    if (fields.cut) {
        lo[D - 1] = std::max(lo[D - 1], fields.cut->begin(communicator().rank()));
        hi[D - 1] = std::min(hi[D - 1], fields.cut->end(communicator().rank(), lattice.n[D - 1]));
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

/// Weight of a particle's pressure at the wall's point. Along the normal: the integral of Wendland's kernel (1995, C2, support of four
/// spacings) over a plane at the particle's distance. Along the wall: a window of two spacings.
constexpr real along_normal = support / 42;  // the integral of the first over the distance [spacings]
constexpr real in_window(real along2) { return along2 < 1 ? (1 - along2) * (1 - along2) : 0; }

template <int D>
real share_of_wall(const Vec<D>& offset, const Vec<D>& normal) {
    const real away = dot(offset, normal);
    if (away <= 0 || away >= support) return 0;
    const real u = 1 - away / support, u5 = u * u * u * u * u;
    return u5 * (1 - 1.5 * u + 4.0 / 7 * u * u) * in_window((dot(offset, offset) - away * away) / (window * window));
}

/// The window's integral over the part of the wall that borders on fluid [spacings^(D-1)]; the rest lies behind another wall.
template <int D>
real open_window(const GridView& grid, const geometry::Solids<D>& solids, const Wall<D>& wall) {
    constexpr int samples = 32;  // along an axis: an edge in between is located within a sixteenth of a spacing
    Vec<D> first{}, second{};    // along the wall
    if constexpr (D == 2) {
        first = {{-wall.normal[1], wall.normal[0]}};
    } else {
        Vec<D> across{};
        across[std::abs(wall.normal[0]) < 0.7 ? 0 : 1] = 1;
        first = across - dot(across, wall.normal) * wall.normal;
        first = (1 / std::sqrt(dot(first, first))) * first;
        const Vec<D>& n = wall.normal;
        second = {{n[1] * first[2] - n[2] * first[1], n[2] * first[0] - n[0] * first[2], n[0] * first[1] - n[1] * first[0]}};
    }
    const real h = grid.spacing[0], step = 2 * window / samples;
    const auto is_fluid = [&](const Vec<D>& x) {
        for (int a = 0; a < D; ++a)
            if (x[a] < grid.origin[static_cast<std::size_t>(a)] || x[a] > upper_corner(grid)[a]) return false;
        return solids.empty() || solids.distance(x) > 0;
    };
    real sum = 0;
    for (int j = 0; j < (D == 3 ? samples : 1); ++j)
        for (int i = 0; i < samples; ++i) {
            const real s = (i + 0.5) * step - window, t = D == 3 ? (j + 0.5) * step - window : 0;
            const real part = in_window((s * s + t * t) / (window * window));
            if (part > 0 && is_fluid(wall.at + h * (s * first + t * second + 0.5 * wall.normal))) sum += part;
        }
    return sum * step * (D == 3 ? step : 1);
}

/// The force of the particles per area of the wall around its point. Where the spray of a wave touches the wall with a few particles, these
/// push with their own pressure, without a gradient extrapolated to the wall. Behind a wall the pressure is extrapolated hydrostatically
/// (Adami, Hu & Adams 2012, eq. 27).
template <int D>
real force_of_particles(const FieldSet& fields, const geometry::Solids<D>& solids, const Wall<D>& wall) {
    // Sums over a lattice differ from the integral by less than this: above it sums are normalized, so a lattice at rest is exact.
    constexpr real full = 0.97;
    const auto& position = fields.find(particle_set_name, "position")->data;
    const auto pressure = fields.find(particle_set_name, "pressure")->data[0], density = fields.find(particle_set_name, "density")->data[0];
    real force = 0, filled = 0;
    for (std::size_t i = 0; i < pressure.size(); ++i) {
        Vec<D> offset;
        for (int d = 0; d < D; ++d)
            offset[d] = (position[static_cast<std::size_t>(d)][i] - wall.at[d]) / fields.grid.spacing[static_cast<std::size_t>(d)];
        real share = share_of_wall(offset, wall.normal);
        if (share == 0) continue;
        if (density[i] > 0) share *= fields.rest_density / density[i];  // the number of cells that it fills
        real carried_on = pressure[i];
        for (int d = 0; d < D; ++d) carried_on -= fields.weight[d] * offset[d] * fields.grid.spacing[static_cast<std::size_t>(d)];
        force += share * carried_on, filled += share;
    }
    if (filled == 0) return 0;
    return force / std::max(filled, full * along_normal * open_window(fields.grid, solids, wall));
}

/// The fit at the wall's point itself; the weighted mean where the samples do not determine a gradient.
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
    // where samples are coplanar or few, the normal gradient is undetermined: a pivot far below the weights in the matrix
    Eigen::FullPivLU<Eigen::Matrix<real, D + 1, D + 1>> lu(normal);
    lu.setThreshold(1e-6);
    return lu.isInvertible() ? lu.solve(right)[0] : right[0] / normal(0, 0);
}

}  // namespace

template <int D>
real wall_pressure(const FieldSet& fields, const geometry::Solids<D>& solids, const Vec<D>& at) {
    const Wall<D> wall = nearest_wall(fields.grid, solids, at);
    if (!fields.find("", "pressure")) return force_of_particles(fields, solids, wall);
    const auto list = cells_beside(fields, solids, wall.at);
    const bool wet = std::any_of(list.begin(), list.end(), [](const Sample<D>& s) { return dot(s.offset, s.offset) < contact * contact; });
    return wet ? fit(list) : 0;
}

template real wall_pressure(const FieldSet&, const geometry::Solids<2>&, const Vec<2>&);
template real wall_pressure(const FieldSet&, const geometry::Solids<3>&, const Vec<3>&);

}  // namespace weir::sim
