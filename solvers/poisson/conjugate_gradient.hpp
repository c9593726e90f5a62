// Preconditioned conjugate gradients on numbered cells.
#pragma once
#include "linear/conjugate_gradients.hpp"
#include "poisson/list_solver.hpp"

namespace weir::poisson {

template <class M>
concept ChangesWithResidual = !M::is_linear;

/// The preconditioner is a type with prepare(A, components), apply(r, z), which sets z = M r, and bytes(). For a nonlinear one an
/// additional inner product gives β (Notay 2000).
template <int D, class Preconditioner>
class ConjugateGradient final : public ListSolver<D> {
public:
    using ListSolver<D>::ListSolver;

    // the operations of linear::conjugate_gradients
    static constexpr linear::Norm norm = linear::Norm::residual;

    real precondition() {
        M_.apply(r_, z_);
        return dot(r_, z_);
    }
    void update_direction(real beta) {
        if (beta == 0) return void(p_ = z_);
        for_each_block(p_.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) p_[i] = z_[i] + beta * p_[i];
        });
    }
    real flexible_beta(const linear::Step& last) const requires ChangesWithResidual<Preconditioner> { return -dot(z_, Ap_) / last.pAp; }
    real multiply() {
        poisson::multiply(system_.A, p_, Ap_);
        return dot(p_, Ap_);
    }
    real advance(real alpha) {
        const real rr = sum_of_blocks(x_.size(), [&](std::size_t begin, std::size_t end) {
            real sum = 0;
            for (std::size_t i = begin; i < end; ++i) {
                x_[i] += alpha * p_[i];
                r_[i] -= alpha * Ap_[i];
                sum += r_[i] * r_[i];
            }
            return sum;
        });
        return std::sqrt(rr) / b_norm_;
    }

private:
    using ListSolver<D>::system_, ListSolver<D>::x_, ListSolver<D>::b_, ListSolver<D>::r_, ListSolver<D>::b_norm_;

    void prepare() override {
        M_.prepare(system_.A, system_.components);
        for (Vector* v : {&z_, &p_, &Ap_}) v->assign(x_.size(), 0);
    }

    void iterate(linear::StopTest& stop, real relative) override { linear::conjugate_gradients(*this, stop, relative); }

    std::size_t own_bytes() const override { return M_.bytes() + 3 * z_.capacity() * sizeof(real); }

    Preconditioner M_;
    Vector z_, p_, Ap_;
};

}  // namespace weir::poisson
