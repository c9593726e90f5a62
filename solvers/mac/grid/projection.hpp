// The pressure projection: the closest divergence-free velocity that satisfies the solid boundary conditions (Chorin 1968; Batty, Bertails
// & Bridson 2007;
// Ng, Min & Gibou 2009):     Σ_faces w (p(I) − p(N)) = −h² (ρ/dt) ∇·(w u + (1 − w) u_solid),      u −= (dt/ρ) ∇p.
#pragma once
#include "mac/bodies/bodies_in_flow.hpp"
#include "mac/grid/state.hpp"
#include "poisson/poisson.hpp"

#include <memory>
#include <string>

namespace weir::mac {

struct PoissonChoice {
    std::string method = "multigrid";
    poisson::Options options;
    PoissonChoice() = default;
    explicit PoissonChoice(const scene::Table& table);
    static scene::Key key();
};

/// Volume flux out of cell I per volume [1/s]: with the fluid's velocity through the open part of its faces, with the solid's through the
/// rest.
template <int D>
real flux_divergence(const MacState<D>& s, const Index<D>& I);
/// The same for the cells first, first + 1, .. of a row.
template <int D>
void flux_divergence_row(const MacState<D>& s, const Index<D>& first, int count, real* out);
template <int D>
real max_divergence(const MacState<D>& s);

/// factor ∇p on free faces that are not closed; p = 0 on open sides.
template <int D>
class PressurePush {
public:
    PressurePush(const MacState<D>& s, real factor) : s_(s), factor_(factor) {}
    /// Adds factor ∇p to the values of the faces first, first + 1, .. of a row along `axis`; faces that are not free are unchanged.
    void add(int axis, const Index<D>& first, int count, real* values) const;

private:
    const MacState<D>& s_;
    real factor_;
};

/// u += factor ∇p
template <int D>
void add_gradient(MacVelocity<D>& u, const MacState<D>& s, real factor);

template <int D>
class Projection {
public:
    Projection(const PoissonChoice& choice, const MacState<D>& s);
    /// Must be called after solids have moved. `heavy`: with two phases, the part of each cell in the heavier one.
    void set_matrix(const MacState<D>& s, const Grid<real, D>* heavy = nullptr);
    /// Solves for s.p, with its present values as the initial guess, and makes s.u divergence-free. The same solve computes the velocities
    /// of `bodies`, if given.
    const poisson::Report& project(MacState<D>& s, real dt, BodiesInFlow<D>* bodies = nullptr, SolidPlacement<D>* solids = nullptr);
    std::size_t bytes() const;

private:
    void leave_out_ice();
    const poisson::Report& solve(MacState<D>& s);

    std::unique_ptr<poisson::Solver<D>> solver_;
    real tolerance_ = 0;
    poisson::Operator<D> matrix_;
    Grid<real, D> rhs_;
};

}  // namespace weir::mac
