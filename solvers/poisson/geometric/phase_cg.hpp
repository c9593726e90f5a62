// Conjugate gradients for two phases of very different density, in double precision, preconditioned by one cycle: the geometric smoother on
// the cells (single precision), aggregates by phase below (phase_cycle.hpp).
//
// With weights that jump by the ratio ρ_l/ρ_g, rounding of u in the gas changes A u by ρ_l/ρ_g times its own size. The recurrences of
// geometric_cg.hpp (δ of a red cell from u·r, r and p in single precision) then lose conjugacy on fine grids. Here p·A p and r are computed
// as they are defined, and β is that of a preconditioner that is constant to round-off only (Notay 2000).
#pragma once
#include "linear/conjugate_gradients.hpp"
#include "poisson/geometric/hierarchy.hpp"
#include "poisson/geometric/phase_cycle.hpp"
#include "poisson/matrix/list_solver.hpp"

namespace weir::poisson {

template <int D>
class PhaseCg {
public:
    /// Problem and hierarchy must outlive the solves, and store all planes on this rank.
    void setup(const Natural<D>& problem, Hierarchy<D>& hierarchy, const PhaseCells<D>& cells);
    /// Continues from p; adds to the report's iterations and history, and fills residual_after and residual_max. Returns false if it
    /// stopped before the tolerance: p is then the last iterate.
    bool solve(Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report);
    std::size_t bytes() const;

    // the operations of linear::conjugate_gradients
    static constexpr linear::Norm norm = linear::Norm::residual;
    real precondition();
    void update_direction(real beta);
    real flexible_beta(const linear::Step& last);
    real multiply();
    real advance(real alpha);

private:
    real find_residual(const Grid<real, D>& p, const Grid<real, D>& b);
    void smooth_down();
    void smooth_up();
    void number_red_cells();
    void add_products(std::size_t plane, std::size_t first, std::size_t n);
    /// The exact sum of f(first cell of a row, cells) over rows that contain fluid.
    template <class F>
    real sum_of_rows(F&& f) const;

    const Natural<D>* problem_ = nullptr;
    Hierarchy<D>* hierarchy_ = nullptr;
    PhaseCycle<D> coarse_;
    std::vector<int> unknown_;  // of each red cell of the packed order, −1 outside fluid
    std::vector<float> red_;    // residual of the red cells
    std::vector<float> z_;      // M r, in the order of the cells, like the following
    Vector r_, p_, Ap_, zero_;
    Vector rz_, zAp_;  // r·z and z·A p of each plane
    Grid<real, D>* x_ = nullptr;
    real b_norm_ = 0;
};

}  // namespace weir::poisson
