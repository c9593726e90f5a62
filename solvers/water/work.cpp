// Estimated work of a step per plane of cells, for load balancing.
#include "geometry/liquid_fraction.hpp"
#include "parallel/load_balance.hpp"
#include "water/solver.hpp"

#include <cmath>

namespace weir::water {

namespace {

/// Nanoseconds per step: for every cell, additionally for a liquid cell, and additionally within `beside` cells of the surface. Least
/// squares over steps of one thread on 64^3 cells: boxes of liquid an eighth to three quarters of a tank deep along z, a quarter and half
/// of it along x, columns and cubes; FLIP, gravity, 6 iterations. The estimate is within 12% for nine tanks, except thin walls of liquid
/// across all rows (26% too low: the pressure is solved in blocks of cells of a row). Only the ratios matter for the partition.
constexpr real of_cell = 17, of_liquid = 480, of_surface = 390;
constexpr int beside = 3;

std::int64_t work(real cells, const geometry::PlaneOfLiquid& plane) {
    return std::llround(of_cell * cells + of_liquid * plane.wet + of_surface * plane.near);
}

/// The same for a level set: each rank counts the part that it stores, or its share of a whole one, and the counts are summed.
std::vector<geometry::PlaneOfLiquid> planes_of(const Checkpoint& state, std::size_t planes, std::size_t cells_of_plane, real near) {
    const auto held = state.held<real>("surface.phi");
    if (held.all != planes * cells_of_plane) return {};
    const auto here = held.part ? held : held.share(communicator().rank(), communicator().ranks());
    std::vector<real> phi(here.end - here.begin);
    state.get_part("surface.phi", std::span(phi), here.begin, here.all);
    std::vector<std::int64_t> counts(2 * planes, 0);  // wet, near
    for (std::size_t i = 0; i < phi.size(); ++i) {
        const std::size_t plane = (here.begin + i) / cells_of_plane;
        counts[plane] += phi[i] < 0;
        counts[planes + plane] += std::abs(phi[i]) < near;
    }
    const std::vector<std::int64_t> all = of_all_ranks(counts);
    std::vector<geometry::PlaneOfLiquid> list(planes);
    for (std::size_t i = 0; i < all.size(); ++i)
        (i / planes % 2 == 0 ? list[i % planes].wet : list[i % planes].near) += static_cast<real>(all[i]);
    return list;
}

template <int D>
std::vector<std::int64_t> work_in(const scene::Scene& scene, const Checkpoint* state) {
    const Lattice<D> lattice(scene);
    const auto planes = static_cast<std::size_t>(lattice.cells[D - 1]), cells_of_plane = product(lattice.cells) / planes;
    const real near = beside * *std::max_element(lattice.h.begin(), lattice.h.end());
    const auto liquid = state ? planes_of(*state, planes, cells_of_plane, near) : geometry::liquid_in_planes<D>(scene, near);
    std::vector<std::int64_t> list;
    for (const auto& plane : liquid) list.push_back(work(static_cast<real>(cells_of_plane), plane));
    return list;
}

}  // namespace

std::vector<std::int64_t> work_of_planes(const scene::Scene& scene, const Checkpoint* state) {
    return scene.dim() == 2 ? work_in<2>(scene, state) : work_in<3>(scene, state);
}

}  // namespace weir::water
