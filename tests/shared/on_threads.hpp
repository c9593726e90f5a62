// The bodies shared by all backends, on threads with the best instruction set of this processor.
#pragma once
#include "pbf/solver.hpp"
#include "sph/solver.hpp"

#include <string>

namespace weir::test {
namespace {
constexpr const char* backend = "threads";
template <int D>
using Pbf = pbf::PbfSolver<D>;
template <int D>
using Sph = sph::SphSolver<D>;
std::string missing() { return ""; }
}  // namespace
}  // namespace weir::test
