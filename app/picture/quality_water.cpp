// Water as triangles: at each crossing a ray is split into what is mirrored and what is bent (Fresnel's and Snell's laws, Whitted 1980),
// and inside the water light is swallowed by its path (Beer's law). Where the surface is torn there is foam.
#include "app/picture/liquid.hpp"
#include "app/picture/quality.hpp"
#include "app/picture/rays.hpp"
#include "core/parallel.hpp"
#include "surfaces/reconstruction.hpp"

namespace weir::picture {

namespace {

constexpr real water_index = 1.333;
/// Rays a pixel along each axis; crossings that a ray is followed through; shares of light too small to follow.
constexpr int rays = 2, deepest = 9;
constexpr real faintest = 0.01;
/// Water closer than this to the floor or a solid touches it: no air is between them. In sizes of the domain.
constexpr real touching = 1e-3;

/// What is seen of a surface beside its shape: how torn it is at each point, 0 to 1, and normals without the bumps of single particles.
struct Look {
    std::vector<real> foam;
    std::vector<Vec<3>> normals;
};

/// Torn: normals around a point disagree, and the water is fast. Elsewhere light sees their mean (as Loeschner et al. 2023 smooth theirs).
Look look_of(const SurfaceMesh& mesh, real fast) {
    Look look{std::vector<real>(mesh.points.size(), 0.0), mesh.normals};
    std::vector<Vec<3>>& mean = look.normals;
    for (int pass = 0; pass < 3; ++pass) {  // over three rings of triangles
        std::vector<Vec<3>> sum(mean.size());
        std::vector<real> count(mean.size(), 0.0);
        for (const auto& t : mesh.corners)
            for (const int c : t) {
                for (const int o : t) sum[static_cast<std::size_t>(c)] += mean[static_cast<std::size_t>(o)];
                count[static_cast<std::size_t>(c)] += 3;
            }
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = sum[i] / std::max(1.0, count[i]);
    }
    for (std::size_t i = 0; i < mean.size(); ++i) {
        const real speed = mesh.velocity.empty() ? 0 : norm(mesh.velocity[i]);
        const real torn = std::clamp((1 - norm(mean[i]) - 0.08) / 0.25, 0.0, 1.0);
        look.foam[i] = torn * std::clamp(speed / fast - 0.4, 0.0, 1.0);
        mean[i] = mean[i] + std::clamp(3 * torn, 0.0, 1.0) * (mesh.normals[i] - mean[i]);
    }
    return look;
}

class WaterPicture {
public:
    WaterPicture(const View& view, const Box& domain, const SurfaceMesh& mesh)
        : around_(view, domain), rays_(mesh), size_(norm(domain.max - domain.min)) {
        const Vec<3> extent = domain.max - domain.min;
        const real scale = 0.5 * std::max({extent[0], extent[1], extent[2]});
        // A tank of any size is given the colour of a lake a few metres deep: water of a metre is clear, and its shape cannot be seen.
        swallowed_ = (1 / scale) * Colour{{4.6, 1.35, 0.62}};
        look_ = look_of(mesh, std::sqrt(9.81 * extent[1]) * 0.6);
    }

    Colour look(const Ray& ray) const { return follow(ray, 0, 1); }

private:
    Colour follow(const Ray& ray, int crossed, real share) const {
        const MeshRays::Hit hit = rays_.first(ray, 2e-5 * size_);
        const Surroundings::Hit behind = around_.first(ray);
        if (!hit || hit.distance >= behind.distance - touching * size_)
            return around_.shade(behind, ray, behind.lit ? sun_at(ray.at(behind.distance)) : Colour{});
        const bool inside = dot(rays_.flat_normal(hit), ray.direction) > 0;
        const Colour crossing = cross(ray, hit, inside, crossed, share);
        return inside ? through(crossing, hit.distance) : crossing;
    }

    /// Light that has come so far through water, and what water scatters towards the eye on the way.
    Colour through(const Colour& light, real path) const {
        Colour left;
        for (int c = 0; c < 3; ++c) left[c] = std::exp(-swallowed_[c] * path);
        return times(left, light) + 0.7 * times(Colour{{1, 1, 1}} - left, hex(0x1d83b4));
    }

    Colour cross(const Ray& ray, const MeshRays::Hit& hit, bool inside, int crossed, real share) const {
        const Vec<3> x = ray.at(hit.distance), flat = rays_.flat_normal(hit);
        Vec<3> n = rays_.at(hit, look_.normals);
        n = n / std::max(norm(n), 1e-9);
        if (dot(n, ray.direction) * dot(flat, ray.direction) <= 0) n = flat;  // a smooth normal that looks away from the ray
        if (inside) n = -n;
        const real ratio = inside ? water_index : 1 / water_index, cosine = std::min(1.0, -dot(n, ray.direction));
        const real sine2 = ratio * ratio * (1 - cosine * cosine);
        const real mirrored = sine2 >= 1 ? 1 : fresnel(cosine, std::sqrt(1 - sine2), ratio);
        Colour colour{};
        const bool follow_more = crossed < deepest;
        const Ray mirror{x, ray.direction + (2 * cosine) * n};
        if (mirrored * share > faintest || mirrored > 0.5)
            colour += mirrored * (follow_more ? follow(mirror, crossed + 1, share * mirrored) : around_.sky(mirror.direction));
        else
            colour += mirrored * around_.sky(mirror.direction);
        if (mirrored < 1) {
            const Ray bent{x, ratio * ray.direction + (ratio * cosine - std::sqrt(1 - sine2)) * n};
            const bool more = follow_more && (1 - mirrored) * share > faintest;
            colour += (1 - mirrored) * (more ? under(bent, !inside, crossed + 1, share * (1 - mirrored)) : hex(0x2f6f8f));
        }
        const real foam = std::max(0.0, rays_.at(hit, look_.foam));
        if (foam <= 0 || inside) return colour;
        const real lit = std::max(0.0, 0.3 + 0.7 * dot(flat, Surroundings::to_sun()));
        return mix(colour, hex(0xf4f8fa), 0.0) +
               foam * 0.8 * (0.75 * Surroundings::ambient(flat) + (0.22 * lit) * Surroundings::sun() - colour);
    }

    /// A ray that has just entered or left the water.
    Colour under(const Ray& ray, bool in_water, int crossed, real share) const {
        if (!in_water) return follow(ray, crossed, share);
        const MeshRays::Hit hit = rays_.first(ray, 2e-5 * size_);
        const Surroundings::Hit behind = around_.first(ray);
        if (hit && hit.distance < behind.distance - touching * size_)
            return follow(ray, crossed, share);  // on to the other side of the water
        // the floor or a solid
        return through(around_.shade(behind, ray, behind.lit ? sun_at(ray.at(behind.distance)) : Colour{}),
                       std::min(behind.distance, size_));
    }

    /// Fresnel's equations, for light of both polarisations.
    static real fresnel(real cosine, real bent, real ratio) {
        const real across = (ratio * cosine - bent) / (ratio * cosine + bent), along = (ratio * bent - cosine) / (ratio * bent + cosine);
        return 0.5 * (across * across + along * along);
    }

    /// Share of the sun that arrives: straight on through water, swallowed by its path there.
    Colour sun_at(const Vec<3>& x) const {
        if (around_.in_shadow(x)) return {};
        const Ray ray{x, Surroundings::to_sun()};
        Colour share{{1, 1, 1}};
        real from = 2e-4 * size_, entered = 0;
        bool any = false;
        for (int i = 0; i < 6; ++i) {
            const MeshRays::Hit hit = rays_.first(ray, from);
            if (!hit) break;
            const bool leaves = dot(rays_.flat_normal(hit), ray.direction) > 0;
            if (leaves)
                for (int c = 0; c < 3; ++c) share[c] *= std::exp(-swallowed_[c] * (hit.distance - entered));
            else
                entered = hit.distance;
            const real foam = std::clamp(rays_.at(hit, look_.foam), 0.0, 1.0);
            share = (1 - 0.3 * foam) * share;
            from = hit.distance + 2e-4 * size_, any = true;
        }
        return any ? 0.8 * share : share;
    }

    Surroundings around_;
    MeshRays rays_;
    real size_;
    Colour swallowed_{};
    Look look_;
};

}  // namespace

Canvas draw_quality_water(const View& view, const Box& domain) {
    const FieldSet fields = fields_of(view.frame, view.scene);
    surfaces::Reconstruction maker(options_for(view, fields), view.scene);
    const WaterPicture picture(view, domain, maker.make(fields, view.frame.time));
    const WideCamera camera(domain, view.size);
    Canvas canvas(camera.width * rays, camera.height * rays);
#pragma omp parallel for schedule(dynamic, 4) num_threads(threads())
    for (int y = 0; y < canvas.height(); ++y)
        for (int x = 0; x < canvas.width(); ++x) {
            const Colour seen = picture.look(camera.ray((x + 0.5) / rays, (y + 0.5) / rays));
            for (int c = 0; c < 3; ++c) canvas.at(x, y)[c] = std::min(seen[c], 1.5);  // the sun in a drop does not shine through its pixel
        }
    return canvas.smaller(rays);
}

}  // namespace weir::picture
