// A surface of water in 3D, as an eye low over it sees it: triangles between its points, each pixel's nearest one, lit by the sky that it
// reflects by Fresnel's share (Schlick 1994), by light that comes up through crests, and white where there is foam. A sea on a tile that
// repeats is drawn so often as reaches the horizon.
#include "app/picture/sea.hpp"
#include "app/picture/volume.hpp"

#include "core/parallel.hpp"
#include "output/read_frame.hpp"

#include <algorithm>
#include <cmath>

namespace weir::picture {

namespace at_sea {
namespace {

Vec<3> cross(const Vec<3>& a, const Vec<3>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
Vec<3> normalised(const Vec<3>& a) { return a / norm(a); }

struct Corner {
    Vec<3> place, normal;
    real foam = 0;
};

/// The points of one tile, x fastest, with normals from their neighbours.
class Tile {
public:
    Tile(const View& view, bool repeats) : nx_(view.frame.grid.cells[0]), nz_(view.frame.grid.cells[2]), repeats_(repeats) {
        const GridView& g = view.frame.grid;
        size_ = {{nx_ * g.spacing[0], 0, nz_ * g.spacing[2]}};
        const auto& set = view.frame.particles.at(surface_set_name);
        const auto& x = set.at("position");
        const auto foam = set.find("foam");
        corners_.resize(x[0].size());
        for (std::size_t i = 0; i < corners_.size(); ++i)
            corners_[i] = {{{x[0][i], x[1][i], x[2][i]}}, {}, foam == set.end() ? 0 : foam->second[0][i]};
        for (int k = 0; k < nz_; ++k)
            for (int i = 0; i < nx_; ++i) {
                const Vec<3> along_x = at(i + 1, k).place - at(i - 1, k).place, along_z = at(i, k + 1).place - at(i, k - 1).place;
                const Vec<3> n = cross(along_z, along_x);
                corners_[number(i, k)].normal = norm(n) > 0 ? normalised(n) : Vec<3>{{0, 1, 0}};
            }
    }
    int nx() const { return nx_; }
    int nz() const { return nz_; }
    const Vec<3>& size() const { return size_; }
    /// Beyond the tile: of the next one, or the last of this one.
    Corner at(int i, int k) const {
        const auto wrap = [&](int a, int n) { return repeats_ ? (a % n + n) % n : std::clamp(a, 0, n - 1); };
        const int wi = wrap(i, nx_), wk = wrap(k, nz_);
        Corner c = corners_[number(wi, wk)];
        if (repeats_) c.place += Vec<3>{{size_[0] * ((i - wi) / nx_), 0, size_[2] * ((k - wk) / nz_)}};
        return c;
    }

private:
    std::size_t number(int i, int k) const {
        return static_cast<std::size_t>(i) + static_cast<std::size_t>(k) * static_cast<std::size_t>(nx_);
    }
    int nx_, nz_;
    bool repeats_;
    Vec<3> size_{};
    std::vector<Corner> corners_;
};

constexpr real tangent = 0.52;  // of half the field of view across

/// Stands before the tile's near side, a little above the water, and looks over it.
struct Eye {
    Vec<3> place, forward, right, up;
    int width, height;
    Eye(const Tile& tile, const Box& box, int size) : width(size), height(size * 9 / 16) {
        const real wide = std::max(tile.size()[0], tile.size()[2]);
        const Vec<3> middle = 0.5 * (box.min + box.max);
        place = {{middle[0], box.max[1] + 0.05 * wide, box.max[2] + 0.02 * wide}};
        forward = normalised({{0.12, -0.16, -1}});
        right = normalised(cross(forward, {{0, 1, 0}}));
        up = cross(right, forward);
    }
    real scale() const { return 0.5 * width / tangent; }
    Vec<3> seen(const Vec<3>& x) const { return {{dot(x - place, right), dot(x - place, up), dot(x - place, forward)}}; }
    Vec<2> pixel(const Vec<3>& seen) const {
        return {{0.5 * width + scale() * seen[0] / seen[2], 0.5 * height - scale() * seen[1] / seen[2]}};
    }
    Vec<3> ray(real x, real y) const {
        return normalised(forward + ((x - 0.5 * width) / scale()) * right - ((y - 0.5 * height) / scale()) * up);
    }
};

const Vec<3> sun = normalised({{0.55, 0.34, -1.0}});

Colour sky(const Vec<3>& direction) {
    const real high = std::clamp(direction[1], 0.0, 1.0), to_sun = std::max(0.0, dot(direction, sun));
    const Colour clear = mix(hex(0xdfe6ea), hex(0x3f7fc4), std::pow(high, 0.38));
    return clear + (0.30 * std::pow(to_sun, 8) + 1.5 * std::pow(to_sun, 350)) * hex(0xfff1d6);
}

struct Pixel {
    real near = 0;  // one over the distance along the view; 0: nothing yet
    Vec<3> place{}, normal{};
    real foam = 0;
};

class Screen {
public:
    explicit Screen(const Eye& eye) : eye_(eye), pixels_(static_cast<std::size_t>(eye.width) * static_cast<std::size_t>(eye.height)) {}
    /// The part of a triangle in rows [from, to); what is before the eye is cut off with the whole triangle.
    void draw(const std::array<Corner, 3>& t, int from, int to) {
        std::array<Vec<2>, 3> p;
        std::array<real, 3> near;
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec<3> seen = eye_.seen(t[c].place);
            if (seen[2] < 1e-3 * norm(t[0].place - eye_.place) || seen[2] <= 0) return;
            p[c] = eye_.pixel(seen), near[c] = 1 / seen[2];
        }
        const real area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
        if (area == 0) return;
        const auto [left, rightmost] = std::minmax({p[0][0], p[1][0], p[2][0]});
        const auto [top, bottom] = std::minmax({p[0][1], p[1][1], p[2][1]});
        const int y0 = std::max(from, static_cast<int>(std::max(top, -1.0))),
                  y1 = std::min<int>(to - 1, static_cast<int>(std::min(bottom, 1e6)));
        const int x0 = static_cast<int>(std::clamp(left, 0.0, 1e6)),
                  x1 = std::min(eye_.width - 1, static_cast<int>(std::clamp(rightmost, -1.0, 1e6)));
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const real px = x + 0.5, py = y + 0.5;
                const real a = ((p[1][0] - px) * (p[2][1] - py) - (p[2][0] - px) * (p[1][1] - py)) / area;
                const real b = ((p[2][0] - px) * (p[0][1] - py) - (p[0][0] - px) * (p[2][1] - py)) / area, c = 1 - a - b;
                if (a < 0 || b < 0 || c < 0) continue;
                const real closest = a * near[0] + b * near[1] + c * near[2];
                Pixel& at = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(eye_.width) + static_cast<std::size_t>(x)];
                if (closest <= at.near) continue;
                const std::array<real, 3> w{a * near[0] / closest, b * near[1] / closest, c * near[2] / closest};
                at = {closest, {}, {}, 0};
                for (std::size_t v = 0; v < 3; ++v) {
                    at.place += w[v] * t[v].place;
                    at.normal += w[v] * t[v].normal;
                    at.foam += w[v] * t[v].foam;
                }
            }
    }
    const Pixel& at(int x, int y) const {
        return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(eye_.width) + static_cast<std::size_t>(x)];
    }

private:
    const Eye& eye_;
    std::vector<Pixel> pixels_;
};

/// `crest`: height over the mean level in units of the sea's own; `far`: 0 at the eye, 1 at the horizon.
Colour shade(const Pixel& at, const Vec<3>& ray, real crest, real far) {
    Vec<3> n = normalised(at.normal);
    if (dot(n, ray) > 0) n = normalised(n - (1.05 * dot(n, ray)) * ray);  // no side that turns away is seen
    Vec<3> reflected = ray - (2 * dot(ray, n)) * n;
    reflected[1] = std::abs(reflected[1]);
    const real facing = std::clamp(-dot(ray, n), 0.0, 1.0), fresnel = 0.02 + 0.98 * std::pow(1 - facing, 5);
    const real through = std::clamp(0.5 + 0.25 * crest, 0.0, 1.0) * std::pow(std::max(0.0, dot(ray, sun)), 2);
    const Colour body = hex(0x041c2c) + (0.10 * std::max(0.0, dot(n, sun)) + 0.45 * through) * hex(0x1f8a83);
    Colour colour = mix(body, sky(reflected), std::min(1.0, fresnel));
    const real whiteness = std::clamp(3.0 * at.foam, 0.0, 1.0);
    colour = mix(colour, (0.55 + 0.45 * std::max(0.0, dot(n, normalised({{0.3, 1, 0.2}})))) * hex(0xf4f7f8), 0.92 * whiteness);
    return mix(colour, sky({{ray[0], 0.02, ray[2]}}), 0.75 * far * far);
}

}  // namespace
}  // namespace at_sea

bool has_sea(const output::FrameData& frame) { return frame.particles.count(surface_set_name) > 0; }

Canvas draw_sea(const View& view) {
    using namespace at_sea;
    const GridView& g = view.frame.grid;
    const bool repeats = view.scene.root().text_or("waves.model", "") == "spectrum";
    const Tile tile(view, repeats);
    const Box box{{{g.origin[0], g.origin[1], g.origin[2]}}, sim::upper_corner(g)};
    real mean = 0, square = 0, top = -infinity;
    const auto count = static_cast<real>(tile.nx()) * static_cast<real>(tile.nz());
    for (int k = 0; k < tile.nz(); ++k)
        for (int i = 0; i < tile.nx(); ++i) {
            const real y = tile.at(i, k).place[1];
            mean += y / count, square += y * y / count, top = std::max(top, y);
        }
    const real rms = std::sqrt(std::max(1e-300, square - mean * mean));
    const Eye eye(tile, {{{box.min[0], mean, box.min[2]}}, {{box.max[0], top, box.max[2]}}}, view.size * oversampling);
    Screen screen(eye);
    const int sideways = repeats ? 3 : 0, away = repeats ? 6 : 0, last = repeats ? 0 : 1, bands = 16;
    parallel_for(0, bands, [&](int band) {
        const int from = eye.height * band / bands, to = eye.height * (band + 1) / bands;
        for (int tz = -away; tz <= 0; ++tz)
            for (int tx = -sideways; tx <= sideways; ++tx)
                for (int k = 0; k < tile.nz() - last; ++k)
                    for (int i = 0; i < tile.nx() - last; ++i) {
                        const int x = i + tx * tile.nx(), z = k + tz * tile.nz();
                        const Corner a = tile.at(x, z), b = tile.at(x + 1, z), c = tile.at(x + 1, z + 1), d = tile.at(x, z + 1);
                        screen.draw({a, b, c}, from, to);
                        screen.draw({a, c, d}, from, to);
                    }
    });
    const real horizon = 1.0 * (away + 1) * tile.size()[2];
    Canvas canvas(eye.width, eye.height);
    parallel_for(0, eye.height, [&](int y) {
        for (int x = 0; x < eye.width; ++x) {
            const Vec<3> ray = eye.ray(x + 0.5, y + 0.5);
            const Pixel& at = screen.at(x, y);
            canvas.at(x, y) =
                at.near > 0 ? shade(at, ray, (at.place[1] - mean) / rms, repeats ? std::min(1.0, 1 / (at.near * horizon)) : 0) : sky(ray);
        }
    });
    return canvas.smaller(oversampling);
}

}  // namespace weir::picture
