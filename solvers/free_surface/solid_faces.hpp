// The liquid's velocity inside solids, which markers and the surface beside them read: extrapolated from the liquid, without the normal
// component through the solid's surface (constrained extrapolation: Houston, Bond & Wiebe 2003; Rasmussen et al. 2004; Bridson 2015). It is
// computed in the same way before and after the pressure solve, so that FLIP's difference is that of the liquid's velocity.
#pragma once
#include "free_surface/extrapolate.hpp"
#include "geometry/solids.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "mac/grid/state.hpp"

namespace weir::free_surface {

/// Faces closed by solids, or nearly so, as deep as the interpolation stencil reaches.
template <int D>
class FacesInSolids {
public:
    /// Finds them for the present solids where these have changed. `room`: reserves memory for twice as many, because moving solids may cut
    /// more faces; then no step allocates.
    void find(const SolidPlacement<D>& placement, const MacState<D>& state, const Frame<D>& frame, bool room);
    /// Updates the velocities of free bodies that changed since then.
    void see_velocities(const geometry::Solids<D>& solids, const MacState<D>& state);
    /// Clears these faces: markers' hat functions extend into a solid, but the values there are not the liquid's velocity.
    void forget(FaceMarks<D>& known) const;
    /// u −= n n·(u − u_solid) for free slip; u = u_solid for no slip, or where no liquid is near.
    void constrain(MacVelocity<D>& u, const FaceMarks<D>& known, const Frame<D>& frame);
    const FaceLists<D>& faces() const { return faces_; }
    /// The closed ones among them.
    const FaceLists<D>& closed() const { return closed_; }
    std::size_t bytes() const;

private:
    void forget_changed(const std::vector<CellBox<D>>& changed, int a);
    /// The constraint of a solid on the liquid's velocity at a face inside it.
    struct SolidFace {
        Vec<D> normal, velocity;  // of the solid
        std::size_t solid = 0;    // its index
        bool no_slip = false;
        real value = 0;  // the constrained value
    };
    FaceLists<D> faces_, closed_;                  // in parallel, those near this rank's planes
    std::array<std::vector<SolidFace>, D> solid_;  // in the order of faces_
    bool any_ = false;                             // on any rank
};

}  // namespace weir::free_surface
