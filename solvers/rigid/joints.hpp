// Joints between two bodies, or a body and the world: hinges, sliders, and lines that moor. They are constraints on velocities in the
// metric of contacts, solved with them. What positions are off by is undone in the next step (a step of Newton on SHAKE's equations,
// Ryckaert, Ciccotti & Berendsen 1977). The spring of a line is taken in the middle of places before and after the step, its damper at the
// end, as a soft constraint (Catto 2011; rows.cpp), so that no stiffness limits the step and a swing without damping goes on.
#pragma once
#include "rigid/rows.hpp"
#include "scene/schema.hpp"

#include <vector>

namespace weir::rigid {

/// What solvers that carry bodies add to their keys.
scene::Key joints_key();

enum class JointKind { hinge, slider, mooring };

template <int D>
struct Joint {
    JointKind kind = JointKind::hinge;
    std::size_t body = 0;
    std::ptrdiff_t other = -1;        // −1: the world
    Vec<D> at{}, anchor{};            // on the body and on the other side, where the scene puts them [m]
    Vec<D> axis{};                    // of the other side, unit length
    real length = 0;                  // without tension [m]
    real stiffness = 0, damping = 0;  // [N/m], [N s/m]; in 2D per metre of depth
};

template <int D>
class Joints {
public:
    Joints() = default;
    /// From the scene's list; refuses what cannot be (BadScene).
    Joints(const scene::Scene& scene, const std::vector<Body<D>>& bodies);

    bool empty() const { return list_.empty(); }
    const std::vector<Joint<D>>& all() const { return list_; }
    /// Whether a hinge or a slider holds these two together.
    bool tie(std::size_t a, std::size_t b) const;
    /// Appends their rows at the bodies' places, for a step dt.
    void add_rows(const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const;
    /// Bodies that hinges and sliders hold do not fly freely.
    void mark(std::vector<Body<D>>& bodies) const;
    /// Both ends of a joint now.
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
