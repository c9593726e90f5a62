// Viscosity with a jump: (ρ_a − dt ∇·2μD) u = ρ_a u*, implicit, all components at once, by conjugate gradients. They are
// preconditioned by the diagonal or, where many iterations are expected, by a multigrid cycle (mac/viscous/multigrid.hpp). ρ_a is that of
// the faces' volumes; μ = f μ_l + (1 − f) μ_g in cells, and the mean of four cells at edges. Edges on sides that are not no-slip walls bear
// no shear. The surface of a solid is that of its closed faces.
#pragma once
#include "linear/conjugate_gradients.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "mac/viscous/multigrid.hpp"
#include "two_phase/transport.hpp"

namespace weir::two_phase {

enum class Preconditioner { cheaper, diagonal, multigrid };

template <int D>
class Viscosity {
public:
    /// mu_liquid, mu_gas: dynamic viscosities [Pa s].
    Viscosity(const MacState<D>& state, const SolidPlacement<D>& solids, real mu_liquid, real mu_gas);
    /// Called after solids were placed.
    void see_solids(const MacState<D>& state, const SolidPlacement<D>& solids);
    /// u* → u over dt. `f`: fractions of cells with a layer of ghosts; `faces`: of the faces' volumes.
    void apply(MacState<D>& state, const Padded<D>& f, const FaceFractions<D>& faces, const Densities& rho, real dt);
    int iterations() const { return iterations_; }
    /// For tests and studies; default: the one expected to be cheaper.
    void set_preconditioner(Preconditioner preconditioner) { preconditioner_ = preconditioner; }
    std::size_t bytes() const;

    // The system of linear::conjugate_gradients; norms are those of D^(-1/2) r, D the diagonal.
    static constexpr linear::Norm norm = linear::Norm::residual;
    real precondition();
    void update_direction(real beta);
    real multiply();
    real advance(real alpha);

private:
    void find_viscosities(const Padded<D>& f);
    void find_coefficients();
    void find_solid_edges(const MacState<D>& state, const SolidPlacement<D>& solids, int a, int b);
    bool bears_shear(int a, int b, const Index<D>& I) const;
    void multiply_row(int a, const Index<D>& first, int count, real* result) const;
    real start();
    void clear_walls();
    real expected_iterations(real first) const;
    void build_multigrid();
    real precondition_by_cycle();
    static std::size_t edge_number(int a, int b) { return static_cast<std::size_t>(D == 2 ? 0 : 3 - a - b); }
    Grid<real, D>& edge(int a, int b) { return edge_mu_[edge_number(a, b)]; }
    const Grid<real, D>& edge(int a, int b) const { return edge_mu_[edge_number(a, b)]; }
    template <class F>
    void for_each_row(F&& f) const;
    template <class F>
    real sum_of_rows(F&& f) const;

    real mu_liquid_, mu_gas_;
    Padded<D> cell_mu_;                                  // [Pa s]
    std::array<Grid<real, D>, D == 2 ? 1 : 3> edge_mu_;  // of the edges along axis k; in 2D the nodes
    /// An edge beside a closed face, and the factor of its viscosity: 0 at free-slip solids; 2 at no-slip ones, whose surface is half a
    /// cell away.
    struct SolidEdge {
        std::size_t edge;
        real factor;
    };
    std::array<std::vector<SolidEdge>, D == 2 ? 1 : 3> solid_edges_;
    std::array<Boundary<D>, D> boundary_, homogeneous_;
    PaddedVelocity<D> direction_;                         // p; at the start u*
    MacVelocity<D> residual_, product_, mass_, inverse_;  // mass: ρ_a; inverse: of the diagonal
    MacVelocity<D> cycled_;                               // z of a cycle
    mac::viscous::Multigrid<D> multigrid_;
    Preconditioner preconditioner_ = Preconditioner::cheaper;
    bool cycles_ = false;           // of the present solve
    MacState<D>* state_ = nullptr;  // of the present call, with those below
    real dt_ = 0, norm_of_b_ = 0, relative_ = 0;
    int iterations_ = 0;
};

/// f(a, first, count) on the rows of unknowns of every component.
template <int D>
template <class F>
void Viscosity<D>::for_each_row(F&& f) const {
    for (int a = 0; a < D; ++a) {
        const Nodes<D> faces = free_faces(residual_, state_->sides, a);
        Extent<D> rows = faces.hi;
        rows[0] = faces.lo[0] + 1;
        for_each_in(faces.lo, rows, [&](const Index<D>& first) { f(a, first, faces.hi[0] - faces.lo[0]); });
    }
}

/// The sum of f(a, first, count) over the rows of unknowns.
template <int D>
template <class F>
real Viscosity<D>::sum_of_rows(F&& f) const {
    real total = 0;
    for (int a = 0; a < D; ++a) {
        const Nodes<D> faces = free_faces(residual_, state_->sides, a);
        Extent<D> rows(faces.hi - faces.lo);
        rows[0] = 1;
        total += sum_over(rows, [&](const Index<D>& row) { return f(a, row + faces.lo, faces.hi[0] - faces.lo[0]); });
    }
    return total;
}

}  // namespace weir::two_phase
