// Viscosity of a liquid with a free surface: the stress 2 ρν D(u) with D = (∇u + ∇uᵀ)/2, and no viscous traction on the surface.
// The weak form makes the free surface natural (Batty & Bridson 2008): minimise
//     ½ Σ_faces m (u − u*)² + θ dt ν [ Σ_cells w Σ_a (∂_a u_a)² + Σ_edges w ½ (∂_b u_a + ∂_a u_b)² ]
// with liquid fractions m of faces, w of cells and edges. (M + θ dt K) δ = −dt K u*, u = u* + δ; θ = ½ Crank–Nicolson, θ = 1 implicit.
// Friction uses the previous velocity plus the other changes of the step, dt a = dt (f − ∇p/ρ): (M + θ dt K) Δ = dt (M a − ν K u). So a
// thick liquid creeps in balance of weight, pressure and friction. θ = 1 damps for any step; Crank–Nicolson's θ is the smallest at which no
// mode of the grid oscillates: (1 − θ) dt ν λ ≤ 1, ½ for short steps.
// Free-slip walls and solids exert no shear; no-slip ones prescribe the velocity half a cell (walls) or a face away (solids). No-slip
// bodies are rows of the solve (body_rows.hpp), θ = 1: friction on a body in steady motion then uses its exact speed.
// In parallel each rank solves for the faces of its own planes and reads one ghost plane on each side.
#pragma once
#include "core/parallel.hpp"
#include "free_surface/level_set.hpp"
#include "mac/grid/state.hpp"
#include "water/body_rows.hpp"

#include <array>
#include <memory>
#include <vector>

namespace weir::water {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

template <int D>
class SurfaceViscosity {
public:
    static constexpr int edges = D * (D - 1) / 2;
    SurfaceViscosity(const Frame<D>& frame, const MacState<D>& state, real theta, bool solids_stick);
    /// Adds the no-slip bodies of state.no_slip_walls.
    void enforce_bodies(const MacState<D>& state);
    /// Sets the tolerance of the residual relative to the right-hand side; default 1e-9.
    void set_tolerance(real tolerance) { tolerance_ = tolerance; }
    using Faces = std::array<Grid<real, D>, D>;
    /// Advances u by Δ − dt a over dt. `forces`: dt f, or nullptr. a is computed from the last pressure, state.p (van Kan 1986), as deep in
    /// the liquid as it is known. `at_surface`: a on faces cut by the surface; otherwise it is extrapolated from inside. Throws
    /// NumericalFailure("velocity", ...) when conjugate gradients miss the tolerance.
    void apply(MacState<D>& state, const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, real dt,
               const MacVelocity<D>* forces = nullptr, const Faces* at_surface = nullptr);
    /// Repeats the step with another dt a, whose values are used on faces of liquid cells: `u` = u + Δ.
    void apply_again(const MacState<D>& state, const Faces& with_pressure, real dt, Faces& u);
    /// Extrapolates dt a from faces of liquid cells to the others that friction reads.
    void continue_with_pressure(const MacState<D>& state, Faces& with_pressure);
    /// Bound of the splitting error: the effect of friction on the difference between `with_pressure` and the dt a of the last solve. It is
    /// relative to the norm of u plus `least` times that of the forces.
    real unseen(const MacState<D>& state, const Faces& with_pressure, real dt, const Faces& forces, real least);
    /// dt a of the last solve.
    const Faces& with_pressure() const { return with_pressure_; }
    std::size_t bytes() const;
    int iterations() const { return iterations_; }
    /// θ of the last step.
    real theta() const { return theta_; }

private:
    void set_weights(const MacState<D>& state, const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed);
    real edge_weight(int a, int b, const Index<D>& I, const Grid<std::uint8_t, D>& closed) const;
    /// (K u)_a at a face [1/s² × fraction]; `fixed` 1: with the prescribed values of walls, 0: with zeros (for corrections).
    real stress_divergence(const Faces& u, int a, const Index<D>& I, real fixed) const;
    bool is_inner(int a, const Index<D>& I) const;
    real inner_stress_divergence(const Faces& u, int a, const Index<D>& I) const;
    real shear(const Faces& u, int a, int b, const Index<D>& I, real fixed) const;
    const Grid<real, D>& edge(int a, int b) const { return edge_[static_cast<std::size_t>(a + b - 1)]; }
    real diagonal(int a, const Index<D>& I) const;
    void reserve_unknowns();
    void list_unknowns();
    void list_walls(const MacState<D>& state);
    void set_theta(real dt_nu);
    void predict_from_pressure(const MacState<D>& state, const LevelSet<D>& surface, real dt, const MacVelocity<D>& forces,
                               const Faces* at_surface = nullptr);
    void continue_to_surface(Faces& with_pressure);
    bool step(int a, Index<D>& I, int d, int by) const;
    void add_with_pressure(MacState<D>& state, real sign) const;
    void strain_inside(const MacState<D>& state, const Faces& u, real dt_nu, real fixed, Faces& out) const;
    void set_diagonal(real s);
    struct System;
    void precondition();
    void solve(const MacState<D>& state, real dt_nu, real tolerance);
    real dot(const Faces& p, const Faces& q) const;
    template <class F>
    void for_each_unknown(F&& f) const;

    /// Unknown faces along an axis in one plane, entries [begin, end) of unknown_: the unit of threads and of sums.
    struct Block {
        int axis;
        std::size_t begin, end;
        static constexpr std::size_t most = 1024;
    };

    Frame<D> frame_;
    const geometry::Sides<D>* sides_;
    real least_theta_, theta_;
    bool solids_stick_;
    int iterations_ = 0;
    real tolerance_ = 1e-9;                         // of the residual relative to the right-hand side
    std::unique_ptr<BodyRows<D>> bodies_;           // nullptr without no-slip bodies
    Grid<real, D> cell_;                            // liquid fraction of cells
    std::array<Grid<real, D>, edges> edge_;         // ... of the boxes around edges, 0 where no shear acts
    Faces mass_, x_, r_, p_, ap_, diagonal_;        // mass_ < 0: not an unknown
    Faces with_pressure_;                           // dt a
    std::array<std::vector<Index<D>>, D> unknown_;  // faces reached by liquid or its stress, in the order of the grid
    std::vector<Block> blocks_;                     // plane by plane, within each axis by axis
    mutable std::vector<real> block_sum_;
};

/// f(a, I) must write only data of the face I of axis a.
template <int D>
template <class F>
void SurfaceViscosity<D>::for_each_unknown(F&& f) const {
    parallel_for(0, static_cast<int>(blocks_.size()), [&](int i) {
        const Block& block = blocks_[static_cast<std::size_t>(i)];
        const auto& list = unknown_[static_cast<std::size_t>(block.axis)];
        for (std::size_t k = block.begin; k < block.end; ++k) f(block.axis, list[k]);
    });
}

}  // namespace weir::water
