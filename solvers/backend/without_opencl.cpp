// Replaces opencl.cpp where weir is built without OpenCL.
#include "backend/device.hpp"
#include "core/error.hpp"

namespace weir::backend {

std::vector<DeviceInfo> devices() { return {}; }

std::unique_ptr<Device> open_device(int) {
    throw BadInput("this weir was built without OpenCL (WEIR_OPENCL=OFF): configure with -DWEIR_OPENCL=ON, or choose the backend threads");
}

}  // namespace weir::backend
