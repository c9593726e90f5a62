// Estimate of what a solve of the geometric multigrid sends in parallel. A cycle has one wavefront down and one up each distributed level,
// with one exchange between stages (v_cycle.hpp); the rest are sums over planes (geometric_cg.cpp).
#include "poisson/traffic.hpp"

#include "poisson/geometric/geometric_cg.hpp"

namespace weir::poisson {

namespace {

constexpr int exchanges_down = 4;      // of a colour, after all stages except the last: red, black, red, black
constexpr int exchanges_up = 4;        // after prolongation, black, red, black
constexpr int exchanges_up_first = 5;  // of the finest level, whose last half sweep includes the products

template <int D>
PlaneSize colour_of(const Level<D>& level) {
    const auto& at = level.at;
    return {sizeof(float) * static_cast<std::size_t>(at.rows_in_plane()) * static_cast<std::size_t>(at.stride), at.planes()};
}

/// The cycles of `iterations` iterations.
template <int D>
void tally_cycles(const std::vector<Level<D>>& levels, int iterations, Tally& tally) {
    for (std::size_t l = 0; l < levels.size() && !levels[l].cut.empty(); ++l) {
        const Level<D>&fine = levels[l], &coarse = levels[l + 1];
        const PlaneSize colour = colour_of(fine);
        const int exchanges = exchanges_down + (l == 0 ? exchanges_up_first : exchanges_up);
        tally.refresh(fine.cut, fine.at.periodic[D - 1], std::span(&colour, 1), 1, std::int64_t{exchanges} * iterations);
        if (coarse.cut.empty()) tally.gather(VCycle<D>::halved_cut(fine), colour_of(coarse), std::int64_t{2} * iterations);
    }
}

}  // namespace

template <int D>
void tally_multigrid(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, bool closed, int iterations,
                     Tally& tally) {
    const auto levels = cut_levels_of<D>(n, periodic, axis_weight, tally.cut());
    const int planes = n[D - 1], own = tally.cut().end(tally.rank(), planes) - tally.cut().begin(tally.rank());
    const auto rows = product(n) / static_cast<std::size_t>(n[0]) / static_cast<std::size_t>(planes);
    const PlaneSize cells{sizeof(real) * static_cast<std::size_t>(n[0]) * rows, planes}, number{sizeof(real), planes},
        sums{4 * sizeof(real), planes}, colour = colour_of(levels[0]);
    const auto tally_means = [&] {  // sums over runs of fluid cells, one per row
        if (closed)
            tally.everywhere(sizeof(real) * rows * static_cast<std::size_t>(own), 1,
                             sizeof(real) * rows * static_cast<std::size_t>(planes));
    };
    tally_means();         // of the right-hand side
    tally.gather(number);  // whether the pressure is 0
    tally.refresh({cells}, 1);
    tally.gather(sums);    // the first residual
    tally.gather(number);  // the norm of the right-hand side
    tally_cycles(levels, iterations, tally);
    tally.gather(sums, iterations);  // r·u, u·A u
    if (iterations > 0) {            // halo exchange of directions; in the last iteration of the pressure, for the true residual
        tally.refresh({colour, colour}, 1, iterations - 1);
        tally.refresh({cells}, 1);
        tally.gather(sums, iterations);
    }
    tally_means();
}

template <int D>
void tally_multigrid_setup(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, const Runs& runs,
                           Tally& tally) {
    const auto levels = cut_levels_of<D>(n, periodic, axis_weight, tally.cut());
    const auto ranks = static_cast<std::size_t>(tally.cut().ranks());
    const auto list = [&](std::size_t entries, std::size_t bytes) {  // list lengths of the ranks, and the lists
        tally.everywhere(sizeof(std::size_t), 1, sizeof(std::size_t) * ranks);
        tally.everywhere(entries * bytes, 1, entries * bytes * ranks);
    };
    tally.gather({sizeof(int) * static_cast<std::size_t>(D == 2 ? 1 : n[1]), n[D - 1]});  // runs in each row
    tally.everywhere(runs.own * sizeof(Run), 1, runs.own * sizeof(Run) * ranks);
    list(runs.own + runs.below > 0 ? runs.own + runs.below - 1 : 0, 2 * sizeof(int));  // pairs that are connected
    list(runs.own > 0 ? 1 : 0, sizeof(int));                                           // runs connected to p = 0
    for (std::size_t l = 0; l < levels.size() && !levels[l].cut.empty(); ++l) {
        const Level<D>&fine = levels[l], &coarse = levels[l + 1];
        const std::vector<PlaneSize> weights(2 * D, colour_of(fine));
        tally.refresh(fine.cut, fine.at.periodic[D - 1], weights, 1, 1);
        const std::size_t plane = coarse.cells() / static_cast<std::size_t>(coarse.at.planes());
        std::vector<PlaneSize> matrix(D + 1, {sizeof(float) * plane, coarse.at.planes()});  // faces, and couplings to p = 0
        matrix.push_back({sizeof(std::uint8_t) * plane, coarse.at.planes()});               // fluid flags
        if (!coarse.cut.empty())
            tally.refresh(coarse.cut, coarse.at.periodic[D - 1], matrix, 1, 1);
        else
            for (const PlaneSize& array : matrix) tally.gather(VCycle<D>::halved_cut(fine), array, 1);
    }
}

template void tally_multigrid_setup<2>(const Index<2>&, const std::array<bool, 2>&, const Vec<2>&, const Runs&, Tally&);
template void tally_multigrid_setup<3>(const Index<3>&, const std::array<bool, 3>&, const Vec<3>&, const Runs&, Tally&);
template void tally_multigrid<2>(const Index<2>&, const std::array<bool, 2>&, const Vec<2>&, bool, int, Tally&);
template void tally_multigrid<3>(const Index<3>&, const std::array<bool, 3>&, const Vec<3>&, bool, int, Tally&);

}  // namespace weir::poisson
