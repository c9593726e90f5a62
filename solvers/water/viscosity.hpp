// Viscosity of a liquid with a free surface: the stress 2 ρν D(u) with D = (∇u + ∇uᵀ)/2, and no viscous traction on the surface.
// The weak form makes the free surface natural (Batty & Bridson 2008): minimise
//     ½ Σ_faces m (u − u*)² + θ dt ν [ Σ_cells w Σ_a (∂_a u_a)² + Σ_edges w ½ (∂_b u_a + ∂_a u_b)² ]
// with liquid fractions m of faces, w of cells and edges. (M + θ dt K) δ = −dt K u*, u = u* + δ; θ = ½ Crank–Nicolson, θ = 1 implicit.
// Free-slip walls and solids exert no shear; no-slip ones hold the velocity half a cell (walls) or a face away (solids). Bodies that the
// liquid sticks to are rows of the solve (body_rows.hpp). Beside them, θ = 1, the pressure of before acts inside it, and is taken off again
// (van Kan 1986): a body at a steady speed is then rubbed at the speed that it has.
// Over ranks each solves for the faces of its own planes, and reads those of one plane beyond its cuts.
#pragma once
#include "staggered/state.hpp"
#include "surface/level_set.hpp"
#include "water/body_rows.hpp"

#include <array>
#include <memory>
#include <vector>

namespace weir::water {

using namespace surface;  // the words of the grid and of its free surface are the solver's own

template <int D>
class SurfaceViscosity {
public:
    static constexpr int edges = D * (D - 1) / 2;
    SurfaceViscosity(const Frame<D>& frame, const MacState<D>& state, real theta, bool solids_stick);
    /// The liquid sticks to the bodies of state.grip.
    void hold_bodies(const MacState<D>& state, const Vec<D>& gravity);
    /// Of the residual, over the right-hand side; else 1e-9.
    void aim(real tolerance) { target_ = tolerance * tolerance; }
    /// u* → u over dt. Throws NumericalFailure("velocity", ...) when conjugate gradients miss the tolerance.
    void apply(MacState<D>& state, const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, real dt);
    std::size_t bytes() const;
    int iterations() const { return iterations_; }

private:
    using Faces = std::array<Grid<real, D>, D>;
    void set_weights(const MacState<D>& state, const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed);
    real edge_weight(int a, int b, const Index<D>& I, const Grid<std::uint8_t, D>& closed) const;
    /// (K u)_a at a face [1/s² × fraction]; `fixed` 1: prescribed values of walls count, 0: they are zero (for corrections).
    real stress_divergence(const Faces& u, int a, const Index<D>& I, real fixed) const;
    bool is_inner(int a, const Index<D>& I) const;
    real inner_stress_divergence(const Faces& u, int a, const Index<D>& I) const;
    real shear(const Faces& u, int a, int b, const Index<D>& I, real fixed) const;
    const Grid<real, D>& edge(int a, int b) const { return edge_[static_cast<std::size_t>(a + b - 1)]; }
    real diagonal(int a, const Index<D>& I) const;
    void reserve_unknowns();
    void list_unknowns();
    void list_walls(const MacState<D>& state);
    void push(MacState<D>& state, const LevelSet<D>& surface, real dt) const;
    void strain_inside(const MacState<D>& state, const Faces& u, real dt_nu, real fixed, Faces& out) const;
    void solve(const MacState<D>& state, real dt_nu);
    real dot(const Faces& p, const Faces& q) const;
    template <class F>
    void for_each_unknown(F&& f) const;

    /// Unknown faces along an axis in one plane, entries [begin, end) of unknown_: what threads share, and sums are taken of.
    struct Block {
        int axis;
        std::size_t begin, end;
        static constexpr std::size_t most = 1024;
    };

    Frame<D> frame_;
    const geometry::Sides<D>* sides_;
    real theta_;
    bool solids_stick_;
    int iterations_ = 0;
    real target_ = 1e-18;  // of the residual squared, over the right-hand side's
    Vec<D> gravity_{};
    std::unique_ptr<BodyRows<D>> bodies_;           // none where the liquid sticks to none
    Grid<real, D> cell_;                            // liquid fraction of cells
    std::array<Grid<real, D>, edges> edge_;         // ... of the boxes about edges, 0 where no shear acts
    Faces mass_, x_, r_, p_, ap_, diagonal_;        // mass_ < 0: not an unknown
    std::array<std::vector<Index<D>>, D> unknown_;  // faces that liquid or its stress reaches, in the order of the grid
    std::vector<Block> blocks_;                     // plane after plane, in each axis after axis
    std::vector<std::size_t> first_block_;          // of each plane of faces, and where those of the last one end
    mutable std::vector<real> block_sum_;
};

}  // namespace weir::water
