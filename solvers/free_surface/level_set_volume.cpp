// Liquid volume of cells and of the whole level set, its first moment and the area of the surface: φ is a plane in each half cell, whose
// volume is exact (Scardovelli & Zaleski 2000).
#include "core/parallel.hpp"
#include "free_surface/level_set.hpp"
#include "free_surface/marker_lanes.hpp"

namespace weir::free_surface {

/// The moments of fraction_below_plane(), with each corner's simplex at its centroid.
template <int D>
Vec<D> moment_below_plane(real value, const Vec<D>& g) {
    real alpha = -value, steep = 0;
    for (int d = 0; d < D; ++d) steep += std::abs(g[d]);
    if (std::abs(value) >= 0.5 * steep) return {};
    std::array<int, D> axis;
    int count = 0;
    real norm = 1;
    for (int d = 0; d < D; ++d)
        if (std::abs(g[d]) > 1e-4 * steep) {
            axis[static_cast<std::size_t>(count++)] = d;
            alpha += 0.5 * std::abs(g[d]);
            norm *= std::abs(g[d]) * count;
        }
    Vec<D> moment{};
    for (int corner = 0; corner < (1 << count); ++corner) {
        real reach = alpha, volume = 1;
        for (int i = 0; i < count; ++i) reach -= corner >> i & 1 ? std::abs(g[axis[static_cast<std::size_t>(i)]]) : 0;
        if (reach <= 0) continue;
        for (int i = 0; i < count; ++i) volume *= corner >> i & 1 ? -reach : reach;
        for (int i = 0; i < count; ++i) {
            const int d = axis[static_cast<std::size_t>(i)];
            const real from_middle = (corner >> i & 1) - 0.5 + reach / ((count + 1) * std::abs(g[d]));
            moment[d] += (g[d] < 0 ? -1 : 1) * volume / norm * from_middle;
        }
    }
    return moment;
}

/// All half cells at once, one per lane, where every axis has a slope in all of them; the same operations as in fraction_below_plane.
template <int D>
real fraction_of_halves(real phi, const std::array<Vec<D>, 2>& slope) {
    constexpr int halves = 1 << D;
    const Lanes zero{}, one = zero + 1;
    Lanes value = zero + phi, steep = zero, alpha, norm = one;
    std::array<Lanes, D> g, m;
    for (int d = 0; d < D; ++d) {
        const auto at = static_cast<std::size_t>(d);
        for (int half = 0; half < marker_lanes; ++half) g[at][half] = 0.5 * slope[half >> d & 1 ? 1 : 0][d];
        m[at] = g[at] < zero ? -g[at] : g[at];
        for (int half = 0; half < marker_lanes; ++half) value[half] += half >> d & 1 ? 0.5 * g[at][half] : -0.5 * g[at][half];
        steep += m[at];
    }
    bool all_axes = true;
    alpha = -value;
    for (std::size_t d = 0; d < D; ++d) {
        const auto flat = m[d] <= 1e-4 * steep;
        for (int half = 0; half < halves; ++half) all_axes = all_axes && !flat[half];
        alpha += 0.5 * m[d];
        norm *= m[d] * static_cast<real>(d + 1);
    }
    if (!all_axes) {
        real sum = 0;
        for (int half = 0; half < halves; ++half) {
            Vec<D> gradient;
            for (int d = 0; d < D; ++d) gradient[d] = g[static_cast<std::size_t>(d)][half];
            sum += fraction_below_plane(value[half], gradient);
        }
        return sum / halves;
    }
    Lanes volume = zero;
    for (int corner = 0; corner < halves; ++corner) {
        Lanes reach = alpha;
        for (std::size_t d = 0; d < D; ++d)
            if (corner >> d & 1) reach -= m[d];
        Lanes power = one;
        for (int d = 0; d < D; ++d) power *= reach;
        power = reach <= zero ? zero : power;
        volume += __builtin_popcount(static_cast<unsigned>(corner)) % 2 == 1 ? -power : power;
    }
    Lanes part = volume / norm;
    part = part < zero ? zero : part > one ? one : part;
    const Lanes size = value < zero ? -value : value, full = value < zero ? one : zero;
    part = size >= 0.5 * steep ? full : part;
    real sum = 0;
    for (int half = 0; half < halves; ++half) sum += part[half];
    return sum / halves;
}

template <int D>
std::array<Vec<D>, 2> LevelSet<D>::slopes(const Index<D>& I) const {
    if (sees_walls(I)) return slopes_on_this_side(I);
    std::array<Vec<D>, 2> slope;
    const real far = cap(), *here = &phi(I);
    for (int d = 0; d < D; ++d) {
        bool has_lower = true, has_upper = true;
        const real *lower = here - phi.stride(d), *upper = here + phi.stride(d);
        if (!is_inner(frame_, I, d)) {
            Index<D> below = I, above = I;
            has_lower = frame_.step(below, d, -1), has_upper = frame_.step(above, d, 1);
            lower = &phi(below), upper = &phi(above);
        }
        has_lower = has_lower && std::abs(*lower) < far;
        has_upper = has_upper && std::abs(*upper) < far;
        slope[0][d] = has_lower ? *here - *lower : 0;
        slope[1][d] = has_upper ? *upper - *here : slope[0][d];
        if (!has_lower) slope[0][d] = slope[1][d];
    }
    return slope;
}

/// The same beside a thin wall.
template <int D>
std::array<Vec<D>, 2> LevelSet<D>::slopes_on_this_side(const Index<D>& I) const {
    Around<D> around;
    walls_.look(closed_, phi, I, 1, around);
    std::array<Vec<D>, 2> slope;
    const real here = phi(I);
    for (int d = 0; d < D; ++d) {
        const auto has = [&](int by) {
            Index<D> J = I;
            return frame_.step(J, d, by) && std::abs(around.beside(d, by)) < cap();
        };
        slope[0][d] = has(-1) ? here - around.beside(d, -1) : 0;
        slope[1][d] = has(1) ? around.beside(d, 1) - here : slope[0][d];
        if (!has(-1)) slope[0][d] = slope[1][d];
    }
    return slope;
}

template <int D>
real LevelSet<D>::fraction(const Index<D>& I, real shift) const {
    const real here = phi(I) - shift;
    if (std::abs(here) > diagonal_) return here < 0 ? 1 : 0;
    const auto slope = slopes(I);
    real most = 0;  // twice the largest change of φ from the centre to any corner
    for (int d = 0; d < D; ++d) most += std::max(std::abs(slope[0][d]), std::abs(slope[1][d]));
    if (std::abs(here) > 0.51 * most) return here < 0 ? 1 : 0;  // the result of every half cell
    return fraction_of_halves<D>(here, slope);
}

template <int D>
Vec<D> LevelSet<D>::moment(const Index<D>& I) const {
    Vec<D> moment{};
    if (std::abs(phi(I)) > diagonal_) return moment;
    const auto slope = slopes(I);
    constexpr int halves = 1 << D;
    for (int half = 0; half < halves; ++half) {
        Vec<D> g, middle;
        real value = phi(I);
        for (int d = 0; d < D; ++d) {
            const int upper = half >> d & 1;
            g[d] = 0.5 * slope[static_cast<std::size_t>(upper)][d];
            middle[d] = upper ? 0.25 : -0.25;
            value += upper ? 0.5 * g[d] : -0.5 * g[d];
        }
        moment += (1.0 / halves) * (fraction_below_plane(value, g) * middle + 0.5 * moment_below_plane(value, g));
    }
    return moment;
}

/// Sum of f(I) over the open cells of the band up to a layer.
template <int D>
template <class F>
real LevelSet<D>::sum_over_band(int layers, F&& f) const {
    constexpr int blocks = 16;
    const auto end = layer_end(layers);
    std::array<ExactSum, blocks> part;
    parallel_for(0, blocks, [&](int b) {
        ExactSum sum;
        for (std::size_t i = end * static_cast<std::size_t>(b) / blocks; i < end * static_cast<std::size_t>(b + 1) / blocks; ++i) {
            const Index<D>& I = band_[i];
            if (frame_.own().contains(I[D - 1]) && (closed_.empty() || !closed_(I))) sum.add(open_part(I) * f(I));
        }
        part[static_cast<std::size_t>(b)] = sum;
    });
    ExactSum sum;
    for (const ExactSum& more : part) sum.add(more);
    return sum_of_ranks(frame_.own(), sum).value();
}

/// Outside the band a cell is full or empty.
template <int D>
real LevelSet<D>::volume() const {
    const int planes = frame_.cells[D - 1];
    const std::size_t plane = phi.size() / static_cast<std::size_t>(planes);
    const real full = plane_sum(frame_.own(), planes, [&](int k) {
        const std::size_t first = static_cast<std::size_t>(k) * plane;
        const std::uint8_t *inside = inside_.data() + first, *layer = layer_.data() + first;
        const std::uint8_t* closed = closed_.empty() ? nullptr : closed_.data() + first;
        if (!open_part_.empty()) {
            const real* part = open_part_.data() + first;
            real sum = 0;
            for (std::size_t i = 0; i < plane; ++i) sum += (inside[i] & (layer[i] == 0) & (closed[i] == 0)) != 0 ? part[i] : 0;
            return sum;
        }
        int count = 0;
        if (closed)
            for (std::size_t i = 0; i < plane; ++i) count += inside[i] & (layer[i] == 0) & (closed[i] == 0);
        else
            for (std::size_t i = 0; i < plane; ++i) count += inside[i] & (layer[i] == 0);
        return real(count);
    });
    return frame_.cell_volume() * (full + sum_over_band(layers_, [&](const Index<D>& I) { return fraction(I); }));
}

/// dV/dshift, by a central difference over half a cell.
template <int D>
real LevelSet<D>::area() const {
    const real width = 0.25 * frame_.h_min();
    const real sum = sum_over_band(std::min(2, layers_), [&](const Index<D>& I) { return fraction(I, width) - fraction(I, -width); });
    return frame_.cell_volume() / (2 * width) * sum;
}

#define WEIR_INSTANTIATE(D)                                                         \
    template Vec<D> moment_below_plane(real value, const Vec<D>& g);                \
    template real fraction_of_halves(real phi, const std::array<Vec<D>, 2>& slope); \
    template std::array<Vec<D>, 2> LevelSet<D>::slopes(const Index<D>& I) const;    \
    template real LevelSet<D>::fraction(const Index<D>& I, real shift) const;       \
    template Vec<D> LevelSet<D>::moment(const Index<D>& I) const;                   \
    template real LevelSet<D>::volume() const;                                      \
    template real LevelSet<D>::area() const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::free_surface
