// The state of a MAC solver: velocity, pressure, cell flags, solids on faces, advected fields.
#pragma once
#include "core/checkpoint.hpp"
#include "core/effects.hpp"
#include "geometry/sides.hpp"
#include "mac/grid/ghosts.hpp"
#include "mac/grid/velocity.hpp"
#include "parallel/grid.hpp"
#include "poisson/poisson.hpp"
#include "scene/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::mac {

/// A cell with a value prescribed by a source.
struct Held {
    std::size_t cell;
    real value;
};

template <int D>
struct NamedField {
    std::string name;
    Grid<real, D> values;
    Padded<D> before;          // at the start of the (sub)step, with ghosts; allocated by solvers that use it
    Boundary<D> boundary;      // boundary conditions of the sides
    std::vector<Held> held{};  // during this step, in the order in which they are set
    bool derived = false;      // computed from another field: not advected itself

    void enforce_sources() {
        for (const Held& h : held) values[h.cell] = h.value;
    }
};

/// Solids as face data (Batty, Bertails & Bridson 2007; Ng, Min & Gibou 2009). Empty grids without solids.
template <int D>
struct SolidFaces {
    std::array<Grid<real, D>, D> open;      // fraction of the face that is open to flow, in [0, 1]
    std::array<Grid<real, D>, D> velocity;  // normal velocity of the nearest solid there [m/s]
    bool any() const { return !open[0].empty(); }
};

template <int D>
struct NoSlipWalls;
template <int D>
class SolidWalls;

/// The state of a MAC solver. Cell fields exist only if an effect or the scene requests them.
template <int D>
struct MacState {
    MacVelocity<D> u;                     // [m/s]
    Grid<real, D> p;                      // pressure [Pa]
    Grid<poisson::Cell, D> cells;         // fluid, solid (air: only with a free surface)
    PaddedVelocity<D> before;             // u at the start of the (sub)step, with ghosts; allocated by solvers that use it
    std::array<Boundary<D>, D> boundary;  // boundary conditions of each component of u
    SolidFaces<D> solid;                  // allocated only if the scene has solids
    std::vector<NamedField<D>> fields;    // advected by the flow
    std::vector<NamedField<D>> scratch;
    geometry::Sides<D> sides;
    /// The factor of the pressure gradient on each face, in [0, 1]; empty: 1 everywhere, as long as no drag acts.
    std::array<Grid<real, D>, D> mobility;
    NoSlipWalls<D>* no_slip_walls = nullptr;  // no-slip walls of bodies; nullptr: none
    const SolidWalls<D>* walls = nullptr;     // walls of solids for viscosity; nullptr: no solids or no viscosity
    real rho = 1;                             // density [kg/m³]
    real nu = 0;                              // kinematic viscosity [m²/s]; acts only through the effect "viscosity"
    real time = 0;                            // [s]
    int reach = ghost_layers;                 // in parallel: number of ghost planes that the present step reads

    MacState() = default;
    /// `slab`: the planes of this rank; nullptr: all.
    MacState(const scene::Scene& scene, const FieldPlan& plan, const Slab* slab = nullptr);

    const Extent<D>& extent() const { return u.cells; }
    /// The planes of this rank.
    const OwnPlanes& own() const { return u.cells.own; }
    /// The advected field, or nullptr where it was not requested.
    Grid<real, D>* find(std::string_view name);
    const Grid<real, D>* find(std::string_view name) const;
    /// The advected field; it must exist (precondition).
    Grid<real, D>& operator[](std::string_view name) { return field(name).values; }
    NamedField<D>& field(std::string_view name);
    Grid<real, D>& scratch_field(std::string_view name);
    void allocate_solids();

    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const;
};

/// Cells, cell size and origin of a scene's grid.
template <int D>
struct Lattice {
    Index<D> cells{};
    Vec<D> h{}, origin{};
    explicit Lattice(const scene::Scene& scene);
};

}  // namespace weir::mac
