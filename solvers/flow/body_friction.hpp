// Viscosity of a fluid and its no-slip bodies as one linear system. With δ the change of the fluid's velocity, δV that of a body's, and c =
// dt ρν ΔV/(θ h²) at each wall link (staggered/no_slip_walls.hpp):
//
//     ρ ΔV (I − dt ν∇²) δ + Σ c (δ − J δV) = ρ ΔV r,      M δV + Σ Jᵀ c (J δV − δ) = R,      J: the wall's velocity by the body's
//
// The matrix is symmetric positive definite, so conjugate gradients solve it. A light body follows the fluid without oscillation, for any
// step. The Laplacian gives the wall stress μ ∂u/∂n. A wall rotating with ω has the additional stress −μ ω × n, whose torque is −2 μ V ω
// for a body of any shape.
#pragma once
#include "flow/wall_rates.hpp"
#include "staggered/no_slip_walls.hpp"
#include "staggered/state.hpp"

namespace weir::flow {

template <int D>
class BodyFriction {
public:
    explicit BodyFriction(const MacState<D>& s);
    /// Advances by dt from the previous velocity; all other explicit rates must be applied already.
    void solve(MacState<D>& s, real dt);
    /// Sets the faces inside bodies to the bodies' velocities.
    void carry(MacState<D>& s) const;
    int iterations() const { return iterations_; }
    std::size_t bytes() const;

private:
    static constexpr std::size_t n = rigid::freedoms<D>;
    struct Vector {
        std::array<Grid<real, D>, D> fluid;
        std::vector<rigid::Twist<D>> bodies;
    };
    void size(Vector& v, const MacState<D>& s) const;
    void laplacian_of(const Padded<D>& q, const MacState<D>& s, int a, Grid<real, D>& out) const;
    void set_right_side(const MacState<D>& s, real dt);
    void set_image(const MacState<D>& s, real dt);
    void set_diagonal(const MacState<D>& s, real dt);
    struct System;
    void finish(MacState<D>& s, real dt);
    template <class Faces>
    real dot(const std::array<Faces, D>& fluid, const std::vector<rigid::Twist<D>>& bodies, const Vector& y) const;

    std::vector<Nodes<D>> nodes_;
    std::array<Boundary<D>, D> homogeneous_;
    PaddedVelocity<D> direction_;
    std::vector<rigid::Twist<D>> direction_bodies_;
    std::array<WallRows<D>, D> rows_;  // beside solids other than bodies
    Vector residual_, solution_, image_, diagonal_;
    int iterations_ = 0;
};

}  // namespace weir::flow
