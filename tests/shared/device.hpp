// Whether this machine has a device for the tests of the OpenCL backend.
#pragma once
#include "backend/device.hpp"

#include <string>

namespace weir::test {

/// Why there is none; empty where there is one.
inline std::string missing_device() { return backend::devices().empty() ? "no OpenCL device here" : ""; }

}  // namespace weir::test
