// |∇φ| = 1 in the band of the level set, by first-order upwind differences (Rouy & Tourin 1992; Zhao 2005); cells beside the surface keep
// their values, except where the flow has stretched them (Russo & Smereka 2000).
#include "core/scratch.hpp"
#include "free_surface/level_set.hpp"
#include "free_surface/marker_lanes.hpp"

namespace weir::free_surface {

template <int D>
void LevelSet<D>::redistance() {
    continue_into_solids();
    find_surface();
    collect_surface();
    rescale_surface();
    grow_band();
    for (int layer = 2; layer <= layers_; ++layer) fill_layer(layer);
    refresh(phi, frame_.periodic(D - 1), layers_);  // as far as sums over the band reach
}

/// Range of |∇φ| beside the surface in which φ is not rescaled: scaling one cell but not its neighbour moves the surface. Steep waves
/// stretch φ beyond 3/4 and compress it beyond 4/3 once per period; with those bounds they gained energy each time. The front of a
/// collapsing column compresses φ further and gains volume if that is not rescaled.
constexpr real flattest = 5.0 / 8, steepest_left = 7.0 / 5;

/// Where the flow has stretched φ beside the surface: φ / |∇φ| with the steepest of the differences (Russo & Smereka 2000, eq. 13). The
/// distance of a cell beside the surface is at most its diagonal.
template <int D>
void LevelSet<D>::rescale_surface() {
    resize_scratch(value_, band_.size());
    find_own();
    refresh(phi, frame_.periodic(D - 1));
    for_each_own(0, band_.size(), [&](int i) {
        const Index<D>& I = band_[static_cast<std::size_t>(i)];
        const auto slope = slopes(I);
        real central = 0, steepest = 0;
        for (int d = 0; d < D; ++d) {
            const real mean = 0.5 * (slope[0][d] + slope[1][d]) * frame_.inv_h[d];
            central += mean * mean;
            steepest = std::max({steepest, std::abs(slope[0][d]) * frame_.inv_h[d], std::abs(slope[1][d]) * frame_.inv_h[d]});
        }
        const real gradient = std::max({std::sqrt(central), steepest, 1e-6});
        const bool keeps = gradient <= steepest_left && gradient >= flattest;
        value_[static_cast<std::size_t>(i)] = keeps ? phi(I) : std::clamp(phi(I) / gradient, -diagonal_, diagonal_);
    });
    for_each_own(0, band_.size(), [&](int i) { phi(band_[static_cast<std::size_t>(i)]) = value_[static_cast<std::size_t>(i)]; });
}

/// Finds the band; cells outside it get ± cap.
template <int D>
void LevelSet<D>::grow_band() {
    join_layers();
    for_each_line(frame_.cells, [&](const Index<D>&, std::size_t at) {
        const real far = cap();
        real* line = phi.data() + at;
        const std::uint8_t* layer = layer_.data() + at;
#pragma omp simd
        for (int i = 0; i < frame_.cells[0]; ++i) {
            const real outside = line[i] < 0 ? -far : far;
            line[i] = layer[i] != 0 ? line[i] : outside;
        }
    });
}

template <int D>
real LevelSet<D>::width_at(const Index<D>& I) const {
    const auto slope = slopes(I);
    Vec<D> n;
    for (int d = 0; d < D; ++d) n[d] = (slope[0][d] + slope[1][d]) * frame_.inv_h[d];
    return frame_.width_along(n);
}

/// Two visits: from finished layers, then with the values inside the layer. For flat cells more visits, as many as cells of one column that
/// a plane can cross between two of the next; with fewer the distance is too long by up to half a cell's width, and the surface expands.
/// Layer 2 keeps advected values within 0.3 h of the distance: they are second-order smooth, unlike first-order differences, and the
/// curvature uses them.
template <int D>
void LevelSet<D>::fill_layer(int layer) {
    const std::size_t from = layer_begin(layer), to = layer_end(layer);
    const bool cubic = frame_.cubic();
    const int visits = cubic ? 2 : 1 + static_cast<int>(std::ceil(frame_.h_max() / frame_.h_min()));
    const real keep = layer == 2 ? 0.3 : 0;
    resize_scratch(value_, band_.size());
    for (int visit = 0; visit < visits; ++visit) {
        refresh(phi, frame_.periodic(D - 1));
        for_each_own(from, to, [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            const real distance = upwind_distance(band_[at], visit == 0 ? layer - 1 : layer), moved = phi(band_[at]);
            const real width = cubic || layer > 2 ? frame_.h_min() : width_at(band_[at]);
            value_[at] = std::abs(distance - moved) < keep * width ? moved : distance;
        });
        for_each_own(from, to, [&](int i) { phi(band_[static_cast<std::size_t>(i)]) = value_[static_cast<std::size_t>(i)]; });
    }
}

/// Solves Σ_d max(0, (φ − φ_d)/h_d)² = 1 with φ_d the smaller neighbour of the same side along d, in layers up to `layer`.
template <int D>
real LevelSet<D>::upwind_distance(const Index<D>& I, int layer) const {
    const std::size_t own = phi.linear(I);
    const bool inside = phi[own] < 0, walled = sees_walls(I);
    std::array<std::pair<real, real>, D> nearest;  // (distance, h)
    for (int d = 0; d < D; ++d) {
        real least = infinity;
        const auto see = [&](std::size_t at) {
            const bool counts = layer_[at] != 0 && layer_[at] <= layer && (phi[at] < 0) == inside;
            least = std::min(least, counts ? std::abs(phi[at]) : infinity);
        };
        if (walled) {
            for (const int by : {-1, 1})
                if (Index<D> J = I; walls_.passes(closed_, I, d, by, J)) see(phi.linear(J));
        } else if (is_inner(frame_, I, d)) {
            const auto stride = static_cast<std::size_t>(phi.stride(d));
            see(own - stride), see(own + stride);
        } else {
            for (const int by : {-1, 1})
                if (Index<D> J = I; frame_.step(J, d, by)) see(phi.linear(J));
        }
        nearest[static_cast<std::size_t>(d)] = {least, frame_.h[d]};
    }
    if (nearest[1] < nearest[0]) std::swap(nearest[0], nearest[1]);
    if constexpr (D == 3) {
        if (nearest[2] < nearest[1]) std::swap(nearest[1], nearest[2]);
        if (nearest[1] < nearest[0]) std::swap(nearest[0], nearest[1]);
    }
    real a = 0, b = 0, c = -1, distance = infinity;  // a φ² − 2 b φ + c = 0
    for (const auto& [value, h] : nearest) {
        if (value >= distance) break;
        const real w = 1 / (h * h);
        a += w, b += w * value, c += w * value * value;
        const real root = b * b - a * c;
        distance = (b + std::sqrt(std::max(0.0, root))) / a;
    }
    distance = std::min(distance, cap());
    return inside ? -distance : distance;
}

template void LevelSet<2>::redistance();
template void LevelSet<3>::redistance();
template real LevelSet<2>::width_at(const Index<2>&) const;
template real LevelSet<3>::width_at(const Index<3>&) const;

}  // namespace weir::free_surface
