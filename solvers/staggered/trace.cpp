#include "staggered/trace.hpp"

#include "staggered/near_sample.hpp"

#include <stdexcept>

namespace weir::staggered {

const Tableau& tableau(const std::string& name) {
    static const Tableau rk1{1, {0}, {1}};
    static const Tableau rk2{2, {0, 0.5}, {0, 1}};
    static const Tableau rk3{3, {0, 0.5, 0.75}, {2.0 / 9, 3.0 / 9, 4.0 / 9}};
    static const Tableau rk4{4, {0, 0.5, 0.5, 1}, {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}};
    if (name == "rk1") return rk1;
    if (name == "rk2") return rk2;
    if (name == "rk3") return rk3;
    if (name == "rk4") return rk4;
    throw std::logic_error("trace \"" + name + "\" is in the schema but has no meaning");
}

namespace {

inline real clamp_to(real d, real low, real high) { return d < low ? low : d > high ? high : d; }

/// Clamps d[i] to [low - step i, high - step i]: homes advance by `step` cells along the row.
void clamp_row(real* d, int count, real low, real high, real step) {
#pragma omp simd
    for (int i = 0; i < count; ++i) d[i] = clamp_to(d[i], low - step * i, high - step * i);
}

}  // namespace

template <int D>
void Domain<D>::keep_inside(int home_axis, const Index<D>& first, int count, Displacement<D>& x) const {
    for (int a = 0; a < D; ++a) {
        const real n = cells[a], home = first[a] + (a == home_axis ? 0.0 : 0.5);
        real* d = x.d[a];
        if (periodic[static_cast<std::size_t>(a)]) {
            if (x.near) continue;  // the ghost layers cover it
            const real step = a == 0 ? 1 : 0;
#pragma omp simd
            for (int i = 0; i < count; ++i) d[i] -= n * std::floor((home + step * i + d[i]) / n);
        } else if (!x.near) {
            clamp_row(d, count, -home, n - home, a == 0 ? 1 : 0);
        } else if (a == 0) {  // only the outermost nodes can reach a side
            d[0] = clamp_to(d[0], -home, n - home);
            d[count - 1] = clamp_to(d[count - 1], -home - (count - 1), n - home - (count - 1));
        } else if (home < 1 || home > n - 1) {
            clamp_row(d, count, -home, n - home, 0);
        }
    }
}

template <int D>
std::array<real, 2> Domain<D>::reach(int home_axis, const Index<D>& first, int a) const {
    if (periodic[static_cast<std::size_t>(a)]) return {-infinity, infinity};
    const real home = first[a] + (a == home_axis ? 0.0 : 0.5);
    return {-home, cells[a] - home};
}

template <int D>
GridBacktrace<D>::GridBacktrace(const PaddedVelocity<D>& u, const MacVelocity<D>& grid, const geometry::Sides<D>& sides,
                                const std::string& scheme)
    : u_(u), h_(grid.h), domain_(grid.cells, sides), rk_(tableau(scheme)) {}

/// At the nodes every component is the mean of its two or four nearest faces.
template <int D>
void GridBacktrace<D>::velocity_at_home(int home_axis, const Index<D>& first, int count, Displacement<D>& k) const {
    for (int b = 0; b < D; ++b) {
        const auto& u = u_[b];
        const real* q = u.at(first);
        real* out = k.d[b];
        const std::ptrdiff_t up = u.stride(b), back = home_axis < 0 ? 0 : -u.stride(home_axis);
        if (b == home_axis) {
            std::copy_n(q, count, out);
        } else if (home_axis < 0) {
#pragma omp simd
            for (int i = 0; i < count; ++i) out[i] = 0.5 * (q[i] + q[i + up]);
        } else {
#pragma omp simd
            for (int i = 0; i < count; ++i) out[i] = 0.25 * ((q[i] + q[i + up]) + (q[i + back] + q[i + back + up]));
        }
    }
}

template <int D>
void GridBacktrace<D>::velocity_at(int home_axis, const Index<D>& first, int count, const Displacement<D>& x, Displacement<D>& k) const {
    for (int b = 0; b < D; ++b) {
        const RowView<D> view(u_[b], first, b, home_axis);
        x.near ? sample_near(view, x, count, k.d[b]) : sample_linear(view, x, count, k.d[b]);
    }
}

/// to = factor k along each axis.
template <int D>
static void scale(const Displacement<D>& k, const Vec<D>& factor, int count, Displacement<D>& to) {
    for (int a = 0; a < D; ++a) {
        const real f = factor[a];
#pragma omp simd
        for (int i = 0; i < count; ++i) to.d[a][i] = f * k.d[a][i];
    }
}

namespace {

/// Component B relative to homes of one kind, eight at a time.
template <int D, int Home, int B>
class NearComponent {
public:
    NearComponent(const Padded<D>& u, const Index<D>& first) : q_(u.at(first)) {
        for (int a = 0; a < D; ++a) stride_[static_cast<std::size_t>(a)] = static_cast<int>(u.stride(a));
    }
    /// As velocity_at_home.
    [[gnu::always_inline]] Lanes at_home(int i) const {
        const real* q = q_ + i;
        const int up = stride_[B];
        if constexpr (B == Home)
            return simd::load<Lanes>(q);
        else if constexpr (Home < 0)
            return 0.5 * (simd::load<Lanes>(q) + simd::load<Lanes>(q + up));
        else
            return 0.25 * ((simd::load<Lanes>(q) + simd::load<Lanes>(q + up)) +
                           (simd::load<Lanes>(q - stride_[Home]) + simd::load<Lanes>(q - stride_[Home] + up)));
    }
    [[gnu::always_inline]] Lanes at(const NearPoints<D>& x, int i) const {
        const int lower = Home < 0 || Home == B ? 0 : stride_[static_cast<std::size_t>(std::max(Home, 0))];
        return Near<Lanes, aligned, D>(x, stride_).at(q_ + i - lower);
    }

private:
    static constexpr unsigned half = (1U << B) ^ (Home < 0 ? 0U : 1U << std::max(Home, 0));  // axes with nodes staggered by half a cell
    static constexpr unsigned aligned = ((1U << D) - 1U) & ~half;
    const real* q_;
    std::array<int, D> stride_;
};

template <int D, int Home>
class NearVelocity {
public:
    NearVelocity(const PaddedVelocity<D>& u, const Index<D>& first) : x_(u[0], first), y_(u[1], first), z_(u[D - 1], first) {}
    [[gnu::always_inline]] void at_home(int i, std::array<Lanes, D>& k) const {
        k[0] = x_.at_home(i);
        k[1] = y_.at_home(i);
        if constexpr (D == 3) k[2] = z_.at_home(i);
    }
    [[gnu::always_inline]] void at(const NearPoints<D>& x, int i, std::array<Lanes, D>& k) const {
        k[0] = x_.at(x, i);
        k[1] = y_.at(x, i);
        if constexpr (D == 3) k[2] = z_.at(x, i);
    }

private:
    NearComponent<D, Home, 0> x_;
    NearComponent<D, Home, 1> y_;
    NearComponent<D, Home, D - 1> z_;
};

}  // namespace

/// The two stages of the midpoint rule for points that stay within a cell, in one loop.
template <int D>
template <int Home>
void GridBacktrace<D>::near_midpoint(const Index<D>& first, int count, real dt, Displacement<D>& to) const {
    const NearVelocity<D, Home> u(u_, first);
    Vec<D> half, whole;  // displacement [cells] per unit of velocity
    std::array<std::array<real, 2>, D> reach;
    bool beside = false;  // next to a side
    for (int a = 0; a < D; ++a) {
        const real cells = -dt / h_[a];
        half[a] = rk_.c[1] * cells;
        whole[a] = rk_.b[1] * cells;
        reach[static_cast<std::size_t>(a)] = domain_.reach(Home, first, a);
        if (a > 0) beside = beside || reach[static_cast<std::size_t>(a)][0] > -1 || reach[static_cast<std::size_t>(a)][1] < 1;
    }
    const int cells_end = domain_.cells[0];
    const auto follow = [&](int i, auto&& inside) __attribute__((always_inline)) {
        std::array<Lanes, D> k;
        NearPoints<D> x;
        u.at_home(i, k);
        for (std::size_t a = 0; a < D; ++a) x.d[a] = inside(half[a] * k[a], a);
        x.find_sides();
        u.at(x, i, k);
        for (std::size_t a = 0; a < D; ++a) simd::store(&to.d[a][i], inside(whole[a] * k[a], a));
    };
    for (int i = 0; i < count; i += lanes) {
        if (!beside && first[0] + i > 0 && first[0] + i + lanes < cells_end) {
            follow(
                i, [](const Lanes& d, std::size_t) __attribute__((always_inline)) { return d; });
            continue;
        }
        const Lanes along_row = Lanes{0, 1, 2, 3, 4, 5, 6, 7} + i;
        follow(
            i, [&](const Lanes& d, std::size_t a) __attribute__((always_inline)) {
                const Lanes zero{}, step = a == 0 ? along_row : zero, low = reach[a][0] - step, high = reach[a][1] - step;
                return d < low ? low : d > high ? high : d;
            });
    }
}

template <int D>
void GridBacktrace<D>::row(int home_axis, const Index<D>& first, int count, real dt, Displacement<D>& to) const {
    Displacement<D> k, x;
    Vec<D> cells;  // displacement [cells] per unit of velocity
    for (int a = 0; a < D; ++a) cells[a] = -dt / h_[a];
    to.near = is_near(dt);  // interpolation never exceeds the node values, so no stage goes farther
    if (to.near && rk_.stages == 2) {
        if (home_axis < 0) return near_midpoint<-1>(first, count, dt, to);
        if (home_axis == 0) return near_midpoint<0>(first, count, dt, to);
        if (home_axis == 1) return near_midpoint<1>(first, count, dt, to);
        if constexpr (D == 3) return near_midpoint<2>(first, count, dt, to);
    }
    velocity_at_home(home_axis, first, count, k);
    scale(k, rk_.b[0] * cells, count, to);
    for (int s = 1; s < rk_.stages; ++s) {
        const auto stage = static_cast<std::size_t>(s);
        scale(k, rk_.c[stage] * cells, count, x);
        x.near = to.near && rk_.c[stage] <= 0.5;
        domain_.keep_inside(home_axis, first, count, x);
        velocity_at(home_axis, first, count, x, k);
        for (int a = 0; a < D; ++a) {
            const real f = rk_.b[stage] * cells[a];
#pragma omp simd
            for (int i = 0; i < count; ++i) to.d[a][i] += f * k.d[a][i];
        }
    }
    domain_.keep_inside(home_axis, first, count, to);
}

template struct Domain<2>;
template struct Domain<3>;
template class GridBacktrace<2>;
template class GridBacktrace<3>;

}  // namespace weir::staggered
