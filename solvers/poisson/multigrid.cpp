// multigrid: flexible conjugate gradients preconditioned by aggregation multigrid.
#include "poisson/algebraic_multigrid.hpp"
#include "poisson/conjugate_gradient.hpp"
#include "poisson/factories.hpp"

namespace weir::poisson {

template <int D>
Made<D> make_multigrid(const Options& options) {
    return std::make_unique<ConjugateGradient<D, AlgebraicMultigrid>>(options);
}

template Made<2> make_multigrid<2>(const Options&);
template Made<3> make_multigrid<3>(const Options&);

}  // namespace weir::poisson
