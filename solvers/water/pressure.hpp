// Pressure with a free surface, second order (Gibou, Fedkiw, Cheng & Kang 2002): the surface cuts the line from a liquid cell to an air
// cell at θ = φ_l / (φ_l − φ_a) of its length, and there p = σ κ. The face weight becomes 1/θ, the gradient (σ κ − p_l) / (θ h).
// Solids enter by open face fractions (Batty, Bertails & Bridson 2007). A cell is liquid when φ < −thinnest h, so that θ ≥ thinnest / (1 +
// thinnest) without any clamp: a plane surface, at any height and tilt, has exactly the hydrostatic p.
#pragma once
#include "poisson/poisson.hpp"
#include "staggered/bodies_in_flow.hpp"
#include "staggered/projection.hpp"
#include "staggered/state.hpp"
#include "surface/level_set.hpp"

#include <memory>

namespace weir::water {

using namespace surface;  // the words of the grid and of its free surface are the solver's own

/// Liquid thinner than this part of a cell is not solved for: it bounds 1/θ by 1 + 1/thinnest, hence the matrix's condition.
inline constexpr real thinnest = 0.02;

template <int D>
class SurfacePressure {
public:
    SurfacePressure() = default;
    SurfacePressure(const Frame<D>& frame, const MacState<D>& state, const PoissonChoice& choice);

    /// Which cells are liquid, and the matrix, from φ and the solids. Also fills state.cells. Over ranks each finds its own planes of it
    /// where it holds no more, else all of the whole φ.
    void set_surface(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, MacState<D>& state);
    /// Faces follow the pressure as far as state.mobility says; state.u must be that part of itself already.
    void hold_back(const MacState<D>& state);
    /// Makes the liquid free of divergence: solves for state.p, then u −= (dt/ρ) ∇p. `curvature` [1/m] at cells, or nullptr. `bodies`, or
    /// nullptr, get their velocities by the same pressure.
    const poisson::Report& project(MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma, const Grid<real, D>* curvature,
                                   BodiesInFlow<D>* bodies = nullptr, SolidPlacement<D>* solids = nullptr);
    /// The same once more in the same step, with state.p as the first guess: of an operator that has been set up.
    const poisson::Report& project_again(MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                         const Grid<real, D>* curvature);
    /// u −= (dt/ρ) ∇p with p = state.p, σ κ on the surface.
    void subtract(const MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma, const Grid<real, D>* curvature,
                  std::array<Grid<real, D>, D>& u) const;
    /// Largest |∇·u| over liquid cells [1/s], open fractions counted.
    real max_divergence(const MacState<D>& state) const;
    /// The part of a line of faces along a, which begins at I and lies on no side across it, that has liquid on one side or the other.
    Extent faces_of_liquid(int a, const Index<D>& I) const;
    /// As for_each_face_run, but of each run only that part.
    template <class F, class G>
    void for_faces_of_liquid(int a, F&& inner, G&& outer) const;
    std::size_t bytes() const;

private:
    const poisson::Report& solve(MacState<D>& state);
    void bring_liquid();
    void find_liquid(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed);
    void set_weights(const LevelSet<D>& surface, const MacState<D>& state, int a);
    real side_weight(const LevelSet<D>& surface, const MacState<D>& state, int a, const Index<D>& I) const;
    real cut_weight(const LevelSet<D>& surface, std::size_t lower, std::size_t upper) const;
    real surface_pressure(const LevelSet<D>& surface, std::size_t liquid, std::size_t air, real sigma,
                          const Grid<real, D>& curvature) const;
    void set_rhs(const MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma, const Grid<real, D>* curvature);
    real surface_tension(const LevelSet<D>& surface, real sigma, const Grid<real, D>& curvature, const Index<D>& I) const;
    void subtract_gradient(const MacState<D>& state, real dt, std::array<Grid<real, D>, D>& u) const;
    void subtract_surface_gradient(const MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                   const Grid<real, D>& curvature, std::array<Grid<real, D>, D>& u) const;

    Frame<D> frame_;
    poisson::Operator<D> A_;  // its weights hold on faces of liquid cells, and are left over from earlier steps elsewhere
    Grid<real, D> b_;         // likewise
    Grid<Extent, D> liquid_;  // of every line of cells along x
    bool has_liquid_ = false;
    std::unique_ptr<poisson::Solver<D>> solver_;
    poisson::Report nothing_to_do_;
    real tolerance_ = 0;
    real h2_ = 0;           // h of axis 0, squared: what the matrix is scaled by
    real largest_cut_ = 0;  // of 1/θ, along the longest edge of a cell
};

template <int D>
Extent SurfacePressure<D>::faces_of_liquid(int a, const Index<D>& I) const {
    Index<D> row = I;
    row[0] = 0;
    const std::size_t above = A_.cells.linear(row) / static_cast<std::size_t>(frame_.cells[0]);
    Extent extent = liquid_[above];
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
        Extent extent = liquid_[cell / n];
        extent.join(liquid_[(cell - stride) / n]);
        const int first = static_cast<int>(cell % n), shift = a == 0 ? 1 : 0;
        const int begin = std::max(first, extent.begin), end = std::min(first + count, extent.end + shift);
        if (begin < end) inner(face + static_cast<std::size_t>(begin - first), cell + static_cast<std::size_t>(begin - first), end - begin);
    };
    for_each_face_run(frame_.cells, a, near, outer);
}

}  // namespace weir::water
