// A coupling of cells to p = 0 besides their faces: (A + diag(z)) p = b with z ≥ 0 in the scale of the weights. It stands for a volume that
// responds to its own pressure, such as enclosed gas: −dV/dt = V/(γ p) dp/dt, implicit in time, is z = h² ρ/(γ p dt²). A component with
// z > 0 in any cell is not singular.
#pragma once
#include "poisson/poisson.hpp"

namespace weir::poisson {

/// Implemented by every method but "dct". In one process only, and only for operators with face weights.
template <int D>
class ZeroCoupling {
public:
    virtual ~ZeroCoupling() = default;
    /// z of every cell, read in fluid cells from the next setup() on; nullptr: none. It must not change between setup() and solve().
    virtual void couple_to_zero(const Grid<real, D>* z) = 0;
};

/// The solver's interface to it; nullptr where the method has none.
template <int D>
ZeroCoupling<D>* zero_coupling(Solver<D>& solver) {
    return dynamic_cast<ZeroCoupling<D>*>(&solver);
}

}  // namespace weir::poisson
