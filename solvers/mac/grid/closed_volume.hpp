// Solvability of the incompressible projection. A fluid region without open side or free surface keeps its volume only if solids and sides
// sweep equal volumes into and out of it. Summed over the region its inner faces cancel, so
//     d(volume)/dt = Σ_faces (1 − w) u_solid·n + Σ_sides u·n       [n out of the fluid]
// violates the compatibility condition of the pressure. For rigid solids wholly inside the region it is zero to round-off, for any motion.
#pragma once
#include "core/error.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "mac/grid/state.hpp"

#include <optional>
#include <string>

namespace weir::mac {

/// A region whose volume changes; without cells: there is none.
template <int D>
struct Squeezed {
    real growth = 0, volume = 0;  // [m^D/s], [m^D]
    real all = 0;                 // volume of all fluid [m^D]
    std::size_t cells = 0, solid = 0;
    Vec<D> middle{};
    bool any() const { return cells > 0; }
};

/// The region whose volume changes fastest, with the solid that contributes most; only regions of more than a hundredth of the fluid. In
/// parallel: the fluid as a whole.
template <int D>
Squeezed<D> find_squeezed(const MacState<D>& s, const geometry::Solids<D>& solids);

/// "... shrinks by 0.5 m^2/s ...", for error messages.
template <int D>
std::string text_of(const Squeezed<D>& region);

/// Returns whether any solid has a prescribed motion.
template <int D>
bool move_as_prescribed(const geometry::Solids<D>& solids);

/// Throws NumericalFailure where there is such a region and a step dt has left a `divergence` [1/s] that it may have caused. The pressure
/// of a region that free bodies close off is known up to a constant and does not hold them: what they change of it is at most a thousandth
/// of all fluid in a step. `in_films`: what bodies and solids drive through films too thin for the grid, which is not lost [m^D/s];
/// nullopt: the solver has none, and heaps of bodies squeeze its pockets, so free bodies are not asked.
template <int D>
void require_room(const MacState<D>& s, const SolidPlacement<D>& solids, real divergence, real dt, std::optional<real> in_films = {});

/// Returns f(); where it fails because of such a region, the failure says so.
template <int D, class F>
decltype(auto) explained_by_room(const MacState<D>& s, const SolidPlacement<D>& solids, F&& f) {
    try {
        return f();
    } catch (const NumericalFailure&) {
        require_room(s, solids, infinity, infinity);
        throw;
    }
}

}  // namespace weir::mac
