// Keeps the level set and the liquid fractions of cells consistent: excess volume that a cell cannot hold moves to its neighbours, and the
// surface moves to enclose the cells' volume.
#include "core/parallel.hpp"
#include "free_surface/marker_lanes.hpp"
#include "free_surface/volume_fraction.hpp"

#include <numbers>

namespace weir::free_surface {

namespace {
constexpr real noise = 1e-4;    // relative to a cell: error within the tolerance of the pressure
constexpr real film = 1e-6;     // relative to a cell: volume that may stay outside the surface
constexpr int passes = 2;       // cells that an excess moves per step
constexpr real furthest = 0.1;  // largest motion of the surface per step [h]
constexpr real gain = 0.2;      // fraction corrected per step: the whole adds energy to waves, 43% in 20 s of sloshing instead of 15%
constexpr real unsure = 0.03;   // tolerated distance between the two [h]: second-order errors of smooth waves are within it
}  // namespace

/// Excess of a cell's volume: > 0 above its capacity or outside the surface, < 0 negative or a hole deep inside the liquid.
template <int D>
real LiquidVolume<D>::rest_of(std::size_t cell, real phi, const Grid<std::uint8_t, D>& exempt) const {
    if (!exempt.empty() && exempt[cell]) return 0;
    const real h = frame_.h_max(), part = part_[cell], room = capacity(cell);
    if (part > room + noise) return part - room;
    if (part < -noise) return part;
    if (phi < -1.5 * h && part < room - noise) return part - room;
    if (phi > h && phi < reach_ && part > film) return part;
    return 0;
}

/// f(first, last) for the parts of lines with liquid in this rank's own planes and one ghost plane on each side, in the order of the grid.
template <int D>
template <class F>
void LiquidVolume<D>::for_each_near_line(F&& f) const {
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    for (std::size_t line = 0; line < lines_.size(); ++line) {
        const Index<D> I = frame_.index_of(line * n);
        if (!frame_.own().contains(I[D - 1]) && !frame_.own().contains(frame_.near(I, D - 1, 1)[D - 1]) &&
            !frame_.own().contains(frame_.near(I, D - 1, -1)[D - 1]))
            continue;
        const Segment& wet = lines_[line];
        if (!wet.empty()) f(line * n + static_cast<std::size_t>(wet.begin), line * n + static_cast<std::size_t>(wet.end));
    }
}

/// Returns whether any of `count` cells may have an excess: rest_of() without exemptions.
template <int D>
bool LiquidVolume<D>::may_have_rests(std::size_t first, int count, const Grid<real, D>& phi, const MacState<D>& state) const {
    const real h = frame_.h_max(), deep = -1.5 * h;
    const real *part = part_.data() + first, *distance = phi.data() + first, *open = open_.empty() ? nullptr : open_.data() + first;
    real most = 0;
#pragma omp simd reduction(max : most)
    for (int i = 0; i < count; ++i) {
        const real F = part[i], room = open ? open[i] : 1, over = std::max(F - room, -F);
        const real hole = distance[i] < deep ? room - F : 0, drop = distance[i] > h ? F * (noise / film) : 0;
        most = std::max(most, std::max(over, std::max(hole, drop)));
    }
    if (most > noise || !state.solid.any()) return most > noise;
    const poisson::Cell* cell = state.cells.data() + first;
    return std::find(cell, cell + count, poisson::Cell::solid) != cell + count;
}

template <int D>
void LiquidVolume<D>::find_rests(const Grid<real, D>& phi, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt) {
    constexpr std::size_t block = 32;
    rests_.clear();
    for_each_near_line([&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += block) {
            const std::size_t last = std::min(first + block, end);
            if (!may_have_rests(first, static_cast<int>(last - first), phi, state)) continue;
            for (std::size_t i = first; i < last; ++i) {
                const bool solid = state.cells[i] == poisson::Cell::solid;
                const real rest = solid ? part_[i] : rest_of(i, phi[i], exempt);
                if (rest != 0) rests_.push_back({i, rest, rest > 0 ? solid || part_[i] > capacity(i) : part_[i] >= 0});
            }
        }
    });
}

/// Distributes excess to neighbours in proportion to the rise of φ towards them (for too much volume or a hole), or to its fall (for
/// negative volume, or liquid outside). Equal parts where φ is flat.
template <int D>
void LiquidVolume<D>::distribute_excess(const Grid<real, D>& phi, const MacState<D>& state) {
    for (const Rest& rest : rests_) {
        const Index<D> I = frame_.index_of(rest.cell);
        const bool outwards = rest.outwards;
        std::array<real, 2 * D> weight{};
        std::array<Index<D>, 2 * D> to;
        real sum = 0;
        int ways = 0;
        for (int d = 0; d < D; ++d)
            for (const int by : {-1, 1}) {
                const auto at = static_cast<std::size_t>(2 * d + (by + 1) / 2);
                weight[at] = -1;
                to[at] = I;
                if (!frame_.step(to[at], d, by)) continue;
                if (state.cells(to[at]) == poisson::Cell::solid) continue;
                const Index<D> face = by < 0 ? I : I + e<D>(d);
                if (state.solid.any() && state.cells(I) != poisson::Cell::solid &&
                    !(state.solid.open[static_cast<std::size_t>(d)](face) > 0))
                    continue;
                const real rise = phi(to[at]) - phi(I);
                weight[at] = std::max(outwards ? rise : -rise, real(0));
                sum += weight[at];
                ++ways;
            }
        if (ways == 0) continue;
        for (std::size_t at = 0; at < 2 * D; ++at) {
            if (weight[at] < 0) continue;
            const real share = sum > 0 ? weight[at] / sum : real(1) / ways;
            if (share > 0 && frame_.own().contains(to[at][D - 1])) part_(to[at]) += share * rest.part;
        }
        if (frame_.own().contains(I[D - 1])) part_(I) -= rest.part;
    }
}

template <int D>
void LiquidVolume<D>::settle(const Grid<real, D>& phi, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt) {
    refresh(part_, frame_.periodic(D - 1), 2);
    for (int pass = 0; pass < passes; ++pass) {
        find_reach(pass > 0);
        find_rests(phi, state, exempt);
        distribute_excess(phi, state);
        refresh(part_, frame_.periodic(D - 1), 2);
    }
    find_reach(true);
}

/// F minus the fraction of φ, and the surface area, in the cells near the surface.
template <int D>
void LiquidVolume<D>::compare(const LevelSet<D>& surface, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt) {
    const real h = frame_.h_min();
    const auto& band = surface.band();
    parallel_for(0, static_cast<int>(band.size()), [&](int i) {
        const Index<D>& I = band[static_cast<std::size_t>(i)];
        if (!frame_.own().contains(I[D - 1])) return;
        missing_(I) = 0, near_(I) = 0, full_(I) = 0;
        const real distance = std::abs(surface.phi(I));
        if (distance > 2 * h || state.cells(I) == poisson::Cell::solid || (!exempt.empty() && exempt(I))) return;
        const real room = capacity(part_.linear(I));
        missing_(I) = part_(I) - room * surface.fraction(I);
        near_(I) = room * std::max(1 - distance / h, real(0));
    });
    refresh(missing_, frame_.periodic(D - 1));
    refresh(near_, frame_.periodic(D - 1));
}

/// Sums of both over a cell and its neighbours.
template <int D>
std::array<real, 2> LiquidVolume<D>::around(const Index<D>& I) const {
    real excess = 0, area = 0;
    bool inner = true;
    for (int d = 0; d < D; ++d) inner = inner && is_inner(frame_, I, d);
    if (inner) {
        const std::size_t at = missing_.linear(I);
        for (int k = D == 2 ? 0 : -1; k <= (D == 2 ? 0 : 1); ++k)
            for (int j = -1; j <= 1; ++j) {
                const std::ptrdiff_t row =
                    static_cast<std::ptrdiff_t>(at) + j * missing_.stride(1) + (D == 2 ? 0 : k * missing_.stride(D - 1));
                const real *m = missing_.data() + row, *a = near_.data() + row;
                excess += m[-1] + m[0] + m[1], area += a[-1] + a[0] + a[1];
            }
        return {excess, area};
    }
    for (int corner = 0; corner < (D == 2 ? 9 : 27); ++corner) {
        Index<D> J = I;
        bool inside = true;
        for (int d = 0, rest = corner; d < D; ++d, rest /= 3) inside = inside && (rest % 3 == 1 || frame_.step(J, d, rest % 3 - 1));
        if (inside) excess += missing_(J), area += near_(J);
    }
    return {excess, area};
}

template <int D>
real LiquidVolume<D>::courant(real dt, real rate, real g) const {
    const real h = frame_.h_min();
    return dt * std::max(rate + std::sqrt(g / h), std::sqrt(std::numbers::pi_v<real> * g / h));
}

template <int D>
void LiquidVolume<D>::correct(LevelSet<D>& surface, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt, real courant) {
    const real h = frame_.h_min(), part = gain * std::sqrt(std::min(courant, real(1)));
    auto& phi = surface.phi;
    refresh(phi, frame_.periodic(D - 1), 3);
    compare(surface, state, exempt);
    const auto& band = surface.band();
    const auto for_each_in_band = [&](auto&& f) {
        parallel_for(0, static_cast<int>(band.size()), [&](int i) {
            const Index<D>& I = band[static_cast<std::size_t>(i)];
            if (frame_.own().contains(I[D - 1])) f(I);
        });
    };
    for_each_in_band([&](const Index<D>& I) {
        dilation_(I) = 0;
        if (std::abs(phi(I)) > 2 * h) return;
        const auto [excess, area] = around(I);
        const real shift = area > 0 ? excess / area : 0;
        if (std::abs(shift) > unsure) dilation_(I) = std::clamp(part * (shift - std::copysign(unsure, shift)), -furthest, furthest) * h;
    });
    find_drops(phi, state);
    for_each_in_band([&](const Index<D>& I) { phi(I) -= dilation_(I), missing_(I) = 0, near_(I) = 0; });
    for (const std::size_t drop : drops_) join_drop(phi, frame_.index_of(drop));
}

/// Cells more than half full outside the liquid of φ.
template <int D>
void LiquidVolume<D>::find_drops(const Grid<real, D>& phi, const MacState<D>& state) {
    drops_.clear();
    const real h = frame_.h_min();
    for_each_near_line([&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            if (part_[i] > 0.5 * capacity(i) && part_[i] > 0.1 && phi[i] > 0.5 * h && state.cells[i] != poisson::Cell::solid)
                drops_.push_back(i);
    });
}

/// Adds a drop to φ: its value at the centre is that of a flat surface for the cell's fraction, increasing with the distance to neighbours.
template <int D>
void LiquidVolume<D>::join_drop(Grid<real, D>& phi, const Index<D>& I) {
    const real h = frame_.h_min(), here = (0.5 - std::min<real>(part_(I), 1)) * h;
    for (int corner = 0; corner < (D == 2 ? 9 : 27); ++corner) {
        Index<D> J = I;
        bool inside = true;
        Vec<D> by{};
        for (int d = 0, rest = corner; d < D; ++d, rest /= 3) {
            by[d] = frame_.h[d] * (rest % 3 - 1);
            inside = inside && (rest % 3 == 1 || frame_.step(J, d, rest % 3 - 1));
        }
        if (inside && frame_.own().contains(J[D - 1])) phi(J) = std::min(phi(J), here + norm(by));
    }
}

#define WEIR_INSTANTIATE(D)                                                                                        \
    template real LiquidVolume<D>::courant(real, real, real) const;                                                \
    template void LiquidVolume<D>::settle(const Grid<real, D>&, const MacState<D>&, const Grid<std::uint8_t, D>&); \
    template void LiquidVolume<D>::correct(LevelSet<D>&, const MacState<D>&, const Grid<std::uint8_t, D>&, real);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::free_surface
