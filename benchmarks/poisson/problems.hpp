// The problems of the table, by name: box and wavy (with flags, and with general face weights), and the obstacles.
#pragma once
#include "poisson/poisson.hpp"

#include <string>

namespace weir::bench {

template <int D>
struct Problem {
    poisson::Operator<D> A;
    Grid<real, D> b;
    std::int64_t unknowns = 0;
};

/// box, wavy, box_weights, wavy_weights (cut by round solids); rooms, slits, blocks, fractions (uniform in [1e-4, 1]), magnitudes
/// (log-uniform there), bands (contrast 50); the shapes of phase_shapes.hpp, with this ratio of densities. n cells along each axis.
template <int D>
Problem<D> make(const std::string& name, int n, real ratio = 1000);

/// ‖b − A p‖₂ / ‖b‖₂ in double precision, from the definition.
template <int D>
real true_residual(const Problem<D>& problem, const Grid<real, D>& p);

}  // namespace weir::bench
