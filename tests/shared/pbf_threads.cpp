// The bodies shared by all backends, on threads with the best instruction set of this processor.
#include "pbf/solver.hpp"

#include <string>

namespace weir::test {
namespace {
constexpr const char* backend = "threads";
template <int D>
using Pbf = pbf::PbfSolver<D>;
std::string missing() { return ""; }
}  // namespace
}  // namespace weir::test

#include "shared/pbf_bodies.hpp"
