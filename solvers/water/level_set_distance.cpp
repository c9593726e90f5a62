// The half of the level set that keeps φ a distance in a band of cells, and measures what it encloses.
#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "water/level_set.hpp"

#include <cstring>

namespace weir::water {

template <int D>
void LevelSet<D>::redistance() {
    continue_into_solids();
    find_surface();
    rescale_surface();
    grow_band();
    for (int layer = 2; layer <= layers_; ++layer) fill_layer(layer);
}

/// Layer 1: the cells with a neighbour on the other side of the surface.
template <int D>
void LevelSet<D>::find_surface() {
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    for_each_line(frame_.cells, [&](const Index<D>&, std::size_t at) {
        for (std::size_t i = at; i < at + n; ++i) inside_[i] = phi[i] < 0;
    });
    for_each_line(frame_.cells, [&](const Index<D>& first, std::size_t at) { mark_changes_of_sign(first, at); });
    band_.clear();
    for (std::size_t line = 0; line < layer_.size(); line += n) {
        std::uint8_t *mark = layer_.data() + line, *end = mark + n;
        Index<D> I = frame_.index_of(line);
        for (auto* at = mark; (at = static_cast<std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)))) != nullptr; ++at) {
            I[0] = static_cast<int>(at - mark);
            if (crosses_in_liquid(I))
                band_.push_back(I);
            else
                *at = 0;
        }
    }
    layer_start_[0] = 0;
    layer_start_[1] = band_.size();
}

/// Marks the cells of a line, which begins at `at`, that have a neighbour of the other sign.
template <int D>
void LevelSet<D>::mark_changes_of_sign(const Index<D>& first, std::size_t at) {
    const int n = frame_.cells[0];
    const std::uint8_t* line = inside_.data() + at;
    std::uint8_t* mark = layer_.data() + at;
    mark[0] = frame_.periodic(0) ? line[0] ^ line[n - 1] : 0;
    for (int i = 1; i < n; ++i) mark[i] = line[i] ^ line[i - 1];
    for (int i = 0; i + 1 < n; ++i) mark[i] = static_cast<std::uint8_t>(mark[i] | (line[i] ^ line[i + 1]));
    if (frame_.periodic(0)) mark[n - 1] = static_cast<std::uint8_t>(mark[n - 1] | (line[0] ^ line[n - 1]));
    for (int d = 1; d < D; ++d)
        for (const int by : {-1, 1}) {
            Index<D> J = first;
            if (!frame_.step(J, d, by)) continue;
            const std::uint8_t* other = inside_.data() + inside_.linear(J);
            for (int i = 0; i < n; ++i) mark[i] = static_cast<std::uint8_t>(mark[i] | (line[i] ^ other[i]));
        }
}

/// A change of sign between two closed cells is no surface.
template <int D>
bool LevelSet<D>::crosses_in_liquid(const Index<D>& I) const {
    if (closed_.empty() || !closed_(I)) return true;
    for (int d = 0; d < D; ++d)
        for (const int by : {-1, 1}) {
            Index<D> J = I;
            if (frame_.step(J, d, by) && !closed_(J) && (phi(J) < 0) != (phi(I) < 0)) return true;
        }
    return false;
}

/// Where flow has stretched φ beside the surface: φ / |∇φ| with the steepest of the differences (Russo & Smereka 2000, eq. 13). Only
/// outside [3/4, 4/3], so that a surface that keeps its distance, above all one at rest, keeps it bit for bit.
template <int D>
void LevelSet<D>::rescale_surface() {
    resize_scratch(value_, band_.size());
    parallel_for(0, static_cast<int>(band_.size()), [&](int i) {
        const Index<D>& I = band_[static_cast<std::size_t>(i)];
        const auto slope = slopes(I);
        real central = 0, steepest = 0;
        for (int d = 0; d < D; ++d) {
            const real mean = 0.5 * (slope[0][d] + slope[1][d]) * frame_.inv_h[d];
            central += mean * mean;
            steepest = std::max({steepest, std::abs(slope[0][d]) * frame_.inv_h[d], std::abs(slope[1][d]) * frame_.inv_h[d]});
        }
        const real gradient = std::max({std::sqrt(central), steepest, 1e-6});
        value_[static_cast<std::size_t>(i)] = gradient > 4.0 / 3 || gradient < 0.75 ? phi(I) / gradient : phi(I);
    });
    parallel_for(0, static_cast<int>(band_.size()),
                 [&](int i) { phi(band_[static_cast<std::size_t>(i)]) = value_[static_cast<std::size_t>(i)]; });
}

/// Layers 2 .. layers_: neighbours of the layer before. Cells outside hold ± cap.
template <int D>
void LevelSet<D>::grow_band() {
    for (int layer = 2; layer <= layers_; ++layer) {
        const std::size_t from = layer_begin(layer - 1), to = layer_end(layer - 1);
        for (std::size_t i = from; i < to; ++i)
            for (int d = 0; d < D; ++d)
                for (const int by : {-1, 1}) {
                    Index<D> J = band_[i];
                    if (!frame_.step(J, d, by) || layer_(J) != 0) continue;
                    layer_(J) = static_cast<std::uint8_t>(layer);
                    band_.push_back(J);
                }
        layer_start_[static_cast<std::size_t>(layer)] = band_.size();
    }
    for_each_line(frame_.cells, [&](const Index<D>&, std::size_t at) {
        const real far = cap();
        for (std::size_t i = at; i < at + static_cast<std::size_t>(frame_.cells[0]); ++i)
            phi[i] = layer_[i] ? phi[i] : phi[i] < 0 ? -far : far;
    });
}

template <int D>
real LevelSet<D>::width_at(const Index<D>& I) const {
    const auto slope = slopes(I);
    Vec<D> n;
    for (int d = 0; d < D; ++d) n[d] = (slope[0][d] + slope[1][d]) * frame_.inv_h[d];
    return frame_.width_along(n);
}

/// Two visits: from finished layers, then once more with the values found inside the layer; where cells are flat, as many more as a plane
/// can cross cells of one column between two of the next: with fewer the distance is too long there, by up to half a cell's width, and
/// the surface swells. Layer 2 keeps values that motion left within 0.3 h of a distance: they are smooth to second order where first-order
/// differences are not, and curvature looks at them.
template <int D>
void LevelSet<D>::fill_layer(int layer) {
    const std::size_t from = layer_begin(layer);
    const int count = static_cast<int>(layer_end(layer) - from);
    const bool cubic = frame_.cubic();
    const int visits = cubic ? 2 : 1 + static_cast<int>(std::ceil(frame_.h_max() / frame_.h_min()));
    const real keep = layer == 2 ? 0.3 : 0;
    resize_scratch(value_, band_.size());
    for (int visit = 0; visit < visits; ++visit) {
        parallel_for(0, count, [&](int i) {
            const std::size_t at = from + static_cast<std::size_t>(i);
            const real distance = upwind_distance(band_[at], visit == 0 ? layer - 1 : layer), moved = phi(band_[at]);
            const real width = cubic || layer > 2 ? frame_.h_min() : width_at(band_[at]);
            value_[at] = std::abs(distance - moved) < keep * width ? moved : distance;
        });
        parallel_for(0, count, [&](int i) {
            const std::size_t at = from + static_cast<std::size_t>(i);
            phi(band_[at]) = value_[at];
        });
    }
}

/// Solves Σ_d max(0, (φ − φ_d)/h_d)² = 1 with φ_d the nearer neighbour of the same side along d, in layers up to `layer`.
template <int D>
real LevelSet<D>::upwind_distance(const Index<D>& I, int layer) const {
    const bool inside = phi(I) < 0;
    std::array<std::pair<real, real>, D> nearest;  // (distance, h)
    for (int d = 0; d < D; ++d) {
        real least = infinity;
        for (const int by : {-1, 1}) {
            Index<D> J = I;
            if (!frame_.step(J, d, by) || layer_(J) == 0 || layer_(J) > layer || (phi(J) < 0) != inside) continue;
            least = std::min(least, std::abs(phi(J)));
        }
        nearest[static_cast<std::size_t>(d)] = {least, frame_.h[d]};
    }
    std::sort(nearest.begin(), nearest.end());
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

template <int D>
real fraction_below_plane(real value, const Vec<D>& g) {
    real alpha = -value, steep = 0;
    for (int d = 0; d < D; ++d) steep += std::abs(g[d]);
    if (std::abs(value) >= 0.5 * steep) return value < 0 ? 1 : 0;
    std::array<real, D> m;
    int count = 0;
    real norm = 1;
    for (int d = 0; d < D; ++d)
        if (std::abs(g[d]) > 1e-4 * steep) {  // a flatter axis changes the volume by less than 1e-8 and the formula loses digits
            m[static_cast<std::size_t>(count++)] = std::abs(g[d]);
            alpha += 0.5 * std::abs(g[d]);
        }
    for (int i = 0; i < count; ++i) norm *= m[static_cast<std::size_t>(i)] * (i + 1);
    real volume = 0;
    for (int corner = 0; corner < (1 << count); ++corner) {
        real reach = alpha;
        bool odd = false;
        for (int i = 0; i < count; ++i)
            if (corner >> i & 1) reach -= m[static_cast<std::size_t>(i)], odd = !odd;
        if (reach <= 0) continue;
        real power = 1;
        for (int i = 0; i < count; ++i) power *= reach;
        volume += odd ? -power : power;
    }
    return std::clamp(volume / norm, 0.0, 1.0);
}

template <int D>
std::array<Vec<D>, 2> LevelSet<D>::slopes(const Index<D>& I) const {
    std::array<Vec<D>, 2> slope;
    for (int d = 0; d < D; ++d) {
        Index<D> lower = I, upper = I;
        const bool has_lower = frame_.step(lower, d, -1) && std::abs(phi(lower)) < cap();
        const bool has_upper = frame_.step(upper, d, 1) && std::abs(phi(upper)) < cap();
        slope[0][d] = has_lower ? phi(I) - phi(lower) : 0;
        slope[1][d] = has_upper ? phi(upper) - phi(I) : slope[0][d];
        if (!has_lower) slope[0][d] = slope[1][d];
    }
    return slope;
}

template <int D>
real LevelSet<D>::fraction(const Index<D>& I, real shift) const {
    const real here = phi(I) - shift;
    if (std::abs(here) > norm(frame_.h)) return here < 0 ? 1 : 0;
    const auto slope = slopes(I);
    real sum = 0;
    for (int half = 0; half < (1 << D); ++half) {
        Vec<D> g;
        real value = here;
        for (int d = 0; d < D; ++d) {
            const bool up = half >> d & 1;
            g[d] = 0.5 * slope[up ? 1 : 0][d];
            value += up ? 0.5 * g[d] : -0.5 * g[d];
        }
        sum += fraction_below_plane(value, g);
    }
    return sum / (1 << D);
}

/// Sum of f(I) over the open cells of the band up to place `end`; block by block of equal length, so that its order is fixed.
template <int D>
template <class F>
real LevelSet<D>::sum_over_band(std::size_t end, F&& f) const {
    constexpr std::size_t block = 256;
    return ordered_sum(static_cast<int>((end + block - 1) / block), [&](int b) {
        real sum = 0;
        for (std::size_t i = static_cast<std::size_t>(b) * block; i < std::min(end, static_cast<std::size_t>(b + 1) * block); ++i)
            if (closed_.empty() || !closed_(band_[i])) sum += f(band_[i]);
        return sum;
    });
}

/// Outside the band a cell is full or empty.
template <int D>
real LevelSet<D>::volume() const {
    const int planes = frame_.cells[D - 1];
    const std::size_t plane = phi.size() / static_cast<std::size_t>(planes);
    const real full = ordered_sum(planes, [&](int k) {
        int count = 0;
        for (std::size_t i = static_cast<std::size_t>(k) * plane; i < static_cast<std::size_t>(k + 1) * plane; ++i)
            count += phi[i] < 0 && layer_[i] == 0 && (closed_.empty() || closed_[i] == 0);
        return real(count);
    });
    return frame_.cell_volume() * (full + sum_over_band(band_.size(), [&](const Index<D>& I) { return fraction(I); }));
}

/// dV/dshift, by a difference over half a cell.
template <int D>
real LevelSet<D>::area() const {
    const real width = 0.25 * frame_.h_min();
    const real sum =
        sum_over_band(layer_end(std::min(2, layers_)), [&](const Index<D>& I) { return fraction(I, width) - fraction(I, -width); });
    return frame_.cell_volume() / (2 * width) * sum;
}

template real fraction_below_plane(real, const Vec<2>&);
template real fraction_below_plane(real, const Vec<3>&);
template void LevelSet<2>::redistance();
template void LevelSet<3>::redistance();
template real LevelSet<2>::fraction(const Index<2>&, real) const;
template real LevelSet<3>::fraction(const Index<3>&, real) const;
template real LevelSet<2>::volume() const;
template real LevelSet<3>::volume() const;
template real LevelSet<2>::area() const;
template real LevelSet<3>::area() const;

}  // namespace weir::water
