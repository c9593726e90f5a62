// Transport of liquid and momentum by geometric fluxes, in sweeps along one axis each (Weymouth & Yue 2010, eq. 10 to 18):
//
//     f += F(lower face) − F(upper face) + c dC,      dC = C(upper) − C(lower),   C = u dt/h,   c = [f > ½ at the start]
//
// F is the liquid that crosses a face, in cells. f stays in [0, 1] for Σ|C| ≤ ½. The last sweep takes Σ c dC back: the sum of all sweeps is
// a pure flux form, so the volume is exact for any divergence that the pressure left. Momentum is carried by the mass in the same fluxes,
// ρ_l F + ρ_g (C − F), in the control volumes of the faces (Rudman 1998; Bussmann, Kothe & Sicilian 2002).
#pragma once
#include "two_phase/fractions.hpp"

#include <cstdint>

namespace weir::two_phase {

/// Beyond this ratio between the densities of neighbouring volumes, the velocity of the lighter one says nothing of that of the heavier
/// one: it may belong to the other phase.
inline constexpr real similar = 0.1;

/// The axes of the sweeps of a step: every order in turn.
template <int D>
std::array<int, D> sweep_order(std::int64_t step);

/// Motion during a step.
template <int D>
struct Motion {
    const PaddedVelocity<D>& u;       // at the start of the step, mirrored at walls [m/s]
    const PaddedVelocity<D>& flow;    // through the open part of faces: A u; without solids u itself [m/s]
    real dt;                          // [s]
    std::array<int, D> order;         // of the sweeps
    const Padded<D>* room = nullptr;  // volumes of cells outside moving solids, which take and leave room; nullptr: nothing moves
};

/// A quantity per volume that each fluid carries for itself, such as its temperature. Entry 0 is of the liquid, entry 1 of the gas.
template <int D>
struct PhaseValues {
    std::array<Grid<real, D>, 2> values;  // in cells without the fluid: without meaning
    std::array<Padded<D>, 2> padded;      // scratch of the transport
    std::array<Grid<real, D>, 2> flux;    // likewise, with the extents of Transport::flux_extent
    FractionGhosts<D> ghosts;             // the conditions at the sides: what enters there, or those of the quantity
    std::array<real, 2> entered{};        // through open sides and inflows in the last step, less what left [times cells]
    std::size_t bytes() const;
};

/// The part of a volume that the liquid, or the gas, fills: as a density of what it alone carries.
inline constexpr Densities densities_of_part[] = {{1, 0}, {0, 1}};

template <int D>
class Transport {
public:
    /// `entering`: through inflows; `returning`: through open sides where the flow is inwards.
    Transport(const MacState<D>& state, const EnteringFractions<D>& entering, const EnteringFractions<D>& returning);
    /// Advects the fractions of cells. Returns the liquid that came in through open sides and inflows, less what left [cells]. `padded`: f
    /// with its ghosts; it is changed. `carried`: what the fluids carry in the same fluxes, each its own; nullptr: nothing.
    real advect_fraction(const Motion<D>& motion, Padded<D>& padded, Grid<real, D>& f, PhaseValues<D>* carried = nullptr);
    /// Advects component a of the velocity with the mass in the control volumes of its faces. `fractions`: of these at the start;
    /// `carried`: the conditions of the component at the sides; `to`: the new component.
    void advect_momentum(int a, const Motion<D>& motion, const Grid<real, D>& fractions, const Boundary<D>& carried, const Densities& rho,
                         Grid<real, D>& to);
    static Extent<D> flux_extent(const MacState<D>& state) { return state.u.cells + Index<D>::constant(2); }
    std::size_t bytes() const;

private:
    /// The control volumes of a transport: those of the cells (component −1) or of the faces along an axis.
    struct Volumes {
        int component;
        const Motion<D>& motion;
        Vec<D> per_cell;             // dt/h
        const Grid<real, D>& start;  // fractions at the start
        Padded<D>& f;                // and now
        Padded<D>* q;                // velocity component in the volumes; nullptr: only liquid is transported
        Densities rho;
        Grid<real, D>& to;                  // the result: velocity component, or fractions of cells
        PhaseValues<D>* carried = nullptr;  // by the fluids in cells
        /// C of the lower faces of a row of volumes along axis d: the mean over the two cells of a face's volume.
        void find_courants(int d, const Index<D>& first, int count, real* C) const;
        /// Adds sign dC of a row of volumes.
        void add_dilation(int d, const Index<D>& first, int count, real sign, real* sum) const;
        /// c dC of the sweep of this number, without c; in the last one what takes that of the earlier ones back.
        void find_dilation(int number, const Index<D>& first, int count, real* dilation) const;
        /// Σ dC: what moving solids drive out of the volumes of a row in the step [cells].
        void find_driven_out(const Index<D>& first, int count, real* out) const;
    };
    /// Returns the liquid that crossed open sides and inflows.
    real run_sweeps(const Volumes& v, const FractionGhosts<D>& of_fraction, const Boundary<D>* of_velocity);
    real inflow(const Grid<real, D>& flux, const Extent<D>& cells, int d) const;
    void find_fluxes(const Volumes& v, int d);
    void set_returning(const Volumes& v, int d, const Index<D>& first, int count, const real* C, real* F) const;
    void add_fluxes(const Volumes& v, int number);
    void add_fluxes_in_rooms(const Volumes& v, int number, const Index<D>& first, int count, const real* dilation, const real* driven_out);
    void add_phase_fluxes(const Volumes& v, int number, int phase, const Index<D>& first, int count, const real* dilation) const;

    Vec<D> per_cell(real dt) const;

    Vec<D> spacing_{};  // [m]
    geometry::Sides<D> sides_;
    EnteringFractions<D> returning_;
    FractionGhosts<D> cell_ghosts_;
    std::array<FractionGhosts<D>, D> face_ghosts_;
    std::array<Padded<D>, D> face_fraction_;
    PaddedVelocity<D> velocity_;
    Grid<real, D> liquid_flux_, momentum_flux_;  // through the lower faces of the volumes
};

}  // namespace weir::two_phase
