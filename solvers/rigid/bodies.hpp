// The free bodies of a scene: its list "bodies", their output and checkpoints.
#pragma once
#include "core/solver.hpp"
#include "geometry/solids.hpp"
#include "rigid/body.hpp"
#include "rigid/contacts.hpp"
#include "scene/schema.hpp"

#include <functional>
#include <vector>

namespace weir::rigid {

/// The name of the particle set of bodies, one point per body: position of the centre of mass, velocity, angle (2D) or rotation vector
/// (3D), angular velocity, and the force and torque of the fluid.
inline constexpr const char* body_set_name = "bodies";

/// The keys of solvers with bodies: the bodies, and the probe that follows one.
scene::Key bodies_key();
scene::Key probe_key();

template <int D>
class Bodies {
public:
    Bodies() = default;
    /// From the scene's list; throws BadScene for invalid entries.
    explicit Bodies(const scene::Scene& scene);

    bool empty() const { return list_.empty(); }
    std::size_t count() const { return list_.size(); }
    Body<D>& operator[](std::size_t b) { return list_[b]; }
    const Body<D>& operator[](std::size_t b) const { return list_[b]; }
    std::vector<Body<D>>& all() { return list_; }
    const std::vector<Body<D>>& all() const { return list_; }
    const Joints<D>& joints() const { return joints_; }

    /// Appends them to the solids, in their present position.
    void join(geometry::Solids<D>& solids);
    void place(geometry::Solids<D>& solids) const;
    /// Moves them to their positions in output fields: value(field, component, body) of the particle set.
    void recall(const std::function<real(const char*, std::size_t, std::size_t)>& value);
    /// Walls of the domain and solids that they may touch.
    Surroundings<D> surroundings(const geometry::Solids<D>& solids) const;
    /// Maximum number of lengths h that a point of a body crosses per second [1/s].
    real max_rate(real h) const;

    /// Appends their particle set; the views are valid until the next call.
    void show(FieldSet& set) const;
    std::vector<Integral> integrals(const Vec<D>& gravity) const;
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const;

private:
    void read(const scene::Scene& scene, std::size_t number);

    std::vector<Body<D>> list_;
    Joints<D> joints_;
    Surroundings<D> around_;
    mutable std::vector<std::vector<real>> shown_;
};

/// All solids of a scene for drawing, with its bodies at their positions in output fields and mooring lines as thin rods; `value` as in
/// Bodies::recall.
template <int D>
class ShownSolids {
public:
    explicit ShownSolids(const scene::Scene& scene, bool lines = true);
    bool empty() const { return still_.empty() && bodies_.empty(); }
    /// The last ones are the bodies, in their order.
    const geometry::Solids<D>& at(real t, const std::function<real(const char*, std::size_t, std::size_t)>& value);

private:
    Bodies<D> bodies_;
    geometry::Solids<D> still_, solids_;
    real thin_ = 0;
};

}  // namespace weir::rigid
