// Preconditioned conjugate gradients (Hestenes & Stiefel 1952; Saad 2003, algorithm 9.1) on numbered cells.
#pragma once
#include "poisson/list_solver.hpp"

namespace weir::poisson {

template <class M>
concept ChangesWithResidual = !M::is_linear;

/// The preconditioner is a type with prepare(A, components), apply(r, z), which sets z = M r, and bytes(). For a nonlinear one the flexible
/// form is used, in which an additional inner product gives β (Notay 2000).
template <int D, class Preconditioner>
class ConjugateGradient final : public ListSolver<D> {
public:
    using ListSolver<D>::ListSolver;

private:
    using ListSolver<D>::system_, ListSolver<D>::x_, ListSolver<D>::b_, ListSolver<D>::r_, ListSolver<D>::b_norm_;

    void prepare() override {
        M_.prepare(system_.A, system_.components);
        for (Vector* v : {&z_, &p_, &Ap_}) v->assign(x_.size(), 0);
    }

    void iterate(Progress& progress) override {
        residual(system_.A, x_, b_, r_);
        M_.apply(r_, z_);
        p_ = z_;
        for (real rz = dot(r_, z_); rz > 0;) {
            multiply(system_.A, p_, Ap_);
            const real pAp = dot(p_, Ap_);
            if (!(pAp > 0)) break;  // the direction is only round-off
            const real alpha = rz / pAp;
            const real relative = std::sqrt(advance(alpha)) / b_norm_;
            progress.count(relative);
            if (!progress.wants_more(relative)) break;
            M_.apply(r_, z_);
            const real rz_new = dot(r_, z_);
            if constexpr (ChangesWithResidual<Preconditioner>)
                update_direction(-dot(z_, Ap_) / pAp);
            else
                update_direction(rz_new / rz);
            rz = rz_new;
        }
    }

    /// x += α p,  r −= α A p;  returns r·r.
    real advance(real alpha) {
        return sum_of_blocks(x_.size(), [&](std::size_t begin, std::size_t end) {
            real rr = 0;
            for (std::size_t i = begin; i < end; ++i) {
                x_[i] += alpha * p_[i];
                r_[i] -= alpha * Ap_[i];
                rr += r_[i] * r_[i];
            }
            return rr;
        });
    }

    /// p = z + β p.
    void update_direction(real beta) {
        for_each_block(p_.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) p_[i] = z_[i] + beta * p_[i];
        });
    }

    std::size_t own_bytes() const override { return M_.bytes() + 3 * z_.capacity() * sizeof(real); }

    Preconditioner M_;
    Vector z_, p_, Ap_;
};

}  // namespace weir::poisson
