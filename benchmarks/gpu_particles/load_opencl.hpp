// OpenCL's loader found at run time (dlopen), so that a binary starts where none is installed and says what is missing. build.sh includes
// this before solvers/backend/opencl.cpp: every function that file calls becomes a look-up in the loader. LD_LIBRARY_PATH says which one.
#pragma once
#include "core/error.hpp"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

#define CL_TARGET_OPENCL_VERSION 120
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#include <CL/cl.h>

namespace weir::backend {

inline void* opencl_loader() {
    for (const char* name : {"libOpenCL.so.1", "libOpenCL.so"})
        if (void* loader = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return loader;
    throw BadInput(
        "no OpenCL device here: libOpenCL.so.1 is not found; install the OpenCL driver of your GPU's vendor, or ocl-icd-libopencl1");
}

template <class Function>
Function* opencl_function(const char* name) {
    static void* const loader = opencl_loader();
    if (void* address = dlsym(loader, name)) return reinterpret_cast<Function*>(address);
    throw std::runtime_error("OpenCL: the loader has no " + std::string(name));
}

}  // namespace weir::backend

#define WEIR_LOADED(name) (weir::backend::opencl_function<decltype(name)>(#name))
#define clBuildProgram WEIR_LOADED(clBuildProgram)
#define clCreateBuffer WEIR_LOADED(clCreateBuffer)
#define clCreateCommandQueue WEIR_LOADED(clCreateCommandQueue)
#define clCreateContext WEIR_LOADED(clCreateContext)
#define clCreateKernel WEIR_LOADED(clCreateKernel)
#define clCreateProgramWithSource WEIR_LOADED(clCreateProgramWithSource)
#define clEnqueueFillBuffer WEIR_LOADED(clEnqueueFillBuffer)
#define clEnqueueNDRangeKernel WEIR_LOADED(clEnqueueNDRangeKernel)
#define clEnqueueReadBuffer WEIR_LOADED(clEnqueueReadBuffer)
#define clEnqueueWriteBuffer WEIR_LOADED(clEnqueueWriteBuffer)
#define clFinish WEIR_LOADED(clFinish)
#define clGetDeviceIDs WEIR_LOADED(clGetDeviceIDs)
#define clGetDeviceInfo WEIR_LOADED(clGetDeviceInfo)
#define clGetEventInfo WEIR_LOADED(clGetEventInfo)
#define clGetEventProfilingInfo WEIR_LOADED(clGetEventProfilingInfo)
#define clGetPlatformIDs WEIR_LOADED(clGetPlatformIDs)
#define clGetPlatformInfo WEIR_LOADED(clGetPlatformInfo)
#define clGetProgramBuildInfo WEIR_LOADED(clGetProgramBuildInfo)
#define clReleaseCommandQueue WEIR_LOADED(clReleaseCommandQueue)
#define clReleaseContext WEIR_LOADED(clReleaseContext)
#define clReleaseEvent WEIR_LOADED(clReleaseEvent)
#define clReleaseKernel WEIR_LOADED(clReleaseKernel)
#define clReleaseMemObject WEIR_LOADED(clReleaseMemObject)
#define clReleaseProgram WEIR_LOADED(clReleaseProgram)
#define clSetKernelArg WEIR_LOADED(clSetKernelArg)
