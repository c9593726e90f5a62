// Pictures of columns of water: a section along a line of them; a plane of them from above at a slant, parallel, with light and shade.
// Heights are drawn larger than they are where they would not be seen: long waves are flat.
#include "app/picture/view.hpp"
#include "core/parallel.hpp"
#include "sim/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace weir::picture {

namespace {

constexpr real film = 1e-3;            // of the deepest water: thinner films are drawn as dry
constexpr real least_relief = 0.12;    // of the width: lower reliefs are drawn so high
constexpr real section_aspect = 0.32;  // height over width of a section's picture
constexpr real elevation = 0.9;        // of the eye above the horizon [rad]

constexpr real seen_slope = 0.1;   // of water, root mean square: lesser ones are lit as if they were so steep,
constexpr real most_ripples = 10;  // up to this many times

const Colour empty_sky = hex(0xf3f5f7);

/// A box that floats.
struct Hull {
    Vec<3> low, high;
};
std::vector<Hull> hulls_of(const output::FrameData& frame) {
    std::vector<Hull> hulls;
    const auto set = frame.particles.find(box_set_name);
    if (set == frame.particles.end()) return hulls;
    const auto &at = set->second.at("position"), &size = set->second.at("size");
    for (std::size_t b = 0; b < at[0].size(); ++b) {
        Hull hull;
        for (std::size_t a = 0; a < at.size(); ++a) {
            hull.low[static_cast<int>(a)] = at[a][b] - size[a][b] / 2;
            hull.high[static_cast<int>(a)] = at[a][b] + size[a][b] / 2;
        }
        hulls.push_back(hull);
    }
    return hulls;
}
const Colour timber = hex(0xb5793f);

/// Bed, top and depth of each column, and what floats.
struct Relief {
    const std::vector<real>&bed, &depth;
    std::vector<real> top;  // of the water, or of the ground where there is none
    std::vector<Hull> hulls;
    real least_depth, deepest, low, high;
    int nx, nz;
    explicit Relief(const output::FrameData& frame)
        : bed(frame.cells.at("bed")[0]),
          depth(frame.cells.at("depth")[0]),
          top(bed),
          hulls(hulls_of(frame)),
          nx(frame.grid.cells[0]),
          nz(frame.grid.cells[2]) {
        deepest = *std::max_element(depth.begin(), depth.end());
        least_depth = film * deepest;
        // below an object the surface is the height of its pressure, and the water ends at the object
        for (std::size_t c = 0; c < top.size(); ++c)
            if (depth[c] > least_depth) top[c] += depth[c];
        if (const auto displaced = frame.cells.find("displaced"); displaced != frame.cells.end()) level_below_objects(displaced->second[0]);
        low = *std::min_element(bed.begin(), bed.end()), high = *std::max_element(top.begin(), top.end());
        for (const Hull& hull : hulls) high = std::max(high, hull.high[1]);
        if (!(high > low)) high = low + 1;
    }
    /// Where objects are, as high as beside them: so the water meets a hull and does not fall to its underside.
    void level_below_objects(const std::vector<real>& displaced) {
        for (int k = 0; k < nz; ++k)
            for (int i = 0; i < nx; ++i) {
                const auto at_row = static_cast<std::size_t>(k) * static_cast<std::size_t>(nx);
                const auto covered = [&](int c) { return displaced[at_row + static_cast<std::size_t>(c)] > 0; };
                if (!covered(i)) continue;
                int end = i;
                while (end + 1 < nx && covered(end + 1)) ++end;
                const int before = std::max(i - 1, 0), behind = std::min(end + 1, nx - 1);
                const real a = top[at_row + static_cast<std::size_t>(i > 0 ? before : behind)],
                           b = top[at_row + static_cast<std::size_t>(end + 1 < nx ? behind : before)];
                for (int c = i; c <= end; ++c) top[at_row + static_cast<std::size_t>(c)] = a + (b - a) * (c - i + 1) / (end - i + 2);
                i = end;
            }
    }
    /// A column's value between centres: i and k count from the first centre.
    real at(const std::vector<real>& values, real i, real k) const {
        const auto whole = [](real f, int n) { return std::clamp(static_cast<int>(f), 0, std::max(0, n - 2)); };
        i = std::clamp(i, 0.0, nx - 1.0), k = std::clamp(k, 0.0, nz - 1.0);
        const int a = whole(i, nx), b = whole(k, nz), a1 = std::min(a + 1, nx - 1), b1 = std::min(b + 1, nz - 1);
        const real s = i - a, t = k - b;
        const auto v = [&](int x, int z) {
            return values[static_cast<std::size_t>(z) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x)];
        };
        return (1 - t) * ((1 - s) * v(a, b) + s * v(a1, b)) + t * ((1 - s) * v(a, b1) + s * v(a1, b1));
    }
};

Colour land_colour(real s) {  // from the lowest bed to the highest
    const Colour shades[] = {hex(0x9c8f6e), hex(0x8aa06a), hex(0x77905c), hex(0x9a8a6c), hex(0xc9c2b5)};
    const real f = std::clamp(s, 0.0, 1.0) * 4;
    const int i = std::min(3, static_cast<int>(f));
    return mix(shades[i], shades[i + 1], f - i);
}
Colour water_colour(real depth, real deepest) { return mix(hex(0x9fd8e6), hex(0x14507e), 1 - std::exp(-3 * depth / deepest)); }

/// A line of columns from the side.
Canvas section(const View& view, const Relief& r) {
    const int width = view.size * oversampling, height = static_cast<int>(section_aspect * view.size) * oversampling;
    Canvas canvas(width, height, empty_sky);
    const real margin = 0.12 * (r.high - r.low), y0 = r.low - margin, y1 = r.high + margin;
    parallel_for(0, width, [&](int x) {
        const real i = (x + 0.5) / width * r.nx - 0.5, bed = r.at(r.bed, i, 0), top = r.at(r.top, i, 0);
        for (int y = 0; y < height; ++y) {
            const real at = y1 - (y + 0.5) / height * (y1 - y0);
            if (at <= bed)
                canvas.at(x, y) = hex(0xa39478);
            else if (at <= top)
                canvas.at(x, y) = mix(hex(0x3f8fc0), hex(0x14507e), std::clamp((top - at) / (r.high - r.low), 0.0, 1.0));
            const real place = view.frame.grid.origin[0] + (i + 0.5) * view.frame.grid.spacing[0];
            for (const Hull& hull : r.hulls)
                if (place > hull.low[0] && place < hull.high[0] && at > hull.low[1] && at < hull.high[1]) canvas.at(x, y) = timber;
        }
    });
    return canvas.smaller(oversampling);
}

/// A plane of columns, seen from the side of the greatest z.
class Slant {
public:
    Slant(const View& view, const Relief& r) : view_(view), r_(r), grid_(view.frame.grid) {
        wide_ = grid_.spacing[0] * r.nx, deep_ = grid_.spacing[2] * r.nz;
        stretch_ = std::max(1.0, least_relief * wide_ / (r.high - r.low));
        const real tall = stretch_ * (r.high - r.low) * std::cos(elevation) + deep_ * std::sin(elevation);
        ripples_ = std::clamp(seen_slope / std::max(1e-12, slope_of_water()), stretch_, most_ripples * stretch_);
        metre_ = 1.06 * std::max(wide_, tall) / (view.size * oversampling);
        width_ = oversampling * static_cast<int>(1.06 * wide_ / metre_ / oversampling);
        height_ = oversampling * static_cast<int>(1.06 * tall / metre_ / oversampling);
        if (view.field != "water") {
            values_ = scalar_field(view.frame, view.field);
            const auto [a, b] = std::minmax_element(values_.begin(), values_.end());
            least_ = view.range.low.value_or(view.range.high ? 0 : *a), most_ = view.range.high.value_or(*b);
        }
    }
    Canvas draw() const {
        Canvas canvas(width_, height_, empty_sky);
        parallel_for(0, width_, [&](int px) {
            const real i = ((px + 0.5 - 0.5 * width_) * metre_ + 0.5 * wide_) / grid_.spacing[0] - 0.5;
            if (i < -0.5 || i > r_.nx - 0.5) return;
            for (int py = 0; py < height_; ++py) canvas.at(px, py) = look(i, py);
        });
        return canvas.smaller(oversampling);
    }

private:
    /// Height of the ray of a row of pixels where it passes z, counted from the middle of the plane; it falls away from the eye.
    real ray(int py, real z) const {
        const real up = (0.5 * height_ - py - 0.5) * metre_;
        return 0.5 * (r_.high + r_.low) + (up + z * std::sin(elevation)) / (stretch_ * std::cos(elevation));
    }
    Colour look(real i, int py) const {
        const real near = 0.5 * deep_, step = 0.5 * grid_.spacing[2];
        const Seen hull = hull_at(i, py);
        const auto row = [&](real z) { return (z + near) / grid_.spacing[2] - 0.5; };
        if (const real y = ray(py, near); y <= r_.at(r_.top, i, r_.nz)) return cut(i, y);
        // the ray is above everything as long as it is higher than the highest column
        const real from = std::min(near, near - (ray(py, near) - r_.high) * stretch_ / std::tan(elevation));
        for (real z = from; z > -near - step; z -= step) {
            const real y = ray(py, z), top = r_.at(r_.top, i, row(z));
            if (z <= hull.z) return hull.light * timber;
            if (z < -near || y < r_.low) return empty_sky;
            if (y > top) continue;
            real in = z, out = z + step;
            for (int n = 0; n < 8; ++n) {
                const real mid = 0.5 * (in + out);
                (ray(py, mid) <= r_.at(r_.top, i, row(mid)) ? in : out) = mid;
            }
            return shade(i, row(in));
        }
        return empty_sky;
    }
    /// The part of a box's upper and front side that a ray meets first, counted from the middle of the plane.
    struct Seen {
        real z = -infinity, light = 0;
    };
    Seen hull_at(real i, int py) const {
        Seen seen;
        const real x = grid_.origin[0] + (i + 0.5) * grid_.spacing[0], middle = grid_.origin[2] + 0.5 * deep_;
        for (const Hull& hull : r_.hulls) {
            if (x < hull.low[0] || x > hull.high[0]) continue;
            const real front = hull.high[2] - middle, back = hull.low[2] - middle, y = ray(py, front);
            const real lid = front - (y - hull.high[1]) * stretch_ / std::tan(elevation);
            if (y >= hull.low[1] && y <= hull.high[1] && front > seen.z)
                seen = {front, 0.6};
            else if (y > hull.high[1] && lid >= back && lid > seen.z)
                seen = {lid, 1.05};
        }
        return seen;
    }
    /// The front side, as if cut by a knife.
    Colour cut(real i, real y) const {
        if (y < r_.low - 0.04 * (r_.high - r_.low)) return empty_sky;
        return y <= r_.at(r_.bed, i, r_.nz) ? hex(0x8d7f66) : hex(0x2a6a98);
    }
    /// Of its surface, root mean square.
    real slope_of_water() const {
        real sum = 0;
        int count = 0;
        for (int k = 0; k < r_.nz; ++k)
            for (int i = 1; i < r_.nx; ++i) {
                const std::size_t c = static_cast<std::size_t>(k) * static_cast<std::size_t>(r_.nx) + static_cast<std::size_t>(i);
                if (r_.depth[c] <= r_.least_depth || r_.depth[c - 1] <= r_.least_depth) continue;
                const real slope = (r_.top[c] - r_.top[c - 1]) / grid_.spacing[0];
                sum += slope * slope, ++count;
            }
        return count > 0 ? std::sqrt(sum / count) : 0;
    }
    Colour shade(real i, real k) const {
        const real depth = r_.at(r_.depth, i, k), steep = depth <= r_.least_depth ? stretch_ : ripples_;
        const real sx = steep * (r_.at(r_.top, i + 0.5, k) - r_.at(r_.top, i - 0.5, k)) / grid_.spacing[0];
        const real sz = steep * (r_.at(r_.top, i, k + 0.5) - r_.at(r_.top, i, k - 0.5)) / grid_.spacing[2];
        const real length = std::sqrt(1 + sx * sx + sz * sz);
        const real light = std::max(0.0, (0.5 * sx + 0.75 - 0.43 * sz) / length);  // from the left, above and before
        if (!values_.empty()) {
            const real s = (r_.at(values_, i, k) - least_) / std::max(most_ - least_, 1e-300);
            return (0.45 + 0.6 * light) * colour_of("viridis", s);
        }
        const Colour land = land_colour((r_.at(r_.bed, i, k) - r_.low) / (r_.high - r_.low));
        if (depth <= r_.least_depth) return (0.35 + 0.85 * light) * land;
        const real glint = std::pow(std::max(0.0, light), 40);
        const Colour water = mix(land, water_colour(depth, r_.deepest), 1 - std::exp(-25 * depth / r_.deepest));
        return (0.4 + 0.75 * light) * water + 0.25 * glint * hex(0xffffff);
    }

    const View& view_;
    const Relief& r_;
    const GridView& grid_;
    std::vector<real> values_;
    real wide_ = 0, deep_ = 0, stretch_ = 1, ripples_ = 1, metre_ = 1, least_ = 0, most_ = 1;
    int width_ = 0, height_ = 0;
};

}  // namespace

bool is_of_columns(const output::FrameData& frame) {
    return frame.grid.cells[1] == 1 && frame.cells.count("bed") && frame.cells.count("depth") && frame.cells.count("surface");
}

Canvas draw_columns(const View& view) {
    const Relief relief(view.frame);
    return view.scene.dim() == 2 ? section(view, relief) : Slant(view, relief).draw();
}

}  // namespace weir::picture
