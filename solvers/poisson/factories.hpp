// One factory per method, defined with the method.
#pragma once
#include "poisson/poisson.hpp"

namespace weir::poisson {

template <int D>
using Made = std::unique_ptr<Solver<D>>;

template <int D>
Made<D> make_multigrid(const Options& options);
template <int D>
Made<D> make_cg(const Options& options);
template <int D>
Made<D> make_cg_jacobi(const Options& options);
template <int D>
Made<D> make_cg_mic0(const Options& options);
template <int D>
Made<D> make_eigen_iccg(const Options& options);
template <int D>
Made<D> make_cholmod(const Options& options);
template <int D>
Made<D> make_red_black(const Options& options);
template <int D>
Made<D> make_jacobi(const Options& options);
template <int D>
Made<D> make_dct(const Options& options);
template <int D>
Made<D> make_petsc_gamg(const Options& options);
template <int D>
Made<D> make_petsc_boomeramg(const Options& options);
template <int D>
Made<D> make_petsc_icc(const Options& options);

}  // namespace weir::poisson
