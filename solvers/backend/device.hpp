// A minimal interface to a device that runs kernels: memory, kernels by name, launches in order, and times by the device's clock. One
// implementation, OpenCL 1.2 (opencl.cpp); another one would compile the same text.
#pragma once
#include <array>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace weir::backend {

struct DeviceInfo {
    std::string name, platform, version, driver;
    std::string kind;             // GPU, CPU, accelerator
    std::size_t memory = 0;       // total [bytes]
    std::size_t largest = 0;      // limit of one allocation [bytes]
    std::size_t group_limit = 1;  // maximum number of work items in a group
    int units = 0;
    bool doubles = false;    // supports double precision (cl_khr_fp64)
    bool fused = false;      // has fused multiply-add
    bool same_bits = false;  // divides with correct rounding, too: pair passes are bitwise equal to AVX2 and AVX-512
};

/// Memory on the device; freed with its last copy.
struct Memory {
    std::shared_ptr<void> handle;
    std::size_t bytes = 0;
};

/// One argument of a kernel: memory, or a value that is copied. It is a reference, valid only during the call.
struct Argument {
    const void* data = nullptr;
    std::size_t bytes = 0;
    const Memory* memory = nullptr;
    Argument(const Memory& m) : memory(&m) {}
    template <class T, class = std::enable_if_t<std::is_trivially_copyable_v<T>>>
    Argument(const T& value) : data(&value), bytes(sizeof(T)) {}
};

/// Calls and seconds of one kernel, by the device's clock.
struct Timing {
    std::string kernel;
    int calls = 0;
    double seconds = 0;
};

class Device {
public:
    virtual ~Device() = default;
    virtual const DeviceInfo& info() const = 0;
    /// Compiles the program for later launches. Throws BadInput with the compiler's message.
    virtual void compile(const std::string& text, const std::string& defines) = 0;
    /// Throws BadInput where the device's memory does not suffice.
    virtual Memory alloc(std::size_t bytes) = 0;
    virtual void upload(const Memory& to, const void* from, std::size_t bytes, std::size_t offset = 0) = 0;
    /// Waits for all previous launches.
    virtual void download(void* to, const Memory& from, std::size_t bytes, std::size_t offset = 0) = 0;
    virtual void fill_zero(const Memory& memory, std::size_t bytes) = 0;
    /// Runs a kernel over `items` work items (rounded up to whole groups) after all previous launches.
    virtual void launch(std::string_view kernel, std::size_t items, std::size_t group, std::initializer_list<Argument> arguments) = 0;
    virtual void finish() = 0;
    /// Times of kernels since the last call. Waits for them.
    virtual const std::vector<Timing>& timings() = 0;
    /// Allocated memory [bytes].
    virtual std::size_t allocated() const = 0;
};

/// All devices of all platforms, in the order of their numbers. Empty where there are none.
std::vector<DeviceInfo> devices();
/// Opens device number `index` of devices(). Throws BadInput with the missing component and how to install it.
std::unique_ptr<Device> open_device(int index);

/// A backend by name: "threads", "threads:avx2" (an instruction set), "opencl", "opencl:1" (a device's number), "reference".
struct Choice {
    enum class Kind { threads, opencl, reference } kind = Kind::threads;
    std::string isa = "auto";
    int device = 0;
};
/// Throws BadInput listing the allowed names.
Choice parse_choice(std::string_view text);

}  // namespace weir::backend
