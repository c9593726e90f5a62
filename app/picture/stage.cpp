#include "app/picture/stage.hpp"

namespace weir::picture {

namespace {

Vec<3> cross(const Vec<3>& a, const Vec<3>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

Vec<3> normalised(const Vec<3>& a) { return a / norm(a); }

}  // namespace

Camera::Camera(const Box& domain, int size) : tangent(0.36) {
    const Vec<3> centre = 0.5 * (domain.min + domain.max), extent = domain.max - domain.min;
    const Vec<3> from = normalised({{0.45, 0.42, 1.0}});
    forward = -from;
    right = normalised(cross(forward, {{0, 1, 0}}));
    up = cross(right, forward);
    // the picture is as wide as the domain looks, and the eye as far as its farthest corner needs
    const auto half = [&](const Vec<3>& axis) {
        return 0.5 * (std::abs(axis[0]) * extent[0] + std::abs(axis[1]) * extent[1] + std::abs(axis[2]) * extent[2]);
    };
    const real wide = half(right), high = half(up), longer = std::max(wide, high);
    width = std::max(64, static_cast<int>(size * wide / longer * 1.0));
    height = std::max(64, static_cast<int>(size * high / longer * 1.0));
    eye = centre + (half(forward) + 1.08 * longer / tangent) * from;
}

Ray Camera::ray(real x, real y) const {
    const real scale = 2 * tangent / std::max(width, height);
    return {eye, normalised(forward + (scale * (x - 0.5 * width)) * right - (scale * (y - 0.5 * height)) * up)};
}

Vec<2> Camera::pixel(const Vec<3>& world) const {
    const Vec<3> d = world - eye;
    const real scale = 2 * tangent / std::max(width, height) * dot(d, forward);
    return {{0.5 * width + dot(d, right) / scale, 0.5 * height - dot(d, up) / scale}};
}

Stage::Stage(const View& view, const Box& domain) : domain_(domain), dark_(view.field != "water"), solids_(view, domain) {}

Vec<3> Stage::light() { return normalised({{0.45, 1.0, 0.35}}); }

Colour Stage::sky(const Vec<3>& direction) const {
    const real s = std::clamp(0.5 + 0.5 * direction[1], 0.0, 1.0);
    return dark_ ? mix(hex(0x0c0f15), hex(0x1d2430), s) : mix(hex(0xb9c4cf), hex(0xf4f8fb), s);
}

real Stage::floor_distance(const Ray& ray) const {
    if (ray.direction[1] >= 0) return infinity;
    const real s = (domain_.min[1] - ray.origin[1]) / ray.direction[1];
    const Vec<3> x = ray.at(s);
    const bool under = x[0] >= domain_.min[0] && x[0] <= domain_.max[0] && x[2] >= domain_.min[2] && x[2] <= domain_.max[2];
    return s > 0 && under ? s : infinity;
}

Colour Stage::floor_colour(const Vec<3>& x) const {
    const Vec<3> extent = domain_.max - domain_.min;
    const real tile = std::max({extent[0], extent[1], extent[2]}) / 12;
    const bool odd = (static_cast<int>((x[0] - domain_.min[0]) / tile) + static_cast<int>((x[2] - domain_.min[2]) / tile)) % 2 != 0;
    return dark_ ? (odd ? hex(0x2a303a) : hex(0x333a46)) : (odd ? hex(0xc9c4ba) : hex(0xe4dfd5));
}

Colour Stage::solid_colour(const SolidRays::Hit& hit) const {
    const real lit = 0.35 + 0.65 * std::max(0.0, dot(hit.normal, light()));
    return lit * (hit.coloured ? hit.colour : hit.body ? hex(0xf0b03c) : dark_ ? hex(0xb0a494) : hex(0x9aa0a8));
}

}  // namespace weir::picture
