// Everything that a MAC solver carries from step to step: velocity, pressure, what each cell is, solids on faces, carried fields.
#pragma once
#include "core/checkpoint.hpp"
#include "core/effects.hpp"
#include "core/grid.hpp"
#include "geometry/sides.hpp"
#include "poisson/poisson.hpp"
#include "scene/scene.hpp"
#include "staggered/ghosts.hpp"
#include "staggered/velocity.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::staggered {

/// A cell whose value a source holds.
struct Held {
    std::size_t cell;
    real value;
};

template <int D>
struct NamedField {
    std::string name;
    Grid<real, D> values;
    Padded<D> before;          // as it was when the (sub)step began, with ghosts; allocated by solvers that use it
    Boundary<D> boundary;      // what the sides do to it
    std::vector<Held> held{};  // throughout this step, in the order in which they are set
    bool derived = false;      // follows from another field: not carried itself

    void hold() {
        for (const Held& h : held) values[h.cell] = h.value;
    }
};

/// The solids as the faces see them (Batty, Bertails & Bridson 2007; Ng, Min & Gibou 2009). Empty grids without solids.
template <int D>
struct SolidFaces {
    std::array<Grid<real, D>, D> open;      // fraction of the face that is open to flow, in [0, 1]
    std::array<Grid<real, D>, D> velocity;  // normal velocity of the nearest solid there [m/s]
    bool any() const { return !open[0].empty(); }
};

template <int D>
struct WallGrip;
template <int D>
class SolidWalls;

/// The state of a MAC solver. Cell fields exist only if an effect (or the scene) asked for them.
template <int D>
struct MacState {
    MacVelocity<D> u;                     // [m/s]
    Grid<real, D> p;                      // pressure [Pa]
    Grid<poisson::Cell, D> cells;         // fluid, solid (air: only with a free surface)
    PaddedVelocity<D> before;             // u as it was when the (sub)step began, with ghosts; allocated by solvers that use it
    std::array<Boundary<D>, D> boundary;  // what the sides do to each component of u
    SolidFaces<D> solid;                  // allocated only if the scene has solids
    std::vector<NamedField<D>> fields;    // carried by the flow
    std::vector<NamedField<D>> scratch;
    geometry::Sides<D> sides;
    /// How far a face follows the pressure, in [0, 1]; empty: all of them do, as long as nothing has held one back.
    std::array<Grid<real, D>, D> mobility;
    WallGrip<D>* grip = nullptr;  // where the fluid sticks to bodies; none: nowhere
    const SolidWalls<D>* walls = nullptr;  // of solids, as viscosity meets them; none: there are none, or no viscosity
    real rho = 1;                 // density [kg/m³]
    real nu = 0;                  // kinematic viscosity [m²/s]; acts only through the effect "viscosity"
    real time = 0;                // [s]

    MacState() = default;
    MacState(const scene::Scene& scene, const FieldPlan& plan);

    const Index<D>& extent() const { return u.cells; }
    /// The carried field, or nullptr where nothing asked for it.
    Grid<real, D>* find(std::string_view name);
    const Grid<real, D>* find(std::string_view name) const;
    /// The carried field; asking for one that does not exist is a programming error.
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

}  // namespace weir::staggered
