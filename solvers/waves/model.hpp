// What every kind of procedural wave answers: the motion of any point of the surface, and of the water below it, at any time.
#pragma once
#include "waves/sheet.hpp"

#include <memory>
#include <optional>
#include <string>

namespace weir::waves {

class Model {
public:
    virtual ~Model() = default;
    /// Everything below speaks of this time [s]. It may lie anywhere: nothing is stepped.
    virtual void set_time(real t) = 0;
    /// Whether points of the surface move sideways too, so that it can fold.
    virtual bool sideways() const { return false; }
    /// Height of the surface at rest [m], where the scene does not say it.
    virtual std::optional<real> level() const { return std::nullopt; }
    /// The point of the surface that rests at (x, z), at the mean level.
    virtual Motion motion(real x, real z) const = 0;
    /// The same of a particle that rests anywhere, y counted from the mean level; false: the model follows no particles.
    virtual bool particle(const Vec<3>& /*rest*/, Motion& /*of*/) const { return false; }
    /// Velocity of the water at a place; its y counts from the mean level.
    virtual Vec<3> velocity(const Vec<3>& at) const = 0;
    /// The sheet, point by point unless a model knows better; over ranks this rank's rows at least.
    virtual void fill(const Box& box, Sheet& sheet);
    /// Velocities at the grid's cells, cell by cell unless a model knows better; over ranks at least those of its rows and layers.
    virtual void fill_water(const Box& box, real level, std::array<Values, 3>& velocity);
    virtual std::size_t bytes() const { return 0; }
    /// What part of the variance that the scene asks for is in the waves.
    virtual real carried() const { return 1; }
};

/// The point of rest whose surface point stands at (x, z): Newton's method where the surface is not about to fold. Of a surface that is
/// folded over there, one of several.
Vec<2> rest_of(const Model& model, real x, real z);

/// As the scene's table "waves" says.
std::unique_ptr<Model> make_model(const scene::Scene& scene, const Box& box);

}  // namespace weir::waves
