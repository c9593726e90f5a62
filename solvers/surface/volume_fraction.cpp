#include "surface/volume_fraction.hpp"

#include "core/parallel.hpp"
#include "core/plane_checkpoint.hpp"

namespace weir::surface {

namespace {
/// Parts nearer to 0 or 1 than this are not cut: what they hold goes in proportion.
constexpr real dust = 1e-6;
}  // namespace

template <int D>
LiquidVolume<D>::LiquidVolume(const Frame<D>& frame)
    : frame_(frame), part_(frame.cells), dilation_(frame.cells), full_(frame.cells), missing_(frame.cells), near_(frame.cells) {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        flux_[at] = courant_[at] = Grid<real, D>(frame.cells + e<D>(a));
    }
}

template <int D>
void LiquidVolume<D>::start(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed) {
    reach_ = 0.999 * surface.cap();
    for_each_cell(frame_.cells, [&](const Index<D>& I) { part_(I) = !closed.empty() && closed(I) ? 0 : surface.fraction(I); });
}

/// Gradient of a plane in cell I, by cell: φ's, or where φ has none that is near a distance's, that of −F (Youngs 1984: central, smoothed).
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

/// Of the donor's liquid what leaves with |courant| of its volume, through its upper face where courant > 0.
template <int D>
real LiquidVolume<D>::liquid_through(const Grid<real, D>& phi, const Index<D>& donor, int axis, real courant) const {
    const real F = part_(donor), width = std::min(std::abs(courant), real(1));
    const Vec<D> g = normal(phi, donor);
    real steep = 0;
    for (int d = 0; d < D; ++d) steep += std::abs(g[d]);
    if (steep == 0) return courant * F;
    const real through = std::min(liquid_in_slab(plane_with_fraction(F, g), g, axis, courant > 0 ? 1 : 0, width), F);
    return courant > 0 ? through : -through;
}

/// One direction: fluxes of all faces along `axis`, then F −= ΔF − c ΔC.
template <int D>
void LiquidVolume<D>::sweep(const MacState<D>& state, const Grid<real, D>& phi, real dt, int axis, real& departed) {
    const auto at = static_cast<std::size_t>(axis);
    auto &flux = flux_[at], &courant = courant_[at];
    const auto& u = state.u[axis];
    const real* open = state.solid.any() ? state.solid.open[at].data() : nullptr;
    const real scale = dt * frame_.inv_h[axis];
    const Index<D> faces = flux.extent();
    const int n = frame_.cells[axis];
    refresh(part_, frame_.periodic(D - 1), 2);
    const int last = faces[D - 1], begin = detail::own_share.lower(0), end = std::min(last, detail::own_share.upper(last - 1) + 1);
    parallel_for(begin, end, [&](int k) {
        Index<D> lo{}, hi = faces;
        lo[D - 1] = k, hi[D - 1] = k + 1;
        const int rows = D == 3 ? hi[1] : 1;
        for (int j = 0; j < rows; ++j) {
            Index<D> I = lo;
            if constexpr (D == 3) I[1] = j;
            for (; I[0] < faces[0]; ++I[0]) {
                const std::size_t face = flux.linear(I);
                real C = scale * u[face] * (open ? open[face] : 1);
                const bool side = !frame_.periodic(axis) && (I[axis] == 0 || I[axis] == n);
                if (side && (!state.sides.open(axis, I[axis] == 0 ? 0 : 1) || (C > 0) == (I[axis] == 0))) C = 0;
                courant[face] = C;
                real through = 0;
                if (C != 0) {
                    const Index<D> donor = frame_.near(I, axis, C > 0 ? -1 : 0);
                    const real F = part_(donor);
                    through = F > dust && F < 1 - dust ? liquid_through(phi, donor, axis, C) : C * F;
                }
                flux[face] = through;
            }
        }
    });
    const auto up = flux.stride(axis);
    for_each_cell(frame_.cells, [&](const Index<D>& I) {
        const real *f = &flux(I), *c = &courant(I);
        const real dilation = full_(I) ? c[up] - c[0] : 0;
        dilation_(I) += dilation;
        part_(I) += dilation - (f[up] - f[0]);
    });
    if (frame_.periodic(axis)) return;
    for (const int side : {0, 1}) {
        if (!state.sides.open(axis, side)) continue;
        const int wall = side == 0 ? 0 : n;
        Index<D> lo{}, hi = faces;
        lo[axis] = wall, hi[axis] = wall + 1;
        departed += plane_sum(frame_.cells[D - 1], [&](int k) {
            real sum = 0;
            Index<D> from = lo, to = hi;
            if (axis == D - 1) {
                if (k != (side == 0 ? 0 : n - 1)) return sum;
            } else {
                from[D - 1] = k, to[D - 1] = k + 1;
            }
            const int rows = D == 3 ? to[1] : from[1] + 1;
            for (int j = from[1]; j < rows; ++j) {
                Index<D> I = from;
                I[1] = j;
                for (I[0] = from[0]; I[0] < to[0]; ++I[0]) sum += std::abs(flux(I));
            }
            return sum;
        });
    }
}

template <int D>
real LiquidVolume<D>::advect(const MacState<D>& state, const Grid<real, D>& phi, real dt, bool reversed) {
    real departed = 0;
    for_each_cell(frame_.cells, [&](const Index<D>& I) { dilation_(I) = 0, full_(I) = part_(I) > 0.5; });
    for (int i = 0; i < D; ++i) sweep(state, phi, dt, reversed ? D - 1 - i : i, departed);
    for_each_cell(frame_.cells, [&](const Index<D>& I) { part_(I) -= dilation_(I); });
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
    std::size_t total = part_.bytes() + dilation_.bytes() + full_.bytes() + missing_.bytes() + near_.bytes() + rests_.capacity() * sizeof(Rest);
    for (std::size_t a = 0; a < D; ++a) total += flux_[a].bytes() + courant_[a].bytes();
    return total;
}

template class LiquidVolume<2>;
template class LiquidVolume<3>;

}  // namespace weir::surface
