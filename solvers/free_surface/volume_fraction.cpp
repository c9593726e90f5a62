#include "free_surface/volume_fraction.hpp"

#include "core/parallel.hpp"
#include "parallel/plane_checkpoint.hpp"

namespace weir::free_surface {

namespace {
/// Fractions closer to 0 or 1 are not reconstructed by a plane. Full cells are advected whole; nearly empty ones stay, or traces would
/// spread everywhere.
constexpr real dust = 1e-6;

/// The entries above dust in a part of n; {n, 0} where there are none.
Segment extent_of_liquid(const real* F, Segment extent, int n) {
    constexpr int block = 8;
    const auto is_empty = [&](int first) {
        real most = 0;
        for (int i = 0; i < block; ++i) most = std::max(most, std::abs(F[first + i]));
        return most <= dust;
    };
    while (extent.begin + block <= extent.end && is_empty(extent.begin)) extent.begin += block;
    while (extent.begin < extent.end && std::abs(F[extent.begin]) <= dust) ++extent.begin;
    if (extent.begin == extent.end) return {n, 0};
    while (extent.end - block > extent.begin && is_empty(extent.end - block)) extent.end -= block;
    while (std::abs(F[extent.end - 1]) <= dust) --extent.end;
    return extent;
}

}  // namespace

template <int D>
LiquidVolume<D>::LiquidVolume(const Frame<D>& frame)
    : frame_(frame), part_(frame.cells), dilation_(frame.cells), full_(frame.cells), missing_(frame.cells), near_(frame.cells) {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        flux_[at] = Grid<real, D>(frame.cells + e<D>(a));
    }
    lines_.resize(product(frame.cells) / static_cast<std::size_t>(frame.cells[0]), {frame.cells[0], 0});
    reach_of_ = lines_;
    rests_.reserve(512), drops_.reserve(64);
}

template <int D>
void LiquidVolume<D>::start(const LevelSet<D>& surface, const MacState<D>& state) {
    reach_ = 0.999 * surface.cap();
    see_solids(surface, state);
    for_each_cell(frame_.cells, [&](const Index<D>& I) {
        part_(I) = state.cells(I) == poisson::Cell::solid ? 0 : capacity(part_.linear(I)) * surface.fraction(I);
    });
}

template <int D>
void LiquidVolume<D>::see_solids(const LevelSet<D>& surface, const MacState<D>& state) {
    if (!state.solid.any()) return;
    if (open_.empty()) open_ = Grid<real, D>(frame_.cells);
    for_each_cell(frame_.cells, [&](const Index<D>& I) { open_(I) = surface.open_part(I); });
    refresh(open_, frame_.periodic(D - 1), 2);
}

template <int D>
real LiquidVolume<D>::capacity(std::size_t cell) const {
    return open_.empty() ? 1 : open_[cell];
}

template <int D>
void LiquidVolume<D>::follow(const LevelSet<D>& surface, const MacState<D>& state, real shift) {
    for (const Index<D>& I : surface.band())
        if (frame_.own().contains(I[D - 1]) && state.cells(I) != poisson::Cell::solid)
            part_(I) += capacity(part_.linear(I)) * (surface.fraction(I) - surface.fraction(I, -shift));
}

/// Gradient of the plane in cell I, per cell: that of φ, or, where |∇φ| is far from 1, that of −F (Youngs 1984: central, smoothed).
template <int D>
Vec<D> LiquidVolume<D>::normal(const Grid<real, D>& phi, const Index<D>& I) const {
    Vec<D> g;
    real steep = 0;
    for (int d = 0; d < D; ++d) {
        g[d] = 0.5 * (phi(frame_.near(I, d, 1)) - phi(frame_.near(I, d, -1)));
        steep += std::abs(g[d]);
    }
    const real h = frame_.h_min();
    if (steep > 0.5 * h && std::abs(phi(I)) < 1.5 * h) return g;
    constexpr int corners = D == 2 ? 9 : 27;
    g = {};
    for (int corner = 0; corner < corners; ++corner) {
        Index<D> J = I;
        std::array<int, D> by;
        real weight = 1;
        for (int d = 0, rest = corner; d < D; ++d, rest /= 3) {
            by[static_cast<std::size_t>(d)] = rest % 3 - 1;
            J = frame_.near(J, d, rest % 3 - 1);
            weight *= rest % 3 == 1 ? 2 : 1;
        }
        const real F = part_(J);
        for (int d = 0; d < D; ++d) g[d] -= weight * by[static_cast<std::size_t>(d)] * F;
    }
    steep = 0;
    for (int d = 0; d < D; ++d) steep += std::abs(g[d]);
    return steep > 1e-9 ? g : Vec<D>{};
}

/// Volume that leaves the donor cell with |courant| of its volume, through its upper face where courant > 0.
template <int D>
real LiquidVolume<D>::liquid_through(const Grid<real, D>& phi, const Index<D>& donor, int axis, real courant) const {
    const real room = std::max(capacity(part_.linear(donor)), dust), F = std::min(part_(donor) / room, real(1));
    const real width = std::min(std::abs(courant) / room, real(1));
    const Vec<D> g = normal(phi, donor);
    real steep = 0;
    for (int d = 0; d < D; ++d) steep += std::abs(g[d]);
    if (steep == 0) return courant * F;
    const real through = room * std::min(liquid_in_slab(plane_with_fraction(F, g), g, axis, courant > 0 ? 1 : 0, width), F);
    return courant > 0 ? through : -through;
}

/// f(line) for the lines of cells in this rank's own planes, `below` planes before them and `above` after them, also around a periodic axis
/// where `ring`; threaded over planes.
template <int D>
template <class F>
void LiquidVolume<D>::for_each_own_line(int below, int above, bool ring, F&& f) const {
    const int planes = frame_.cells[D - 1], lines = static_cast<int>(lines_.size()) / planes;
    int begin = frame_.own().lower(0) - below, end = frame_.own().upper(planes) + above;
    if (!ring) begin = std::max(begin, 0), end = std::min(end, planes);
    if (end - begin > planes) begin = 0, end = planes;  // each plane once
    parallel_for(begin, end, [&](int k) {
        const int plane = (k + planes) % planes;
        for (int j = 0; j < lines; ++j) f(static_cast<std::size_t>(plane * lines + j));
    });
}

/// For each line the part that contains liquid, and the part that liquid can reach in one sweep along each axis. `within`: it is inside the
/// previous such part.
template <int D>
void LiquidVolume<D>::find_reach(bool within) {
    const int n = frame_.cells[0];
    within = within && !frame_.own().distributed();
    const auto wet = [&](std::size_t line) {
        const real* F = part_.data() + line * static_cast<std::size_t>(n);
        const Segment reach = within ? reach_of_[line] : Segment{0, n};
        lines_[line] = reach.empty() ? Segment{n, 0} : extent_of_liquid(F, reach, n);
    };
    const bool ring = frame_.periodic(D - 1);
    for_each_own_line(2, 2, ring, wet);
    for_each_own_line(1, 1, ring, [&](std::size_t line) {
        Segment extent = lines_[line];
        const Index<D> I = frame_.index_of(line * static_cast<std::size_t>(n));
        for (int corner = 0; corner < (D == 2 ? 3 : 9); ++corner) {
            Index<D> J = frame_.near(I, D - 1, corner % 3 - 1);
            if constexpr (D == 3) J = frame_.near(J, 1, corner / 3 - 1);
            extent.join(lines_[frame_.linear(J) / static_cast<std::size_t>(n)]);
        }
        const bool wraps = frame_.periodic(0) && !extent.empty() && (extent.begin == 0 || extent.end == n);
        if (!extent.empty()) extent = wraps ? Segment{0, n} : Segment{std::max(extent.begin - 1, 0), std::min(extent.end + 1, n)};
        reach_of_[line] = extent;
    });
}

/// The fluxes of the faces first, first + 1, .. of a line along `axis`; `lower` and `upper`: the cells on both sides of the first one.
template <int D>
void LiquidVolume<D>::find_fluxes(const Sweep& s, std::size_t face, std::size_t lower, std::size_t upper, int count) {
    const real *u = s.u + face, *open = s.open ? s.open + face : nullptr, *below = part_.data() + lower, *above = part_.data() + upper;
    real* flux = s.flux + face;
    constexpr int block = 16;
    for (int first = 0; first < count; first += block) {
        const int last = std::min(first + block, count);
        int cut = 0;
#pragma omp simd reduction(| : cut)
        for (int i = first; i < last; ++i) {
            const real C = s.scale * u[i] * (open ? open[i] : 1), F = C > 0 ? below[i] : above[i];
            flux[i] = std::abs(F) <= dust ? 0 : C * std::min(F, real(1));
            cut |= F > dust && F < 1 - dust;
        }
        for (int i = first; cut != 0 && i < last; ++i) {
            const real C = s.scale * u[i] * (open ? open[i] : 1), F = C > 0 ? below[i] : above[i];
            if (C == 0 || F <= dust || F >= 1 - dust) continue;
            const std::size_t donor = (C > 0 ? lower : upper) + static_cast<std::size_t>(i);
            flux[i] = F >= capacity(donor) - dust ? C : liquid_through(*s.phi, frame_.index_of(donor), s.axis, C);
        }
    }
}

/// Flux on a side of the domain: none through walls, outflow only through open sides, regular across a periodic boundary.
template <int D>
void LiquidVolume<D>::find_side_flux(const Sweep& s, const MacState<D>& state, const Index<D>& I, std::size_t face) {
    const int end = I[s.axis] == 0 ? 0 : 1;
    if (frame_.periodic(s.axis))
        return find_fluxes(s, face, frame_.linear(frame_.near(I, s.axis, -1)), frame_.linear(frame_.near(I, s.axis, 0)), 1);
    s.flux[face] = 0;
    if (!state.sides.open(s.axis, end) || (s.u[face] > 0) != (end == 1)) return;
    const std::size_t donor = frame_.linear(frame_.near(I, s.axis, -end));
    find_fluxes(s, face, donor, donor, 1);
}

/// One sweep: fluxes of all faces along `axis` near liquid, then F −= ΔF − c ΔC.
template <int D>
void LiquidVolume<D>::sweep(const MacState<D>& state, const Grid<real, D>& phi, real dt, int axis, real& departed) {
    const auto at = static_cast<std::size_t>(axis), n = static_cast<std::size_t>(frame_.cells[0]);
    Grid<real, D>& flux = flux_[at];
    const Sweep s{
        axis, dt * frame_.inv_h[axis], state.u[axis].data(), state.solid.any() ? state.solid.open[at].data() : nullptr, &phi, flux.data()};
    for_each_own_line(0, axis == D - 1 ? 1 : 0, false, [&](std::size_t line) {
        // the faces below a line's cells, and those above the last line's
        const Index<D> I = frame_.index_of(line * n);
        Segment reach = reach_of_[line];
        if (axis > 0 && I[axis] > 0) reach.join(reach_of_[line - static_cast<std::size_t>(part_.stride(axis)) / n]);
        if (reach.empty()) return;
        const std::size_t face = flux.linear(I), cell = line * n, begin = static_cast<std::size_t>(reach.begin);
        if (axis == 0) {
            const int first = std::max(reach.begin, 1), last = std::min(reach.end, frame_.cells[0] - 1);  // faces with a cell on both sides
            if (first <= last)
                find_fluxes(s, face + static_cast<std::size_t>(first), cell + static_cast<std::size_t>(first) - 1,
                            cell + static_cast<std::size_t>(first), last - first + 1);
            if (reach.begin == 0) find_side_flux(s, state, I, face);
            if (Index<D> J = I; reach.end == frame_.cells[0]) J[0] = reach.end, find_side_flux(s, state, J, face + n);
            return;
        }
        const auto side_fluxes = [&](Index<D> J) {
            J[0] = reach.begin;
            for (; J[0] < reach.end; ++J[0]) find_side_flux(s, state, J, flux.linear(J));
        };
        if (I[axis] == 0)
            side_fluxes(I);
        else
            find_fluxes(s, face + begin, cell + begin - static_cast<std::size_t>(part_.stride(axis)), cell + begin,
                        reach.end - reach.begin);
        if (I[axis] + 1 == frame_.cells[axis]) side_fluxes(I + e<D>(axis));
    });
    add_fluxes(s, flux);
    for (const int side : {0, 1})
        if (!frame_.periodic(axis) && state.sides.open(axis, side)) departed += through_side(flux, axis, side);
}

template <int D>
void LiquidVolume<D>::add_fluxes(const Sweep& s, const Grid<real, D>& flux) {
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    const auto up = flux.stride(s.axis);
    for_each_own_line(0, 0, false, [&](std::size_t line) {
        const Segment& reach = reach_of_[line];
        if (reach.empty()) return;
        const std::size_t face = flux.linear(frame_.index_of(line * n));
        const real *f = flux.data() + face, *u = s.u + face, *open = s.open ? s.open + face : nullptr;
        real *F = part_.data() + line * n, *sum = dilation_.data() + line * n;
        const std::uint8_t* full = full_.data() + line * n;
#pragma omp simd
        for (int i = reach.begin; i < reach.end; ++i) {
            const real lower = u[i] * (open ? open[i] : 1), upper = u[i + up] * (open ? open[i + up] : 1);
            const real dilation = full[i] ? s.scale * (upper - lower) : 0;
            sum[i] += dilation;
            F[i] += dilation - (f[i + up] - f[i]);
        }
    });
}

/// Volume, in cells, that has left through open sides.
template <int D>
real LiquidVolume<D>::through_side(const Grid<real, D>& flux, int axis, int side) const {
    const int n = frame_.cells[axis];
    return plane_sum(frame_.own(), frame_.cells[D - 1], [&](int k) {
        real sum = 0;
        Index<D> lo{}, hi = flux.extent();
        if (axis == D - 1 && k != (side == 0 ? 0 : n - 1)) return sum;
        lo[D - 1] = k, hi[D - 1] = k + 1;
        lo[axis] = side == 0 ? 0 : n, hi[axis] = lo[axis] + 1;
        const int rows = D == 3 ? hi[1] : lo[1] + 1;
        for (int j = lo[1]; j < rows; ++j) {
            Index<D> I = lo;
            I[1] = j;
            for (; I[0] < hi[0]; ++I[0]) {
                Index<D> cell = I;
                cell[axis] -= side;
                const Segment& reach = reach_of_[frame_.linear(cell) / static_cast<std::size_t>(frame_.cells[0])];
                if (cell[0] >= reach.begin && cell[0] < reach.end) sum += std::abs(flux(I));
            }
        }
        return sum;
    });
}

template <int D>
real LiquidVolume<D>::advect(const MacState<D>& state, const Grid<real, D>& phi, real dt, bool reversed) {
    real departed = 0;
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    refresh(part_, frame_.periodic(D - 1), 2);
    find_reach();
    for_each_own_line(0, 0, false, [&](std::size_t line) {
        for (int i = reach_of_[line].begin; i < reach_of_[line].end; ++i) {
            const std::size_t cell = line * n + static_cast<std::size_t>(i);
            dilation_[cell] = 0, full_[cell] = part_[cell] > 0.5 * capacity(cell);
        }
    });
    for (int i = 0; i < D; ++i) {
        if (i > 0) refresh(part_, frame_.periodic(D - 1), 2);
        sweep(state, phi, dt, reversed ? D - 1 - i : i, departed);
    }
    for_each_own_line(0, 0, false, [&](std::size_t line) {
        for (int i = reach_of_[line].begin; i < reach_of_[line].end; ++i) {
            const std::size_t cell = line * n + static_cast<std::size_t>(i);
            part_[cell] -= dilation_[cell];
        }
    });
    return departed * frame_.cell_volume();
}

template <int D>
real LiquidVolume<D>::volume() const {
    return frame_.cell_volume() * sum_over(frame_.cells, [&](const Index<D>& I) { return part_(I); });
}

template <int D>
void LiquidVolume<D>::save(Checkpoint& to) const {
    put_planes(to, "surface.liquid_part", part_);
}

template <int D>
void LiquidVolume<D>::restore(const Checkpoint& from) {
    get_planes(from, "surface.liquid_part", part_);
}

template <int D>
std::size_t LiquidVolume<D>::bytes() const {
    std::size_t total = part_.bytes() + open_.bytes() + dilation_.bytes() + full_.bytes() + missing_.bytes() + near_.bytes() +
                        rests_.capacity() * sizeof(Rest) + drops_.capacity() * sizeof(std::size_t) +
                        2 * lines_.capacity() * sizeof(Segment);
    for (std::size_t a = 0; a < D; ++a) total += flux_[a].bytes();
    return total;
}

template class LiquidVolume<2>;
template class LiquidVolume<3>;

}  // namespace weir::free_surface
