// Conduction of heat through both fluids: ρc ∂T/∂t = ∇·(k ∇T), by implicit Euler and conjugate gradients with the diagonal. k of a face is
// that of two layers between the middles of its cells, with the liquid fraction of the face's volume: in series across the interface, in
// parallel along it (Patankar 1980, §4.2),
//     k = n² / (f/k_l + (1 − f)/k_g) + (1 − n²) (f k_l + (1 − f) k_g),     n the component of the interface's normal along the face's axis.
// Solids insulate. Side faces conduct where the boundary conditions give a temperature.
#pragma once
#include "linear/conjugate_gradients.hpp"
#include "two_phase/fractions.hpp"

namespace weir::two_phase {

template <int D>
class HeatConduction {
public:
    /// `capacity`: ρc of both fluids [J/(m³ K)]; `conductivity` [W/(m K)]; `temperature`: the conditions at the sides.
    HeatConduction(const MacState<D>& state, const Densities& capacity, const Densities& conductivity, const Boundary<D>& temperature);
    /// Advances T by dt. `f`: fractions of cells with ghosts; `faces`: of the faces' volumes. Returns the heat that came in through sides
    /// [J; in 2D per metre of depth]. No heat is lost to the tolerance.
    real apply(const MacState<D>& state, const Padded<D>& f, const FaceFractions<D>& faces, real dt, Grid<real, D>& T);
    int iterations() const { return iterations_; }
    /// T before the last call.
    const Grid<real, D>& before() const { return before_; }
    /// In one step, the part that stays of a difference of temperature between the fluids in a mixed cell: two layers whose middles
    /// exchange heat through k in series.
    real remaining_difference(real fraction, real dt) const;
    std::size_t bytes() const;

    // The system of linear::conjugate_gradients; norms are those of D^(-1/2) r, D the diagonal.
    static constexpr linear::Norm norm = linear::Norm::residual;
    real precondition();
    void update_direction(real beta);
    real multiply();
    real advance(real alpha);

private:
    void find_conductances(const MacState<D>& state, const FaceFractions<D>& faces, real dt);
    real conductivity_of(int a, const Index<D>& I, real fraction) const;
    real start(real& norm_of_content);
    void finish(const MacState<D>& state);
    real through_sides() const;
    void find_gains(const Index<D>& first, int count, real* gain) const;
    template <class F>
    real sum_of_rows(F&& f) const;

    Densities capacity_, conductivity_;
    Boundary<D> boundary_, homogeneous_;
    Vec<D> h_{};
    std::array<Grid<real, D>, D> conductance_;   // dt k/h² of faces [J/(m³ K)]
    Padded<D> direction_;                        // p; at the start and the end T
    Grid<real, D> before_, residual_, inverse_;  // T at the start; r; inverse of the diagonal
    Grid<real, D> product_;                      // A p
    const Padded<D>* f_ = nullptr;               // of the present call, with those below
    Grid<real, D>* T_ = nullptr;
    real first_ = 0;  // ‖r‖ at the start
    int iterations_ = 0;
};

}  // namespace weir::two_phase
