// The liquid's velocity inside solids, where markers and the surface beside them look: continued from the liquid, without what would
// flow through the solid's surface (constrained extrapolation: Houston, Bond & Wiebe 2003; Rasmussen et al. 2004; Bridson 2015). What
// stands there before and after the pressure is made in one way, so that FLIP's difference is that of the liquid's own velocity.
#pragma once
#include "geometry/solids.hpp"
#include "staggered/solid_faces.hpp"
#include "staggered/state.hpp"
#include "surface/extrapolate.hpp"

namespace weir::surface {

/// Faces that are closed by solids, or nearly so, as deep as interpolation beside a solid looks.
template <int D>
class FacesInSolids {
public:
    /// Of the solids as they stand, where that has changed. `room`: there is to be room for twice as many, for solids that move may come to
    /// cut more faces, so that no step allocates.
    void find(const SolidPlacement<D>& placement, const MacState<D>& state, const Frame<D>& frame, bool room);
    /// Solids that are free move at other speeds than when they were found.
    void see_velocities(const geometry::Solids<D>& solids, const MacState<D>& state);
    /// Markers reach over a solid's surface with their hats, but what they leave there is not the liquid's velocity.
    void forget(FaceMarks<D>& known) const;
    /// u −= n n·(u − u_solid) where solids slip; u = u_solid where they do not, or where no liquid is near.
    void constrain(MacVelocity<D>& u, const FaceMarks<D>& known, const Frame<D>& frame);
    const FaceLists<D>& faces() const { return faces_; }
    /// Those of them that are closed.
    const FaceLists<D>& closed() const { return closed_; }
    std::size_t bytes() const;

private:
    void forget_changed(const std::vector<CellBox<D>>& changed, int a);
    /// What a solid does to the liquid's velocity on a face inside it.
    struct SolidFace {
        Vec<D> normal, velocity;  // of the solid
        std::size_t solid = 0;    // which one
        bool no_slip = false;
        real value = 0;  // what is to stand there
    };
    FaceLists<D> faces_, closed_;                  // over ranks, those near this one's planes
    std::array<std::vector<SolidFace>, D> solid_;  // in the order of faces_
    bool any_ = false;                             // of all ranks
};

}  // namespace weir::surface
