// The bodies shared by all backends, on the first OpenCL device.
#include "shared/on_opencl.hpp"
// first: what the bodies run on
#include "shared/ice_bodies.hpp"
