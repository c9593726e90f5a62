// The device interface over OpenCL 1.2: one in-order queue with profiling, one program, kernels by name.
#include "backend/device.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

namespace weir::backend {

namespace {

constexpr const char* how_to =
    "install the OpenCL driver of your GPU's vendor, or pocl-opencl-icd, which runs kernels on the processor; `weir list devices` shows "
    "what is found";

const char* name_of(cl_int error) {
    switch (error) {
        case CL_DEVICE_NOT_AVAILABLE:
            return "device not available";
        case CL_MEM_OBJECT_ALLOCATION_FAILURE:
            return "no memory left on the device";
        case CL_OUT_OF_RESOURCES:
            return "out of resources";
        case CL_OUT_OF_HOST_MEMORY:
            return "out of host memory";
        case CL_BUILD_PROGRAM_FAILURE:
            return "the driver's compiler failed";
        case CL_INVALID_WORK_GROUP_SIZE:
            return "invalid work-group size";
        case CL_INVALID_BUFFER_SIZE:
            return "buffer too large";
        case CL_INVALID_KERNEL_ARGS:
            return "an argument was not set";
        case CL_INVALID_ARG_SIZE:
            return "an argument has another size";
        case -1001:
            return "no platform";
        default:
            return "";
    }
}

void require(cl_int error, const std::string& what) {
    if (error == CL_SUCCESS) return;
    throw std::runtime_error("OpenCL: " + what + ": " + name_of(error) + " (error " + std::to_string(error) + ")");
}

template <class T>
T device_number(cl_device_id device, cl_device_info what) {
    T value{};
    require(clGetDeviceInfo(device, what, sizeof value, &value, nullptr), "asking a device");
    return value;
}

/// Text from clGetDeviceInfo or clGetPlatformInfo.
template <class Ask, class Object>
std::string text(Ask ask, Object object, cl_uint what) {
    std::size_t size = 0;
    if (ask(object, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return "";
    std::string value(size, '\0');
    ask(object, what, size, value.data(), nullptr);
    value.resize(value.find('\0') == std::string::npos ? size : value.find('\0'));
    return value;
}

std::vector<cl_device_id> all_devices() {
    cl_uint count = 0;
    if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS || count == 0) return {};
    std::vector<cl_platform_id> platforms(count);
    require(clGetPlatformIDs(count, platforms.data(), nullptr), "listing platforms");
    std::vector<cl_device_id> list;
    for (cl_platform_id platform : platforms) {
        cl_uint here = 0;
        if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &here) != CL_SUCCESS || here == 0) continue;
        list.resize(list.size() + here);
        require(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, here, list.data() + list.size() - here, nullptr), "listing devices");
    }
    return list;
}

DeviceInfo describe(cl_device_id device) {
    DeviceInfo info;
    info.name = text(clGetDeviceInfo, device, CL_DEVICE_NAME);
    info.version = text(clGetDeviceInfo, device, CL_DEVICE_VERSION);
    info.driver = text(clGetDeviceInfo, device, CL_DRIVER_VERSION);
    info.platform = text(clGetPlatformInfo, device_number<cl_platform_id>(device, CL_DEVICE_PLATFORM), CL_PLATFORM_NAME);
    const auto type = device_number<cl_device_type>(device, CL_DEVICE_TYPE);
    info.kind = type & CL_DEVICE_TYPE_GPU ? "GPU" : type & CL_DEVICE_TYPE_CPU ? "CPU" : "accelerator";
    info.memory = device_number<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE);
    info.largest = device_number<cl_ulong>(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
    info.group_limit = device_number<std::size_t>(device, CL_DEVICE_MAX_WORK_GROUP_SIZE);
    info.units = static_cast<int>(device_number<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS));
    info.doubles = device_number<cl_device_fp_config>(device, CL_DEVICE_DOUBLE_FP_CONFIG) != 0;
    const auto single = device_number<cl_device_fp_config>(device, CL_DEVICE_SINGLE_FP_CONFIG);
    info.fused = (single & CL_FP_FMA) != 0;
    info.same_bits = info.fused && (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    return info;
}

class OpenClDevice final : public Device {
public:
    explicit OpenClDevice(cl_device_id device) : device_(device), info_(describe(device)) {
        cl_int error = CL_SUCCESS;
        context_ = clCreateContext(nullptr, 1, &device_, nullptr, nullptr, &error);
        require(error, "opening " + info_.name);
        queue_ = clCreateCommandQueue(context_, device_, CL_QUEUE_PROFILING_ENABLE, &error);
        if (error != CL_SUCCESS) clReleaseContext(context_);
        require(error, "a queue on " + info_.name);
    }
    ~OpenClDevice() override {
        clFinish(queue_);
        for (const Launched& l : launched_) clReleaseEvent(l.event);
        for (const Kernel& k : kernels_) clReleaseKernel(k.kernel);
        if (program_) clReleaseProgram(program_);
        clReleaseCommandQueue(queue_);
        clReleaseContext(context_);
    }
    OpenClDevice(const OpenClDevice&) = delete;
    OpenClDevice& operator=(const OpenClDevice&) = delete;

    const DeviceInfo& info() const override { return info_; }
    void compile(const std::string& program, const std::string& defines) override;
    Memory alloc(std::size_t bytes) override;
    void upload(const Memory& to, const void* from, std::size_t bytes, std::size_t offset) override {
        if (bytes == 0) return;
        require(clEnqueueWriteBuffer(queue_, mem(to), CL_TRUE, offset, bytes, from, 0, nullptr, nullptr), "upload");
    }
    void download(void* to, const Memory& from, std::size_t bytes, std::size_t offset) override {
        if (bytes == 0) return;
        require(clEnqueueReadBuffer(queue_, mem(from), CL_TRUE, offset, bytes, to, 0, nullptr, nullptr), "download");
        collect();
    }
    void fill_zero(const Memory& memory, std::size_t bytes) override {
        const cl_uint zero = 0;
        if (bytes == 0) return;
        require(clEnqueueFillBuffer(queue_, mem(memory), &zero, sizeof zero, 0, bytes, 0, nullptr, nullptr), "fill");
    }
    void launch(std::string_view kernel, std::size_t items, std::size_t group, std::initializer_list<Argument> arguments) override;
    void finish() override {
        require(clFinish(queue_), "finish");
        collect();
    }
    const std::vector<Timing>& timings() override {
        finish();
        report_ = running_;
        for (Timing& t : running_) t.calls = 0, t.seconds = 0;
        return report_;
    }
    std::size_t allocated() const override { return *allocated_; }

private:
    struct Kernel {
        std::string name;
        cl_kernel kernel;
    };
    struct Launched {
        cl_event event;
        std::size_t kernel;
    };
    static cl_mem mem(const Memory& m) { return static_cast<cl_mem>(m.handle.get()); }
    std::size_t find(std::string_view name);
    void collect();

    cl_device_id device_;
    DeviceInfo info_;
    cl_context context_ = nullptr;
    cl_command_queue queue_ = nullptr;
    cl_program program_ = nullptr;
    std::vector<Kernel> kernels_;
    std::vector<Timing> running_, report_;  // in the order of kernels_
    std::vector<Launched> launched_;
    std::shared_ptr<std::size_t> allocated_ = std::make_shared<std::size_t>(0);  // memory may outlive its device
};

void OpenClDevice::compile(const std::string& program, const std::string& defines) {
    cl_int error = CL_SUCCESS;
    const char* source = program.c_str();
    program_ = clCreateProgramWithSource(context_, 1, &source, nullptr, &error);
    require(error, "program");
    const std::string options =
        defines + (info_.fused ? " -DWEIR_FMA" : "") + (info_.same_bits ? " -cl-fp32-correctly-rounded-divide-sqrt" : "");
    error = clBuildProgram(program_, 1, &device_, options.c_str(), nullptr, nullptr);
    if (error == CL_SUCCESS) return;
    std::size_t size = 0;
    clGetProgramBuildInfo(program_, device_, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
    std::string log(size, '\0');
    clGetProgramBuildInfo(program_, device_, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
    throw BadInput("OpenCL: the driver of " + info_.name + " (" + info_.driver + ") does not compile the kernels, error " +
                   std::to_string(error) + ":\n" + log.c_str());
}

Memory OpenClDevice::alloc(std::size_t bytes) {
    cl_int error = CL_SUCCESS;
    const std::size_t size = std::max<std::size_t>(bytes, 16);
    const cl_mem buffer = clCreateBuffer(context_, CL_MEM_READ_WRITE, size, nullptr, &error);
    if (error != CL_SUCCESS)
        throw BadInput(info_.name + " has no " + std::to_string(size >> 20) + " MiB in one piece: " + name_of(error) +
                       "; choose fewer particles");
    *allocated_ += size;
    return {std::shared_ptr<void>(buffer,
                                  [allocated = allocated_, size](void* handle) {
                                      clReleaseMemObject(static_cast<cl_mem>(handle));
                                      *allocated -= size;
                                  }),
            size};
}

std::size_t OpenClDevice::find(std::string_view name) {
    for (std::size_t k = 0; k < kernels_.size(); ++k)
        if (kernels_[k].name == name) return k;
    cl_int error = CL_SUCCESS;
    const std::string text_name(name);
    const cl_kernel kernel = clCreateKernel(program_, text_name.c_str(), &error);
    require(error, "kernel " + text_name);
    kernels_.push_back({text_name, kernel});
    running_.push_back({text_name, 0, 0});
    return kernels_.size() - 1;
}

void OpenClDevice::launch(std::string_view name, std::size_t items, std::size_t group, std::initializer_list<Argument> arguments) {
    if (items == 0) return;
    const std::size_t at = find(name);
    cl_uint place = 0;
    for (const Argument& a : arguments) {
        const cl_mem buffer = a.memory ? mem(*a.memory) : nullptr;
        const cl_int error = clSetKernelArg(kernels_[at].kernel, place, a.memory ? sizeof buffer : a.bytes,
                                            a.memory ? static_cast<const void*>(&buffer) : a.data);
        if (error != CL_SUCCESS) require(error, "argument " + std::to_string(place) + " of " + kernels_[at].name);
        ++place;
    }
    const std::size_t local = std::min(group, info_.group_limit), global = (items + local - 1) / local * local;
    cl_event event = nullptr;
    const cl_int error = clEnqueueNDRangeKernel(queue_, kernels_[at].kernel, 1, nullptr, &global, &local, 0, nullptr, &event);
    if (error != CL_SUCCESS) require(error, "launching " + kernels_[at].name);
    launched_.push_back({event, at});
}

/// Adds the times of finished launches.
void OpenClDevice::collect() {
    for (const Launched& l : launched_) {
        cl_ulong begin = 0, end = 0;
        cl_int status = CL_COMPLETE;
        clGetEventInfo(l.event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr);
        if (status < 0) require(status, "running " + kernels_[l.kernel].name);
        clGetEventProfilingInfo(l.event, CL_PROFILING_COMMAND_START, sizeof begin, &begin, nullptr);
        clGetEventProfilingInfo(l.event, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr);
        ++running_[l.kernel].calls;
        running_[l.kernel].seconds += 1e-9 * static_cast<double>(end - begin);
        clReleaseEvent(l.event);
    }
    launched_.clear();
}

}  // namespace

std::vector<DeviceInfo> devices() {
    std::vector<DeviceInfo> list;
    for (cl_device_id device : all_devices()) list.push_back(describe(device));
    return list;
}

std::unique_ptr<Device> open_device(int index) {
    const auto list = all_devices();
    if (list.empty()) throw BadInput(std::string("no OpenCL device here: ") + how_to);
    if (index >= static_cast<int>(list.size()))
        throw BadInput("no OpenCL device " + std::to_string(index) + ": the last one is " + std::to_string(list.size() - 1) +
                       " (weir list devices)");
    try {
        return std::make_unique<OpenClDevice>(list[static_cast<std::size_t>(index)]);
    } catch (const std::runtime_error& error) {
        throw BadInput(std::string(error.what()) + "; " + how_to);
    }
}

}  // namespace weir::backend
