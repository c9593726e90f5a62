#include "app/picture/quality.hpp"

#include "app/picture/media.hpp"
#include "core/parallel.hpp"

namespace weir::picture {

namespace {

Vec<3> cross_product(const Vec<3>& a, const Vec<3>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

Vec<3> of_length_one(const Vec<3>& a) { return a / norm(a); }

/// Rays a pixel along each axis.
constexpr int smoke_rays = 2;

/// The floor is the sky's colour beyond so many sizes of the domain: no horizon cuts the picture.
constexpr real haze = 9;

Canvas draw_quality_smoke(const View& view) {
    const Smoke medium(view, Surroundings::to_sun());
    const WideCamera camera(medium.box(), view.size);
    const Surroundings around(view, medium.box());
    Canvas canvas(camera.width * smoke_rays, camera.height * smoke_rays);
#pragma omp parallel for schedule(dynamic, 4) num_threads(threads())
    for (int y = 0; y < canvas.height(); ++y)
        for (int x = 0; x < canvas.width(); ++x) {
            const Ray ray = camera.ray((x + 0.5) / smoke_rays, (y + 0.5) / smoke_rays);
            canvas.at(x, y) = medium.look_among(ray, around);
        }
    return canvas.smaller(smoke_rays);
}

}  // namespace

WideCamera::WideCamera(const Box& domain, int w) : tangent(0.42), width(w), height(w * 9 / 16) {
    const Vec<3> centre = 0.5 * (domain.min + domain.max), extent = domain.max - domain.min;
    const Vec<3> from = of_length_one({{0.5, 0.40, 1.0}});
    forward = -from;
    right = of_length_one(cross_product(forward, {{0, 1, 0}}));
    up = cross_product(right, forward);
    // as far as every corner needs to be inside the picture, with a twentieth of room
    real away = 0;
    for (int bits = 0; bits < 8; ++bits) {
        const Vec<3> corner = Vec<3>{{bits & 1 ? 0.5 : -0.5, bits & 2 ? 0.5 : -0.5, bits & 4 ? 0.5 : -0.5}};
        const Vec<3> d{{corner[0] * extent[0], corner[1] * extent[1], corner[2] * extent[2]}};
        const real across = std::max(std::abs(dot(d, right)), std::abs(dot(d, up)) * 16 / 9);
        away = std::max(away, 1.05 * across / tangent - dot(d, forward));
    }
    eye = centre + away * from;
}

Ray WideCamera::ray(real x, real y) const {
    const real scale = 2 * tangent / width;
    return {eye, of_length_one(forward + (scale * (x - 0.5 * width)) * right - (scale * (y - 0.5 * height)) * up)};
}

Surroundings::Surroundings(const View& view, const Box& domain)
    : domain_(domain), size_(norm(domain.max - domain.min)), solids_(view, domain) {}

Vec<3> Surroundings::to_sun() { return of_length_one({{-0.55, 0.75, 0.35}}); }

Colour Surroundings::ambient(const Vec<3>& normal) { return mix(hex(0x9a958c), hex(0xc4d8ee), 0.5 + 0.5 * normal[1]); }

Colour Surroundings::sky(const Vec<3>& direction) const {
    const real high = std::clamp(direction[1], 0.0, 1.0);
    const Colour base = mix(hex(0xeef3f6), hex(0x5b92cf), std::pow(high, 0.55));
    const real towards = std::max(0.0, dot(direction, to_sun()));
    return base + (0.35 * std::pow(towards, 24) + 12 * std::pow(towards, 1500)) * hex(0xfff0d0);
}

Colour Surroundings::floor(const Vec<3>& x) const {
    const real tile = size_ / 14;
    const auto number = [&](int a) { return static_cast<long>(std::floor((x[a] - domain_.min[a]) / tile)); };
    const bool inside = x[0] > domain_.min[0] && x[0] < domain_.max[0] && x[2] > domain_.min[2] && x[2] < domain_.max[2];
    const bool odd = ((number(0) + number(2)) & 1) != 0;
    return !inside ? hex(0xc9c6c0) : odd ? hex(0xc4bcb0) : hex(0xdcd5ca);
}

Surroundings::Hit Surroundings::first(const Ray& ray) const {
    Hit hit;
    if (ray.direction[1] < 0) {
        const real s = (domain_.min[1] - ray.origin[1]) / ray.direction[1];
        if (s > 1e-7 * size_) hit = {s, {{0, 1, 0}}, floor(ray.at(s)), true};
    }
    if (const auto solid = solids_.first(ray, hit.distance))
        hit = {solid.distance, solid.normal, solid.coloured ? solid.colour : hex(0xd98f4e), true};
    if (!hit.lit) hit.albedo = sky(ray.direction);
    return hit;
}

bool Surroundings::in_shadow(const Vec<3>& x) const {
    return static_cast<bool>(solids_.first({x + 1e-4 * size_ * to_sun(), to_sun()}, infinity));
}

Colour Surroundings::shade(const Hit& hit, const Ray& ray, const Colour& share) const {
    if (!hit.lit) return hit.albedo;
    const real facing = std::max(0.0, dot(hit.normal, to_sun()));
    const Colour seen = times(hit.albedo, 0.55 * ambient(hit.normal) + (facing * 0.32) * times(share, sun()));
    const real clear = std::exp(-std::pow(hit.distance / (haze * size_), 2));
    const Vec<3> level{{ray.direction[0], 0, ray.direction[2]}};
    return mix(sky(level / std::max(norm(level), 1e-9)), seen, clear);
}

Canvas draw_quality(const View& view) {
    if (view.field != "water") return draw_quality_smoke(view);
    Box domain;
    domain.min = view.scene.vec<3>("grid.origin");
    domain.max = domain.min + view.scene.vec<3>("grid.size");
    return draw_quality_water(view, domain);
}

}  // namespace weir::picture
