// Joints between two bodies, or a body and the world: hinges, sliders, and mooring lines. They are velocity constraints in the metric of
// contacts, solved together with them. Position errors are corrected in the next step (a Newton step on the SHAKE equations, Ryckaert,
// Ciccotti & Berendsen 1977). The spring of a line uses the mean of the positions before and after the step, its damper those at the end,
// as a soft constraint (Catto 2011; rows.cpp). So stiffness does not limit the step, and oscillations without damping persist.
#pragma once
#include "rigid/rows.hpp"
#include "scene/schema.hpp"

#include <vector>

namespace weir::rigid {

/// The keys of solvers with bodies.
scene::Key joints_key();

enum class JointKind { hinge, slider, mooring };

template <int D>
struct Joint {
    JointKind kind = JointKind::hinge;
    std::size_t body = 0;
    std::ptrdiff_t other = -1;        // −1: the world
    Vec<D> at{}, anchor{};            // on the body and on the other side, at the scene's initial positions [m]
    Vec<D> axis{};                    // of the other side, unit length
    real length = 0;                  // rest length [m]
    real stiffness = 0, damping = 0;  // [N/m], [N s/m]; in 2D per metre of depth
};

template <int D>
class Joints {
public:
    Joints() = default;
    /// From the scene's list; throws BadScene for invalid entries.
    Joints(const scene::Scene& scene, const std::vector<Body<D>>& bodies);

    bool empty() const { return list_.empty(); }
    const std::vector<Joint<D>>& all() const { return list_; }
    /// Returns whether a hinge or a slider connects these two.
    bool tie(std::size_t a, std::size_t b) const;
    /// Appends their rows at the bodies' present positions, for a step dt.
    void add_rows(const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const;
    /// Marks bodies with hinges and sliders: they are not in free motion.
    void mark(std::vector<Body<D>>& bodies) const;
    /// Both ends of a joint at present.
    std::array<Vec<D>, 2> ends(const Joint<D>& joint, const std::vector<Body<D>>& bodies) const;

private:
    void read(const scene::Scene& scene, std::size_t number, const std::vector<Body<D>>& bodies);
    void hold_point(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const;
    void hold_axis(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const;
    void slide(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const;
    void hold_turning(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const;
    void pull(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const;

    std::vector<Joint<D>> list_;
};

}  // namespace weir::rigid
