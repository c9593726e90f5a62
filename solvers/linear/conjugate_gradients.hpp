// Preconditioned conjugate gradients for A x = b, A and M symmetric positive definite (Hestenes & Stiefel 1952; Saad 2003, algorithm 9.1):
//
//     z = M r;   β = r·z/(r·z)';   p = z + β p;   α = r·z/(p·A p);   x += α p;   r −= α A p
//
// The system supplies the vectors and all operations on them, so each one keeps its own storage, inner product (its order of summation and
// its ranks) and fused loops.
#pragma once
#include "linear/stop_test.hpp"

#include <concepts>

namespace weir::linear {

/// Norm of the residual in the stop test: ‖r‖, or the natural norm √(r·z), which needs no further inner product. The latter is relative to
/// that of the first residual.
enum class Norm { residual, natural };

/// The scalars of an iteration.
struct Step {
    real rz = 0, pAp = 0, alpha = 0;
};

template <class S>
concept System = requires(S& system, real scalar) {
    { S::norm } -> std::convertible_to<Norm>;
    { system.precondition() } -> std::same_as<real>;  // z = M r; returns r·z
    system.update_direction(scalar);                  // p = z + β p; β = 0: p = z, whatever p was
    { system.multiply() } -> std::same_as<real>;      // computes A p; returns p·A p
    system.advance(scalar);  // x += α p, r −= α A p; returns ‖r‖ relative to ‖b‖ unless `norm` is natural
};

/// A system whose M is not exactly constant returns β itself, −z·A p/(p·A p) from the last p, in place of r·z/(r·z)' (Polak & Ribière 1969;
/// Notay 2000).
template <class S>
concept FlexibleSystem = System<S> && requires(S& system, const Step& last) {
    { system.flexible_beta(last) } -> std::same_as<real>;
};

/// The outcome where p·A p or r·z is not positive; NaN stays NaN.
inline Outcome without_direction(real product, real relative_residual) {
    if (std::isnan(product)) return {product, false};
    return {relative_residual, true};
}

/// On entry x is the initial guess, r = b − A x, and `relative_residual` its norm (not used for the natural norm). On return x is the
/// solution. The caller decides whether the outcome is a failure.
template <System S>
Outcome conjugate_gradients(S& system, StopTest& stop, real relative_residual = 1) {
    constexpr bool natural = S::norm == Norm::natural;
    real rz = natural ? system.precondition() : 0;
    const real first = rz;
    if (natural) relative_residual = rz == 0 ? 0 : rz / first;  // 0, 1, or NaN where rz is not finite
    Step last;
    while (stop.wants_more(relative_residual)) {
        if constexpr (!natural) rz = system.precondition();
        if (!(rz > 0)) return without_direction(rz, relative_residual);
        real beta = 0;
        if (last.pAp > 0) {
            if constexpr (FlexibleSystem<S>)
                beta = system.flexible_beta(last);
            else
                beta = rz / last.rz;
        }
        system.update_direction(beta);
        const real pAp = system.multiply();
        if (!(pAp > 0)) return without_direction(pAp, relative_residual);
        last = {rz, pAp, rz / pAp};
        if constexpr (natural) {
            system.advance(last.alpha);
            rz = system.precondition();
            relative_residual = std::sqrt(rz / first);
        } else {
            relative_residual = system.advance(last.alpha);
        }
        stop.count(relative_residual);
    }
    return {relative_residual, false};
}

}  // namespace weir::linear
