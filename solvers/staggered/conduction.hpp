// Conduction of heat between the cells of a grid by the enthalpy method: H += (dt/ρ) (∇·(k ∇T(H)) + q), with H the specific enthalpy and
// T(H) constant where a cell is part solid, part liquid (Voller & Prakash 1987).
//
// A step of any length is taken in as many explicit stages as it needs, by Gegenbauer's polynomials C_s^(5/2): Runge-Kutta-Gegenbauer
// schemes (Skaras, Saxton, Meyer & Aslam, JCP 425, 2021) after Runge-Kutta-Legendre ones (Meyer, Balsara & Aslam, JCP 257, 2014), with
// which s stages reach s (s + 5)/6 times as far as Euler's explicit scheme. Explicit stages take the plateau as it comes: nothing is
// linearised and nothing iterated (so did Alexiades, Amiez & Gremaud 1996 with Chebyshev's polynomials). With R = ∇·(k ∇T) + q,
//     D_j = (2j + 3)/(j + 4) [D_{j−1} + w (dt/ρ) R(H + D_{j−1})] − (j − 1)/(j + 4) D_{j−2},   w = 6/(s (s + 5)),   D_0 = 0,   H ← H + D_s.
// First order in dt, with a quarter of the error of Euler's implicit scheme: of e^z it knows 1 + z + 3/8 z² where many stages are taken.
// Legendre's polynomials would need fewer stages, but a warm cell in three dimensions would be left colder than its neighbours: the waves
// that these stages send out are a sum of positive parts up to five dimensions with 5/2, with 1/2 in no more than two.
// The change of each cell is a sum of fluxes that its neighbours lose: no heat is lost.
#pragma once
#include "core/grid.hpp"
#include "matter/melting.hpp"
#include "poisson/poisson.hpp"
#include "staggered/ghosts.hpp"

#include <cstdint>
#include <vector>

namespace weir::staggered {

template <int D>
class Conduction {
public:
    Conduction() = default;
    /// `temperature`: what the sides impose.
    Conduction(const matter::Melting& melting, const Index<D>& cells, const Vec<D>& h, real rho, const Boundary<D>& temperature);
    /// At another pressure, say.
    void set_melting(const matter::Melting& melting) { melting_ = melting, known_ = false; }
    /// Mass over volume of the fluid's cells, where those do not hold what the density says [kg/m³].
    void set_density(real rho) { rho_ = rho; }
    /// A side of which heat comes in by an exchange with what is outside [W/(m² K)], through the half cell beside it.
    void exchange_through(int axis, int end, real coefficient);
    /// What that side imposes, or the outside of an exchange.
    void set_outside(int axis, int end, real T) { rule(axis, end).value = T; }

    /// What a step is told beside H.
    struct Given {
        const Grid<poisson::Cell, D>& cells;
        bool cells_changed;                 // since the last call
        const Grid<real, D>& source;        // q [W/m³], 0 outside the fluid; may be empty
        const Padded<D>* before = nullptr;  // H before something else changed it in the same step: both then go on side by side, so that a
                                            // steady state of the two does not depend on the step
    };
    /// H after dt in the cells of fluid; others are not touched and let nothing through. Answers how much heat sides and sources gave [J;
    /// in 2D a metre of depth].
    real step(Grid<real, D>& H, const Given& given, real dt);
    /// The same in one stage: Euler's explicit scheme, unstable beyond longest_euler_step().
    real euler_step(Grid<real, D>& H, const Given& given, real dt);
    /// Euler's explicit scheme takes no more heat from a cell than makes it as cold as its neighbours, whatever the cells are.
    real longest_euler_step() const;
    std::size_t bytes() const;

private:
    EndRule& rule(int axis, int end) { return boundary_.end[static_cast<std::size_t>(axis)][static_cast<std::size_t>(end)]; }
    void weaken_exchanges();
    void prepare(const Grid<real, D>& H, const Given& given);
    bool is_liquid(const Grid<real, D>& H, const Given& given) const;
    void set_conductivities(const Grid<real, D>& H, const Given& given);
    void set_conductances(int a);
    void find_rows_alike();
    real conducts_most(const Index<D>& row) const;
    real stages(Grid<real, D>& H, const Given& given, real dt, int count);
    bool may_freeze(const Grid<real, D>& source) const;
    int stages_for(real dt, const Grid<real, D>& source) const;

    /// One stage among those of a step.
    struct Stage {
        Grid<real, D>& H;
        const Given& given;
        int number;         // 0: T of H alone
        bool last;          // writes H
        real mu, nu, push;  // of its recursion
        real elsewhere;     // ρ/dt
        const real* from(const Index<D>& first) const { return given.before ? given.before->at(first) : &H(first); }
    };
    int most_stages_at_once() const;
    void take_temperature(const Stage& stage, int plane);
    void add_stage(const Stage& stage, int plane);
    void add_linear_stage(const Stage& stage, int plane);
    static void other_rates(const Stage& stage, const Index<D>& first, int count, real* rate);
    void continue_row(Padded<D>& T, const Index<D>& first, bool values) const;
    void continue_plane(Padded<D>& T, int plane, bool values) const;
    void continue_around(Padded<D>& T) const;
    real through_sides(const Padded<D>& T, int plane) const;

    matter::Melting melting_;
    Vec<D> h_{};
    real rho_ = 1, cell_volume_ = 0;
    Boundary<D> boundary_, no_flux_;
    std::array<real, 2 * D> exchange_{};        // of the ends of the axes; 0: none
    std::array<Grid<real, D>, D> conductance_;  // k/h² of faces [W/(m³ K)]
    Grid<real, D> even_cells_;                  // what all cells of a row conduct [W/(m K)]; negative where they differ
    std::array<Grid<real, D>, D> even_faces_;   // what all faces of a row do, as they stand in conductance_; negative where they differ
    real most_conductance_ = 0;                 // of all faces of a cell
    bool all_liquid_ = false, known_ = false;   // when they were set; whether they were
    bool uniform_ = false;                      // the same of all inner faces: all cells are of liquid

    static constexpr int most_in_a_pass = 8;  // stages
    std::array<Grid<real, D>, 2> change_;     // D_j by the parity of j
    std::array<Padded<D>, 2> T_;              // of H + D_j
    Grid<Vec<D>, D> alike_;                   // what all faces of a row's cells conduct, by axis; [0] is -1 where they differ
    std::vector<real> arrivals_;              // through the sides, of each stage of a pass and each plane [W/m³, summed over cells]
    std::vector<std::int64_t> work_;          // the number of each plane
};

}  // namespace weir::staggered
