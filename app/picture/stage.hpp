// What stands around the fluid in 3D pictures: camera, light, sky, floor, the solids of the scene, the edges of the domain.
#pragma once
#include "app/picture/canvas.hpp"
#include "app/picture/solids.hpp"
#include "app/picture/view.hpp"
#include "app/picture/volume.hpp"

namespace weir::picture {

/// Looks at the domain from in front, above and a little from the right: y is up, z towards the viewer.
struct Camera {
    Vec<3> eye, right, up, forward;
    real tangent;  // of half the field of view along the longer side
    int width, height;
    Camera(const Box& domain, int size);
    Ray ray(real x, real y) const;  // pixel coordinates from the top left
    Vec<2> pixel(const Vec<3>& world) const;
};

class Stage {
public:
    Stage(const View& view, const Box& domain);
    /// The first solid thing on the ray before `limit`: its distance and colour; the sky at infinity.
    struct Hit {
        real distance = infinity;
        Colour colour;
    };
    /// `shade(x)`: how much light reaches x through the fluid.
    template <class Shade>
    Hit trace(const Ray& ray, const Shade& shade) const {
        Hit hit{infinity, sky(ray.direction)};
        if (const real s = floor_distance(ray); s < hit.distance) hit = {s, shade(ray.at(s)) * floor_colour(ray.at(s))};
        if (const auto solid = solids_.first(ray, hit.distance)) hit = {solid.distance, solid_colour(solid)};
        return hit;
    }
    Colour sky(const Vec<3>& direction) const;
    static Vec<3> light();  // direction towards it

private:
    real floor_distance(const Ray& ray) const;
    Colour floor_colour(const Vec<3>& x) const;
    Colour solid_colour(const SolidRays::Hit& hit) const;

    Box domain_;
    bool dark_;  // smoke wants a dark stage
    SolidRays solids_;
};

}  // namespace weir::picture
