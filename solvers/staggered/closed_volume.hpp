// Whether incompressible fluid has where to go: a region of it that no open side and no free surface bounds keeps its volume only if what
// solids and sides sweep into it they sweep out elsewhere. Summed over the region its own faces cancel, so that
//     d(room)/dt = Σ_faces (1 − w) u_solid·n + Σ_sides u·n       [n out of the fluid]
// is what no pressure can make good. Of rigid solids wholly inside it is zero to round-off, whatever they do.
#pragma once
#include "core/error.hpp"
#include "staggered/solid_faces.hpp"
#include "staggered/state.hpp"

#include <string>

namespace weir::staggered {

/// A region whose room changes; no cells: there is none.
template <int D>
struct Squeezed {
    real growth = 0, volume = 0;  // [m^D/s], [m^D]
    std::size_t cells = 0, solid = 0;
    Vec<D> middle{};
    bool any() const { return cells > 0; }
};

/// The region whose room changes fastest, with the solid that changes it most; of regions of more than a hundredth of the fluid. Over ranks
/// the fluid as a whole.
template <int D>
Squeezed<D> find_squeezed(const MacState<D>& s, const geometry::Solids<D>& solids);

/// "... shrinks by 0.5 m^2/s ...", for messages.
template <int D>
std::string text_of(const Squeezed<D>& region);

/// Whether any moves by a motion of the scene; free bodies make room by themselves.
template <int D>
bool move_as_told(const geometry::Solids<D>& solids);

/// Throws NumericalFailure where there is one and a step has left `divergence` [1/s] that it may have caused.
template <int D>
void require_room(const MacState<D>& s, const SolidPlacement<D>& solids, real divergence);

/// What f() answers; where it fails for want of room, that is what the failure says.
template <int D, class F>
decltype(auto) explained_by_room(const MacState<D>& s, const SolidPlacement<D>& solids, F&& f) {
    try {
        return f();
    } catch (const NumericalFailure&) {
        require_room(s, solids, infinity);
        throw;
    }
}

}  // namespace weir::staggered
