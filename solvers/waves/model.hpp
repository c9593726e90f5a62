// The interface of procedural waves: the motion of any point of the surface, and of the water below it, at any time.
#pragma once
#include "waves/sheet.hpp"

#include <memory>
#include <optional>
#include <string>

namespace weir::waves {

class Model {
public:
    virtual ~Model() = default;
    /// Sets the time of all following calls [s]; any time is allowed, since there are no steps.
    virtual void set_time(real t) = 0;
    /// Returns whether surface points also move horizontally, so that the surface can fold.
    virtual bool sideways() const { return false; }
    /// Height of the surface at rest [m], where the scene does not give it.
    virtual std::optional<real> level() const { return std::nullopt; }
    /// Motion of the surface point with rest position (x, z), at the mean level.
    virtual Motion motion(real x, real z) const = 0;
    /// The same for a particle with any rest position, y relative to the mean level; false: not supported by the model.
    virtual bool particle(const Vec<3>& /*rest*/, Motion& /*of*/) const { return false; }
    /// Velocity of the water at a point; y relative to the mean level.
    virtual Vec<3> velocity(const Vec<3>& at) const = 0;
    /// Fills the sheet, point by point unless a model overrides it; in parallel at least this rank's rows.
    virtual void fill(const Box& box, Sheet& sheet);
    /// Velocities at the grid's cells, cell by cell unless a model overrides it; in parallel at least for this rank's rows and layers.
    virtual void fill_water(const Box& box, real level, std::array<Values, 3>& velocity);
    virtual std::size_t bytes() const { return 0; }
    /// Fraction of the scene's variance that the resolved waves contain.
    virtual real carried() const { return 1; }
};

/// The rest position of the surface point at (x, z): by Newton's method unless the surface is about to fold. Where it is folded, one of
/// several solutions.
Vec<2> rest_of(const Model& model, real x, real z);

/// Constructs the model of the scene's table "waves".
std::unique_ptr<Model> make_model(const scene::Scene& scene, const Box& box);

}  // namespace weir::waves
