// The half of the level set that reinitializes φ in a band of cells and measures the enclosed volume.
#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "free_surface/level_set.hpp"
#include "free_surface/marker_lanes.hpp"

#include <cstring>
#include <numeric>

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

template <int D>
void LevelSet<D>::find_inside() {
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    for_each_line(frame_.cells, [&](const Index<D>&, std::size_t at) {
        const real* from = phi.data() + at;
        std::uint8_t* to = inside_.data() + at;
        std::size_t i = 0;
        for (; i + marker_lanes <= n; i += marker_lanes) {
            const auto below = __builtin_convertvector(simd::load<Lanes>(from + i) < Lanes{}, LaneBytes);
            const LaneBytes flag = below & 1;
            std::memcpy(to + i, &flag, sizeof flag);
        }
        for (; i < n; ++i) to[i] = from[i] < 0;
    });
}

/// In parallel, the planes in which this rank finds the band.
template <int D>
void LevelSet<D>::find_near() {
    if (!frame_.own().distributed() || !near_.empty()) return;
    const bool ring = frame_.periodic(D - 1);
    near_ = planes_near(frame_.own().slab, frame_.cells[D - 1], wide(), ring);
    for (auto* bytes : {&layer_, &inside_, &closed_}) bytes->store().open(wide() + 1, ring);
}

/// Marks layer 1: the cells with a neighbour on the other side of the surface.
template <int D>
void LevelSet<D>::find_surface() {
    find_near();
    find_inside();
    refresh(inside_, frame_.periodic(D - 1), wide() + 1);
    for_each_line(replicated<D>(frame_.cells), [&](const Index<D>& first, std::size_t at) {
        if (is_near(first[D - 1])) mark_changes_of_sign(first, at);
    });
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    for (std::size_t line = 0; line < layer_.size(); line += n) {
        Index<D> I = frame_.index_of(line);
        if (!is_near(I[D - 1])) continue;
        std::uint8_t *mark = layer_.data() + line, *end = mark + n;
        for (auto* at = mark; (at = static_cast<std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)))) != nullptr; ++at) {
            I[0] = static_cast<int>(at - mark);
            if (!(sees_walls(I) ? crosses_on_this_side(I) : crosses_in_liquid(I))) *at = 0;
        }
    }
}

/// Collects its cells, in the order of the grid.
template <int D>
void LevelSet<D>::collect_surface() {
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    band_.clear();
    for (std::size_t line = 0; line < layer_.size(); line += n) {
        Index<D> I = frame_.index_of(line);
        if (!is_near(I[D - 1])) continue;
        const std::uint8_t *mark = layer_.data() + line, *end = mark + n;
        for (auto* at = mark; (at = static_cast<const std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)))) != nullptr;
             ++at) {
            I[0] = static_cast<int>(at - mark);
            band_.push_back(I);
        }
    }
    layer_start_[0] = 0;
    layer_start_[1] = band_.size();
}

/// Marks the cells of the line at `at` that have a neighbour of the other sign.
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

/// A change of sign between two closed cells is not a surface.
template <int D>
bool LevelSet<D>::crosses_in_liquid(const Index<D>& I) const {
    if (closed_.empty() || !closed_(I)) return true;
    if (walls_.is_between(I)) return false;  // the open cells beside it use the values of their own side
    for (int d = 0; d < D; ++d)
        for (const int by : {-1, 1}) {
            Index<D> J = I;
            if (frame_.step(J, d, by) && !closed_(J) && inside_(J) != inside_(I)) return true;
        }
    return false;
}

/// Beside a thin wall: the surface passes an open cell where φ changes sign towards a neighbour connected by an open face.
template <int D>
bool LevelSet<D>::crosses_on_this_side(const Index<D>& I) const {
    for (int d = 0; d < D; ++d)
        for (const int by : {-1, 1})
            if (Index<D> J = I; walls_.passes(closed_, I, d, by, J) && inside_(J) != inside_(I)) return true;
    return false;
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

/// Returns whether the band grows from cell I to its neighbour: into a thin wall, but not through it.
template <int D>
bool LevelSet<D>::joins(const Index<D>& I, int axis, int by) const {
    if (!walls_.is_near(I)) return true;
    Index<D> J = I;
    const bool passes = walls_.passes(closed_, I, axis, by, J);  // whether J is open, without a closed face between
    return closed_(J) != 0 || (passes && !walls_.is_between(I));
}

/// Layers 2 .. layers_: neighbours of the previous layer.
template <int D>
void LevelSet<D>::join_layers() {
    for (int layer = 2; layer <= layers_; ++layer) {
        const std::size_t from = layer_begin(layer - 1), to = layer_end(layer - 1);
        for (std::size_t i = from; i < to; ++i) {
            for (int d = 0; d < D; ++d)
                for (const int by : {-1, 1}) {
                    Index<D> J = band_[i];
                    if (!frame_.step(J, d, by) || !is_near(J[D - 1]) || layer_(J) != 0 || !joins(band_[i], d, by)) continue;
                    layer_(J) = static_cast<std::uint8_t>(layer);
                    band_.push_back(J);
                }
        }
        layer_start_[static_cast<std::size_t>(layer)] = band_.size();
    }
    find_own();
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

template Vec<2> moment_below_plane(real, const Vec<2>&);
template Vec<3> moment_below_plane(real, const Vec<3>&);
template real fraction_of_halves(real, const std::array<Vec<2>, 2>&);
template real fraction_of_halves(real, const std::array<Vec<3>, 2>&);
template real LevelSet<2>::width_at(const Index<2>&) const;
template real LevelSet<3>::width_at(const Index<3>&) const;
template void LevelSet<2>::find_near();
template void LevelSet<3>::find_near();
template void LevelSet<2>::collect_surface();
template void LevelSet<3>::collect_surface();
template void LevelSet<2>::join_layers();
template void LevelSet<3>::join_layers();
template void LevelSet<2>::find_inside();
template void LevelSet<3>::find_inside();
template void LevelSet<2>::redistance();
template void LevelSet<3>::redistance();
template real LevelSet<2>::fraction(const Index<2>&, real) const;
template real LevelSet<3>::fraction(const Index<3>&, real) const;
template Vec<2> LevelSet<2>::moment(const Index<2>&) const;
template Vec<3> LevelSet<3>::moment(const Index<3>&) const;
template real LevelSet<2>::volume() const;
template real LevelSet<3>::volume() const;
template real LevelSet<2>::area() const;
template real LevelSet<3>::area() const;

}  // namespace weir::free_surface
