// A device that runs kernels, as little of it as the solvers need: memory, kernels by name, launches in order, and what each one took by
// the device's own clock. One implementation, OpenCL 1.2 (opencl.cpp); another one compiles the same text.
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
    std::size_t memory = 0;       // [bytes]
    std::size_t largest = 0;      // that one allocation may have [bytes]
    std::size_t group_limit = 1;  // work items a group may have
    int units = 0;
    bool doubles = false;    // knows double precision (cl_khr_fp64)
    bool fused = false;      // rounds a product and a sum once
    bool same_bits = false;  // and divides with correct rounding: pair passes end in the bits of AVX2 and AVX-512
};

/// Memory on the device; freed with its last copy.
struct Memory {
    std::shared_ptr<void> handle;
    std::size_t bytes = 0;
};

/// One argument of a kernel: memory, or a value that is copied. Refers to what it is made from, so it lives no longer than the call.
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
    /// Compiles the program whose kernels are launched later. Throws BadInput with the compiler's words.
    virtual void compile(const std::string& text, const std::string& defines) = 0;
    /// Throws BadInput where the device has no such memory.
    virtual Memory alloc(std::size_t bytes) = 0;
    virtual void upload(const Memory& to, const void* from, std::size_t bytes, std::size_t offset = 0) = 0;
    /// Waits for everything launched before.
    virtual void download(void* to, const Memory& from, std::size_t bytes, std::size_t offset = 0) = 0;
    virtual void fill_zero(const Memory& memory, std::size_t bytes) = 0;
    /// Runs a kernel over `items` work items (rounded up to whole groups) behind everything launched before.
    virtual void launch(std::string_view kernel, std::size_t items, std::size_t group, std::initializer_list<Argument> arguments) = 0;
    virtual void finish() = 0;
    /// What kernels have taken since the last call. Waits for them.
    virtual const std::vector<Timing>& timings() = 0;
    /// Memory allocated and not freed [bytes].
    virtual std::size_t allocated() const = 0;
};

/// Every device of every platform, in the order by which they are numbered. Empty where there is none.
std::vector<DeviceInfo> devices();
/// Device number `index` of devices(). Throws BadInput saying what is missing and how to get it.
std::unique_ptr<Device> open_device(int index);

/// A backend by name: "threads", "threads:avx2" (an instruction set), "opencl", "opencl:1" (a device's number), "reference".
struct Choice {
    enum class Kind { threads, opencl, reference } kind = Kind::threads;
    std::string isa = "auto";
    int device = 0;
};
/// Throws BadInput naming what is allowed.
Choice parse_choice(std::string_view text);

}  // namespace weir::backend
