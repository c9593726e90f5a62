// Pressure with a free surface, second order (Gibou, Fedkiw, Cheng & Kang 2002): the surface cuts the line from a liquid cell to an air
// cell at the fraction θ = φ_l / (φ_l − φ_a), with p = σ κ there. The face weight becomes 1/θ, the gradient (σ κ − p_l) / (θ h). Solids
// enter by open face fractions (Batty, Bertails & Bridson 2007). A cell is liquid when φ < −thinnest h, so θ ≥ thinnest / (1 + thinnest)
// without clamping. A plane surface, at any height and slope, has exactly the hydrostatic p.
#pragma once
#include "core/solver.hpp"
#include "free_surface/level_set.hpp"
#include "mac/bodies/bodies_in_flow.hpp"
#include "mac/grid/projection.hpp"
#include "mac/grid/state.hpp"
#include "poisson/zero_coupling.hpp"
#include "water/air_pockets.hpp"

#include <memory>
#include <vector>

namespace weir::water {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

/// Cells with a thinner layer of liquid, relative to h, have no unknown: this bounds 1/θ by 1 + 1/thinnest, and so the condition number.
inline constexpr real thinnest = 0.02;

template <int D>
class SurfacePressure {
public:
    SurfacePressure() = default;
    SurfacePressure(const Frame<D>& frame, const MacState<D>& state, const PoissonChoice& choice);
    /// From now on enclosed air resists (air_pockets.hpp); without this call all air has p = 0. `acceleration`: that of the waves of a few
    /// cells [m/s²], from which the time follows in which incompressible gas gets back lost volume.
    void enclose_air(std::unique_ptr<AirPockets<D>> pockets, real acceleration);
    /// Stores the velocity of the enclosed air after the projection of a step.
    void keep_gas_velocity(const MacState<D>& state);
    /// Number of pockets; volume of the largest, and its pressure: absolute where the gas can be squeezed, otherwise relative to open air.
    std::vector<Integral> pocket_integrals(const MacState<D>& state) const;
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);

    /// Finds the liquid cells and the matrix from φ and the solids; also sets state.cells. In parallel each rank does its own planes with
    /// distributed storage, otherwise all.
    void set_surface(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, MacState<D>& state);
    /// Applies the drag factor state.mobility to the faces' response to pressure; state.u must already contain it.
    void apply_drag(const MacState<D>& state);
    /// Makes the liquid divergence-free: solves for state.p, then u −= (dt/ρ) ∇p. `curvature` [1/m] at cells, or nullptr. The same solve
    /// computes the velocities of `bodies`, if given.
    const poisson::Report& project(MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma, const Grid<real, D>* curvature,
                                   BodiesInFlow<D>* bodies = nullptr, SolidPlacement<D>* solids = nullptr);
    /// The same again in the same step, with state.p as the initial guess and the existing operator.
    const poisson::Report& project_again(MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                         const Grid<real, D>* curvature);
    /// u −= (dt/ρ) ∇p with p = state.p, σ κ on the surface.
    void subtract(const MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma, const Grid<real, D>* curvature,
                  std::array<Grid<real, D>, D>& u) const;
    /// Largest |∇·u| over liquid cells [1/s], with open fractions.
    real max_divergence(const MacState<D>& state) const;
    /// The part of a line of faces along a, starting at I, on which at least one adjacent cell is liquid. The line must not lie on a side
    /// across it.
    Segment faces_of_liquid(int a, const Index<D>& I) const;
    /// As for_each_face_run, limited to that part of each run.
    template <class F, class G>
    void for_faces_of_liquid(int a, F&& inner, G&& outer) const;
    std::size_t bytes() const;

private:
    void add_pockets(const MacState<D>& state);
    template <class F>
    void for_each_gas_face(const MacState<D>& state, int a, F&& f) const;
    void set_gas_velocity(MacState<D>& state) const;
    void couple_gas(real rho, real dt);
    void add_gas_sources(real rho, real dt);
    void set_pressure_level(MacState<D>& state) const;
    std::size_t pocket_bytes() const;
    const poisson::Report& solve(MacState<D>& state);
    void refresh_liquid();
    void find_liquid(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed);
    void set_weights(const LevelSet<D>& surface, const MacState<D>& state, int a);
    real side_weight(const LevelSet<D>& surface, const MacState<D>& state, int a, const Index<D>& I) const;
    real inner_weight(const LevelSet<D>& surface, const MacState<D>& state, std::size_t lower, std::size_t upper) const;
    real surface_pressure(const LevelSet<D>& surface, std::size_t liquid, std::size_t air, real sigma,
                          const Grid<real, D>& curvature) const;
    void set_rhs(const MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma, const Grid<real, D>* curvature);
    real surface_tension(const MacState<D>& state, const LevelSet<D>& surface, real sigma, const Grid<real, D>& curvature,
                         const Index<D>& I) const;
    void subtract_gradient(const MacState<D>& state, real dt, std::array<Grid<real, D>, D>& u) const;
    void subtract_surface_gradient(const MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                   const Grid<real, D>& curvature, std::array<Grid<real, D>, D>& u) const;

    Frame<D> frame_;
    poisson::Operator<D> A_;   // its weights are valid on faces of liquid cells, stale elsewhere
    Grid<real, D> b_;          // likewise
    Grid<Segment, D> liquid_;  // per line of cells along x
    bool has_liquid_ = false;
    bool shares_planes_ = false;  // in parallel: ranks share the work of the solve; otherwise each does all of it
    std::unique_ptr<poisson::Solver<D>> solver_;
    poisson::Report nothing_to_do_;
    real tolerance_ = 0;
    real h2_ = 0;           // h of axis 0, squared: the scale of the matrix
    real largest_cut_ = 0;  // largest 1/θ, along the longest edge of a cell

    std::unique_ptr<AirPockets<D>> pockets_;     // nullptr where the scene names no enclosed air
    std::array<Grid<real, D>, D> gas_velocity_;  // u of enclosed air after the last projection, at least on its faces
    Grid<real, D> zero_;                         // coupling of squeezable gas to p = 0
    real restoring_time_ = 0;                    // √(h/g) [s]
    real gas_weight_ = 0;                        // between cells of enclosed air
};

template <int D>
Segment SurfacePressure<D>::faces_of_liquid(int a, const Index<D>& I) const {
    Index<D> row = I;
    row[0] = 0;
    const std::size_t above = A_.cells.linear(row) / static_cast<std::size_t>(frame_.cells[0]);
    Segment extent = liquid_[above];
    if (a == 0)
        ++extent.end;
    else
        extent.join(liquid_[above - static_cast<std::size_t>(A_.cells.stride(a)) / static_cast<std::size_t>(frame_.cells[0])]);
    return extent;
}

template <int D>
template <class F, class G>
void SurfacePressure<D>::for_faces_of_liquid(int a, F&& inner, G&& outer) const {
    const auto n = static_cast<std::size_t>(frame_.cells[0]), stride = static_cast<std::size_t>(A_.cells.stride(a));
    const auto near = [&](std::size_t face, std::size_t cell, int count) {
        Segment extent = liquid_[cell / n];
        extent.join(liquid_[(cell - stride) / n]);
        const int first = static_cast<int>(cell % n), shift = a == 0 ? 1 : 0;
        const int begin = std::max(first, extent.begin), end = std::min(first + count, extent.end + shift);
        if (begin < end) inner(face + static_cast<std::size_t>(begin - first), cell + static_cast<std::size_t>(begin - first), end - begin);
    };
    for_each_face_run(frame_.cells, a, near, outer);
}

}  // namespace weir::water
