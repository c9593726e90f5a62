// Dφ/Dt = 0: φ at the departure point of each cell of the band, by a second-order Runge-Kutta trace and tensor cubic (Catmull–Rom)
// interpolation (Strain 1999).
#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "free_surface/level_set.hpp"
#include "free_surface/marker_lanes.hpp"

namespace weir::free_surface {

namespace {

/// Linear interpolation of component a at d [cells] from the centre of cell I, at most half a cell away; both neighbours of I must be
/// inside.
template <int D>
real face_near(const Grid<real, D>& u, int a, const Index<D>& I, const Vec<D>& d) {
    std::array<std::ptrdiff_t, 3> stride{};
    std::array<real, 3> f{};
    const real* at = &u(I);
    for (int axis = 0; axis < D; ++axis) {
        const auto s = static_cast<std::size_t>(axis);
        stride[s] = u.stride(axis);
        f[s] = axis == a ? 0.5 + d[axis] : d[axis] < 0 ? 1 + d[axis] : d[axis];
        if (axis != a && d[axis] < 0) at -= stride[s];
    }
    const auto row = [&](const real* q) { return q[0] + f[0] * (q[1] - q[0]); };
    const auto plane = [&](const real* q) {
        const real lower = row(q);
        return lower + f[1] * (row(q + stride[1]) - lower);
    };
    if constexpr (D == 2) return plane(at);
    const real below = plane(at);
    return below + f[2] * (plane(at + stride[2]) - below);
}

}  // namespace

template <int D>
void LevelSet<D>::advect(const MacVelocity<D>& u, real dt, int reach) {
    const real near = (reach_ + 2) * frame_.h_max();  // points beyond cannot reach the surface
    resize_scratch(value_, band_.size());
    find_own();
    refresh(phi, frame_.periodic(D - 1), reach);
    for_each_own(0, band_.size(), [&](int i) {
        const Index<D>& I = band_[static_cast<std::size_t>(i)];
        real& to = value_[static_cast<std::size_t>(i)];
        to = phi(I);
        if (std::abs(to) < near) to = departed(u, I, dt);
    });
    for_each_own(0, band_.size(), [&](int i) { phi(band_[static_cast<std::size_t>(i)]) = value_[static_cast<std::size_t>(i)]; });
    refresh(phi, frame_.periodic(D - 1), reach);  // markers in the first ghost plane read the cells around them and their departure points
}

/// φ at the point where cell I's centre was dt ago. Inside the domain the trace starts at the mean of the cell's faces and stays near them,
/// so no cell search is needed.
template <int D>
real LevelSet<D>::departed(const MacVelocity<D>& u, const Index<D>& I, real dt) const {
    bool inner = true;
    for (int d = 0; d < D; ++d) inner = inner && I[d] >= 2 && I[d] + 2 < frame_.cells[d];
    Vec<D> half, moved;
    for (int a = 0; a < D && inner; ++a) {
        const real* face = &u[a](I);
        half[a] = -0.5 * dt * frame_.inv_h[a] * (0.5 * (face[0] + face[u[a].stride(a)]));
        inner = std::abs(half[a]) <= 0.5;
    }
    for (int a = 0; a < D && inner; ++a) {
        moved[a] = -dt * frame_.inv_h[a] * face_near(u[a], a, I, half);
        inner = std::abs(moved[a]) <= 1;
    }
    if (inner) return sees_walls(I) ? cubic_on_this_side(I, moved) : cubic_near(I, moved);
    const Vec<D> from = trace(u, frame_, frame_.centre(I), -dt, Trace::rk2);
    if (!sees_walls(I)) return cubic(from);
    for (int a = 0; a < D; ++a) {
        moved[a] = (from[a] - frame_.centre(I)[a]) * frame_.inv_h[a];
        if (frame_.periodic(a)) moved[a] -= frame_.cells[a] * std::rint(moved[a] / frame_.cells[a]);
    }
    return cubic_on_this_side(I, moved);
}

/// φ at d [cells] from the centre of cell I beside a thin wall, limited to the range of a stencil of radius two.
template <int D>
real LevelSet<D>::cubic_on_this_side(const Index<D>& I, Vec<D> d) const {
    constexpr int most = Around<D>::most - 1;
    real furthest = 0;
    for (int a = 0; a < D; ++a) {
        d[a] = std::clamp<real>(d[a], -most, most);
        furthest = std::max(furthest, std::abs(d[a]));
    }
    if (furthest == 0) return phi(I);
    Around<D> around;
    walls_.look(closed_, phi, I, furthest > 1 ? most + 1 : 2, around);
    return around.cubic(d);
}

/// φ at d [cells] from the centre of cell I, at most one cell away; two cells on either side of I must be inside. As cubic(), with four
/// samples along x in one vector.
template <int D>
real LevelSet<D>::cubic_near(const Index<D>& I, const Vec<D>& d) const {
    using Quad = simd::Pack<real, 4>;
    std::array<std::array<real, 4>, D> w;
    const real* at = &phi(I);
    for (int axis = 0; axis < D; ++axis) {
        w[static_cast<std::size_t>(axis)] = catmull_rom(d[axis] < 0 ? 1 + d[axis] : d[axis]);
        at -= (d[axis] < 0 ? 2 : 1) * phi.stride(axis);
    }
    const auto plane = [&](const real* q) {
        Quad sum{};
        for (std::size_t j = 0; j < 4; ++j, q += phi.stride(1)) {
            sum += w[1][j] * simd::load<Quad>(q);
        }
        return sum;
    };
    Quad sum;
    if constexpr (D == 2) {
        sum = plane(at);
    } else {
        sum = Quad{};
        for (std::size_t k = 0; k < 4; ++k, at += phi.stride(2)) sum += w[2][k] * plane(at);
    }
    return ((w[0][0] * sum[0] + w[0][1] * sum[1]) + w[0][2] * sum[2]) + w[0][3] * sum[3];
}

/// Catmull–Rom along each axis in turn, at any point.
template <int D>
real LevelSet<D>::cubic(const Vec<D>& x) const {
    std::array<std::array<std::ptrdiff_t, 4>, D> at;
    std::array<std::array<real, 4>, D> w;
    for (int d = 0; d < D; ++d) {
        const auto axis = static_cast<std::size_t>(d);
        const real s = (x[d] - frame_.origin[d]) * frame_.inv_h[d] - 0.5, floor = std::floor(s), f = s - floor;
        for (int k = 0; k < 4; ++k) {
            Index<D> I{};
            I[d] = index_from(floor);
            at[axis][static_cast<std::size_t>(k)] = phi.stride(d) * frame_.near(I, d, k - 1)[d];
        }
        w[axis] = catmull_rom(f);
    }
    const auto plane = [&](const real* base) {
        real sum = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            const real* row = base + at[1][j];
            sum += w[1][j] * (w[0][0] * row[at[0][0]] + w[0][1] * row[at[0][1]] + w[0][2] * row[at[0][2]] + w[0][3] * row[at[0][3]]);
        }
        return sum;
    };
    if constexpr (D == 2) {
        return plane(phi.data());
    } else {
        real sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += w[2][k] * plane(phi.data() + at[2][k]);
        return sum;
    }
}

#define WEIR_INSTANTIATE(D)                                                         \
    template void LevelSet<D>::advect(const MacVelocity<D>& u, real dt, int reach); \
    template real LevelSet<D>::cubic(const Vec<D>& x) const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::free_surface
