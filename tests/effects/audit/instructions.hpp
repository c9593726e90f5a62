// Instructions, counted by callgrind while this program runs under it.
#pragma once
#include "core/solver.hpp"

#include <map>
#include <string>

namespace weir::test {

/// Instructions of one step by pass; what stands between passes is called "".
using Instructions = std::map<std::string, long>;

/// Whether callgrind runs this program; without it every count is zero.
bool counted();
/// One step of the solver, counted.
Instructions instructions_of_step(Solver& solver, real dt);
long total(const Instructions& counts);

}  // namespace weir::test
