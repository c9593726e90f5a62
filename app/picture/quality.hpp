// Pictures as a camera would take them, on the processor: water that bends, mirrors and swallows light, smoke that shades itself, under a
// sky and on a floor. No chance is in them: the same frame is the same picture, for any number of threads.
#pragma once
#include "app/picture/solids.hpp"
#include "app/picture/stage.hpp"
#include "app/picture/view.hpp"

namespace weir::picture {

/// 16 to 9; view.size is the width.
Canvas draw_quality(const View& view);

/// What is around the fluid: an endless floor, a sky with a sun in it, and the scene's solids and bodies.
class Surroundings {
public:
    Surroundings(const View& view, const Box& domain);
    struct Hit {
        real distance = infinity;
        Vec<3> normal{};
        Colour albedo{};
        bool lit = false;  // something solid; else the sky, of colour albedo
    };
    Hit first(const Ray& ray) const;
    /// Between a point and the sun, apart from the fluid.
    bool in_shadow(const Vec<3>& x) const;
    Colour sky(const Vec<3>& direction) const;
    static Vec<3> to_sun();
    static Colour sun() { return {{2.7, 2.5, 2.2}}; }
    /// Light that comes from all of the sky onto a surface.
    static Colour ambient(const Vec<3>& normal);
    /// What reflects from a surface where `share` of the sun arrives, paled by the air before it.
    Colour shade(const Hit& hit, const Ray& ray, const Colour& share) const;

private:
    Colour floor(const Vec<3>& x) const;
    Box domain_;
    real size_;  // of the domain
    SolidRays solids_;
};

/// A camera of 16 to 9 that sees the whole domain.
struct WideCamera {
    Vec<3> eye, right, up, forward;
    real tangent = 0;  // of half the field of view along the width
    int width = 0, height = 0;
    WideCamera(const Box& domain, int width);
    Ray ray(real x, real y) const;
};

Canvas draw_quality_water(const View& view, const Box& domain);

}  // namespace weir::picture
