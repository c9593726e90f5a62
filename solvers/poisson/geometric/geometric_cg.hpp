// Conjugate gradients preconditioned by the V-cycle, in two sweeps through memory per iteration (scalars: Chronopoulos & Gear 1989):
//
//     down:  p = u + β p;  s = A p;  x += α p;  r −= α s;  ρ = r·r;  pre-smoothing and restriction of the cycle for r
//     up:    prolongation and post-smoothing: u = M r;  γ = r·u;  δ = u·A u
//     then   β = γ/γ',  α = γ / (δ − β γ/α')
//
// These iterations are apart from linear::conjugate_gradients, whose operations are separate sweeps: here one wavefront over planes
// (wavefront.hpp) does the updates, A p and the first half of the cycle, so that arrays pass through memory twice per iteration. In
// addition the expected reduction decides before a sweep whether it replaces r. The stop test is the same (linear::StopTest).
//
// p, r and the cycle are single precision; x and A p are double. r is replaced by the true b − A x each time it has fallen by a fixed
// factor, and at the end. Where the estimated reduction shows that this is due, the downward sweep computes b − A x itself instead of r − α
// s.
//
// A matrix with low-rank columns, A + Σ U C Uᵀ, is solved with the cycle of A (added_columns.hpp): their contributions to s and δ need only
// the numbers Uᵀ u of each direction.
#pragma once
#include "poisson/geometric/v_cycle.hpp"
#include "poisson/matrix/added_columns.hpp"
#include "poisson/matrix/list_solver.hpp"

namespace weir::poisson {

/// The expected total of iterations above which another method is cheaper (open water takes 7 to 12): as the first iterations project it,
/// and as later ones do.
struct ExpectedIterations {
    int early = 32, late = 32;
};

template <int D>
class GeometricCg {
public:
    /// Returns false if the problem's shape is not supported: no other function may be called then.
    bool setup(const Natural<D>& problem);
    void give_up_above(const ExpectedIterations& most) { most_ = most; }
    /// Iterates on A p = b; fills the report except times, bytes and components. Returns false if it stopped because of slow convergence: p
    /// then contains the last iterate.
    bool solve(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report);
    /// The same with low-rank columns; b is changed temporarily.
    bool solve(const Natural<D>& problem, Grid<real, D>& p, Grid<real, D>& b, const Options& options, Report& report, const LowRank& more);
    std::size_t bytes() const { return arena_.bytes() + hierarchy_.bytes() + sums_.capacity() * sizeof(PlaneSums) + added_.bytes(); }
    Hierarchy<D>& hierarchy() { return hierarchy_; }
    /// One cycle u = M r, for tests.
    void precondition(const Natural<D>& problem, const Grid<real, D>& r, Grid<real, D>& u);

private:
    struct PlaneSums {
        real rr = 0, ru = 0, uAu = 0, largest = 0;
    };
    /// Start of the iterations: ‖r‖ over ‖b‖, ‖b‖, and whether the cycle for r has begun.
    struct Start {
        real norm, b_norm;
        bool begun;
    };
    bool iterate(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report,
                 const Start& start);
    void gather(const Natural<D>& problem, const Grid<real, D>& p);
    void scatter_plane(const Natural<D>& problem, Grid<real, D>& p, int q);
    void residual_plane(const Natural<D>& problem, const real* p, const Grid<real, D>& b, int q);
    real begin_at_zero(const Natural<D>& problem, const Grid<real, D>& b);
    real begin_at(const Natural<D>& problem, const Grid<real, D>& p, const Grid<real, D>& b);
    void restart_cycle();
    void finish_cycle();
    real iterate_down(real alpha, real beta);
    template <class F>
    real replace_residual(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, bool begin_cycle, F&& before);
    void move_plane(int q, real alpha);
    void turn_plane(int q, real beta);
    void advance_plane(int q, real alpha);
    void black_products(int q);
    void last_half_sweep(int q);
    /// Exact sums of quantities of(plane) over all planes, of all ranks in one message.
    template <class... Of>
    std::array<real, sizeof...(Of)> totals(Of&&... of) const;

    bool solve(const Natural<D>& problem, Grid<real, D>& p, const Grid<real, D>& b, const Options& options, Report& report, real b_norm);
    void see_answer();

    Hierarchy<D> hierarchy_;
    AddedColumns<D> added_;  // empty where there are none
    Arena arena_;
    Coloured<double> x_{};
    Coloured<float> p_{};
    ExpectedIterations most_;
    bool windowed_ = false;
    bool at_zero_ = false;  // x is zero, whatever its memory contains
    OwnPlanes own_{};       // of the problem
    std::vector<PlaneSums> sums_;
    real gamma_ = 0, delta_ = 0;
};

}  // namespace weir::poisson
