// multigrid: conjugate gradients preconditioned by the geometric V-cycle where the cells allow it, by aggregates of phases for clouds of
// bubbles, otherwise by aggregation multigrid.
#include "poisson/factories.hpp"
#include "poisson/geometric/geometric_cg.hpp"
#include "poisson/geometric/two_phase.hpp"
#include "poisson/matrix/algebraic_multigrid.hpp"
#include "poisson/matrix/conjugate_gradient.hpp"
#include "poisson/zero_coupling.hpp"

namespace weir::poisson {

namespace {

/// With two phases the next method is the cycle by phase, which takes 6 to 15 iterations. A projected total of more than 24 is left to it
/// after 12, so that the sum is about 20. Before that, totals of 16 are projected as 25 (one bubble at 1024²).
constexpr ExpectedIterations two_phase_iterations{.early = 32, .late = 24};

template <int D>
class Multigrid final : public Solver<D>, public ZeroCoupling<D> {
public:
    explicit Multigrid(const Options& options) : options_(options) {}

    void setup(const Operator<D>& A) override {
        const Stopwatch watch;
        extent_ = A.cells.extent();
        problem_.build(A, weir::poisson::shares_planes(method_named("multigrid"), A) ? A.cells.own() : OwnPlanes(), zero_);
        algebraic_.reset();
        geometric_fits_ = geometric_.setup(problem_);
        if (!geometric_fits_) set_up_algebraic();
        two_phase_.setup(A, problem_);
        geometric_.give_up_above(two_phase_.any() ? two_phase_iterations : ExpectedIterations{});
        if (geometric_fits_ && two_phase_.is_cloud()) two_phase_.prepare(problem_, geometric_.hierarchy());
        if (options_.record_history) report_.history.reserve(static_cast<std::size_t>(options_.max_iterations));
        report_.components = problem_.closed();
        report_.bytes = bytes();
        report_.setup_seconds = watch.seconds();
    }

    /// Walls and slits that coarse cells do not resolve, or weights of many magnitudes, slow the geometric cycle down. The algebraic one
    /// then continues from its iterate. With two phases, aggregates by phase come between the two. Each is built when a solve first needs
    /// it; whether one does depends on that solve alone.
    const Report& solve(Grid<real, D>& p, const Grid<real, D>& b) override {
        const Stopwatch watch;
        check_extents(p.extent() == extent_, "p");
        check_extents(b.extent() == extent_, "b");
        report_.iterations = 0;
        report_.history.clear();
        bool gave_up = !geometric_fits_;
        if (geometric_fits_ && !two_phase_.is_cloud()) gave_up = !geometric_.solve(problem_, p, b, options_, report_);
        if (geometric_fits_ && two_phase_.any() && (gave_up || two_phase_.is_cloud())) {
            two_phase_.prepare(problem_, geometric_.hierarchy());
            gave_up = !two_phase_.solve(p, b, options_, report_);
        }
        if (gave_up) {
            const Report& rest = continue_alone(p, b);
            report_.iterations = rest.iterations;
            report_.history = rest.history;
            report_.residual_before = rest.residual_before;
            report_.residual_after = rest.residual_after;
            report_.residual_max = rest.residual_max;
        }
        report_.solve_seconds = watch.seconds();
        report_.bytes = bytes();
        judge(options_, report_);
        return report_;
    }

    /// A component without air would require removing the columns' means; the algebraic cycle does not support columns.
    const Report* solve(Grid<real, D>& p, Grid<real, D>& b, const LowRank& more) override {
        if (!geometric_fits_ || problem_.closed() > 0 || problem_.own().distributed()) return nullptr;
        const Stopwatch watch;
        const bool solved = geometric_.solve(problem_, p, b, options_, report_, more);
        report_.solve_seconds = watch.seconds();
        report_.bytes = bytes();
        if (!solved) return nullptr;
        judge(options_, report_);
        return &report_;
    }

    void couple_to_zero(const Grid<real, D>* z) override { zero_ = z; }

    void set_tolerance(real tolerance) override {
        options_.tolerance = tolerance;
        if (algebraic_ != nullptr) algebraic_->set_tolerance(tolerance);
    }

    std::size_t bytes() const override {
        return problem_.bytes() + geometric_.bytes() + two_phase_.bytes() + (algebraic_ != nullptr ? algebraic_->bytes() : 0);
    }

    bool shares_planes() const override { return problem_.own().distributed(); }

private:
    /// In parallel, replicated on each rank.
    const Report& continue_alone(Grid<real, D>& p, const Grid<real, D>& b) {
        if (algebraic_ == nullptr) set_up_algebraic();
        if (!problem_.own().distributed()) return algebraic_->continue_solve(report_, p, b);
        Grid<real, D> whole_b = b;
        gather(p);
        gather(whole_b);
        const poisson::Report& report = algebraic_->continue_solve(report_, p, whole_b);
        p.store().close();
        return report;
    }
    void set_up_algebraic() {
        algebraic_ = std::make_unique<ConjugateGradient<D, AlgebraicMultigrid>>(options_);
        algebraic_->couple_to_zero(zero_);
        algebraic_->setup(problem_.as_operator());
    }

    Options options_;
    Index<D> extent_{};
    Natural<D> problem_;
    GeometricCg<D> geometric_;
    TwoPhase<D> two_phase_;
    bool geometric_fits_ = false;
    const Grid<real, D>* zero_ = nullptr;
    std::unique_ptr<ConjugateGradient<D, AlgebraicMultigrid>> algebraic_;
    Report report_;
};

}  // namespace

template <int D>
Made<D> make_multigrid(const Options& options) {
    return std::make_unique<Multigrid<D>>(options);
}

template Made<2> make_multigrid<2>(const Options&);
template Made<3> make_multigrid<3>(const Options&);

}  // namespace weir::poisson
