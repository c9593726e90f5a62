// The bodies shared by all backends, on the first OpenCL device.
#pragma once
#include "pbf/device_solver.hpp"
#include "shared/device.hpp"
#include "sph/device_solver.hpp"

#include <string>

namespace weir::test {
namespace {
constexpr const char* backend = "opencl";
template <int D>
using Pbf = pbf::DevicePbfSolver<D>;
template <int D>
using Sph = sph::DeviceSphSolver<D>;
std::string missing() { return missing_device(); }
}  // namespace
}  // namespace weir::test
