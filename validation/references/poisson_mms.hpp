// Manufactured solutions of the Poisson equation lap p = f on the unit square or cube, chosen so that neither p nor f is reproduced
// exactly by the 5/7-point formula. N: closed sides (dp/dn = 0), D: p = 0 at the sides (faces).
#pragma once
#include "core/types.hpp"

#include <string>
#include <vector>

namespace weir::validation {

struct PoissonProblem {
    std::string name;   // "N1", "N2", "N3", "D1", "D2"
    std::string table;  // its name in the table of discrete errors
    int dim = 2;
    bool dirichlet = false;
    real (*p)(const Vec<3>& x) = nullptr;
    real (*f)(const Vec<3>& x) = nullptr;
};

const std::vector<PoissonProblem>& poisson_problems();
/// Throws BadInput for an unknown name.
const PoissonProblem& poisson_problem(const std::string& name);

}  // namespace weir::validation
