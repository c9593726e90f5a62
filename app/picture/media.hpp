// Fluids as seen along a ray in 3D: smoke as an absorbing, scattering medium; water as the smooth surface around its markers.
#pragma once
#include "app/picture/stage.hpp"

namespace weir::picture {

class Surroundings;

/// One light, single scattering: what a ray collects is the light that reaches each point through the smoke, times what is scattered
/// there, times what survives to the eye (Kajiya & Von Herzen 1984).
class Smoke {
public:
    explicit Smoke(const View& view, const Vec<3>& towards_light = Stage::light());
    Colour look(const Ray& ray, const Stage& stage) const;
    /// In daylight, brighter smoke on a floor that it shades.
    Colour look_among(const Ray& ray, const Surroundings& around) const;
    const Box& box() const { return density_.box; }

private:
    real light_at(const Vec<3>& x) const { return light_.at(x); }
    Volume density_, light_;  // optical density [1/m]; share of the light that arrives
    real step_;               // [m]
};

class Water {
public:
    explicit Water(const View& view);
    Colour look(const Ray& ray, const Stage& stage) const;
    const Box& box() const { return density_.box; }

private:
    /// Where the density next crosses the surface value on the ray; infinity where it does not.
    real next_surface(const Ray& ray, real from, real to) const;
    Vec<3> normal(const Vec<3>& x) const;
    Volume density_;  // sum of the markers' kernels
    real cell_;       // of the simulation [m]
};

}  // namespace weir::picture
