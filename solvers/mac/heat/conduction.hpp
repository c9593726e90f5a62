// Conduction of heat between the cells of a grid by the enthalpy method: H += (dt/ρ) (∇·(k ∇T(H)) + q), with H the specific enthalpy and
// T(H) constant where a cell is part solid, part liquid (Voller & Prakash 1987).
//
// A step of any length is divided into as many explicit stages as it needs, by Gegenbauer polynomials C_s^(5/2): Runge-Kutta-Gegenbauer
// schemes (Skaras, Saxton, Meyer & Aslam, JCP 425, 2021), which extend Runge-Kutta-Legendre schemes (Meyer, Balsara & Aslam, JCP 257,
// 2014). s stages are stable up to s (s + 5)/6 times the limit of explicit Euler. Explicit stages need no linearization or iteration for
// the plateau (Alexiades, Amiez & Gremaud 1996 use Chebyshev polynomials likewise). With R = ∇·(k ∇T) + q,
//     D_j = (2j + 3)/(j + 4) [D_{j−1} + w (dt/ρ) R(H + D_{j−1})] − (j − 1)/(j + 4) D_{j−2},   w = 6/(s (s + 5)),   D_0 = 0,   H ← H + D_s.
// First order in dt, with a quarter of the error of implicit Euler: for many stages it approximates e^z by 1 + z + 3/8 z². Legendre
// polynomials would need fewer stages, but in three dimensions a warm cell would become colder than its neighbours. The stages' response is
// a sum of positive parts up to five dimensions with 5/2, and only up to two with 1/2. The scheme is in flux form: heat is conserved.
#pragma once
#include "mac/grid/ghosts.hpp"
#include "parallel/grid.hpp"
#include "poisson/poisson.hpp"
#include "thermo/melting.hpp"

#include <cstdint>
#include <vector>

namespace weir::mac {

template <int D>
class Conduction {
public:
    Conduction() = default;
    /// `temperature`: the boundary conditions of the sides.
    Conduction(const thermo::Melting& melting, const Extent<D>& cells, const Vec<D>& h, real rho, const Boundary<D>& temperature);
    /// Sets another melting law: at another pressure, for instance.
    void set_melting(const thermo::Melting& melting) { melting_ = melting, known_ = false; }
    /// Mass per volume of the fluid's cells, where it differs from the density [kg/m³].
    void set_density(real rho) { rho_ = rho; }
    /// Sets a side with heat transfer to the surroundings [W/(m² K)], in series with the half cell beside it.
    void exchange_through(int axis, int end, real coefficient);
    /// The temperature of that side, or of its surroundings.
    void set_outside(int axis, int end, real T) { rule(axis, end).value = T; }

    /// Arguments of a step besides H.
    struct Given {
        const Grid<poisson::Cell, D>& cells;
        bool cells_changed;                 // since the last call
        const Grid<real, D>& source;        // q [W/m³], 0 outside the fluid; may be empty
        const Padded<D>* before = nullptr;  // H before another term changed it in the same step: both terms then act simultaneously, and
                                            // the steady state does not depend on the step
    };
    /// Advances H by dt in fluid cells; other cells are unchanged and insulate. Returns the heat from sides and sources [J; in 2D per metre
    /// of depth].
    real step(Grid<real, D>& H, const Given& given, real dt);
    /// The same in one stage: explicit Euler, unstable beyond longest_euler_step().
    real euler_step(Grid<real, D>& H, const Given& given, real dt);
    /// Limit within which explicit Euler cools no cell below its neighbours, for any cells.
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

    /// One stage of a step.
    struct Stage {
        Grid<real, D>& H;
        const Given& given;
        int number;         // 0: T of H alone
        bool last;          // the last stage writes H
        real mu, nu, push;  // coefficients of the recursion
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

    thermo::Melting melting_;
    Vec<D> h_{};
    real rho_ = 1, cell_volume_ = 0;
    Boundary<D> boundary_, no_flux_;
    std::array<real, 2 * D> exchange_{};        // per end of each axis; 0: none
    std::array<Grid<real, D>, D> conductance_;  // k/h² on faces [W/(m³ K)]
    Grid<real, D> even_cells_;                  // common conductivity of a row's cells [W/(m K)]; negative where they differ
    std::array<Grid<real, D>, D> even_faces_;   // common conductance of a row's faces, as in conductance_; negative where they differ
    real most_conductance_ = 0;                 // maximum over cells of the sum over their faces
    bool all_liquid_ = false, known_ = false;   // state at the last update; whether there was one
    bool uniform_ = false;                      // all inner faces have equal conductance: all cells are liquid

    static constexpr int most_in_a_pass = 8;  // stages
    std::array<Grid<real, D>, 2> change_;     // D_j by the parity of j
    std::array<Padded<D>, 2> T_;              // of H + D_j
    Grid<Vec<D>, D> alike_;                   // common conductance of all faces of a row's cells, per axis; [0] is -1 where they differ
    std::vector<real> arrivals_;              // flux through the sides, of each stage of a pass and each plane [W/m³, summed over cells]
    std::vector<std::int64_t> work_;          // index of each plane
};

}  // namespace weir::mac
