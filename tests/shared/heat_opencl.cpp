// The bodies shared by all backends, on the first OpenCL device.
#include "shared/on_opencl.hpp"
// first: what the bodies run on
#include "shared/heat_bodies.hpp"
