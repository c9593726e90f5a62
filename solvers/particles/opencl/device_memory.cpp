#include "particles/opencl/device_memory.hpp"

#include "core/error.hpp"
#include "particles/opencl/kernel_text.hpp"

#include <algorithm>
#include <stdexcept>

namespace weir::particles {

namespace {
/// Usable part of a device's memory: the rest is for the driver, the display, and growing lists.
constexpr double usable = 0.9;
}  // namespace

std::size_t DevicePlan::bytes_per_particle() const {
    std::size_t sum = 0;
    for (const Wanted& w : wanted_) sum += w.bytes;
    return sum;
}

void DevicePlan::check(const backend::DeviceInfo& device, std::size_t count) const {
    std::size_t widest = 1;
    for (const Wanted& w : wanted_) widest = std::max(widest, w.bytes);
    const std::size_t each = std::max<std::size_t>(bytes_per_particle(), 1);
    const auto room = static_cast<std::size_t>(usable * static_cast<double>(device.memory));
    const std::size_t fit = std::min(room / each, device.largest / widest);
    if (count <= fit) return;
    throw BadInput(std::to_string(count) + " particles of " + std::to_string(each) + " bytes each do not fit on " + device.name +
                   ", which has " + std::to_string(device.memory >> 20) + " MiB, at most " + std::to_string(device.largest >> 20) +
                   " MiB in one piece: " + std::to_string(fit) + " particles would");
}

void DevicePlan::allocate(backend::Device& device, std::size_t count) const {
    for (const Wanted& w : wanted_) *w.memory = {};
    for (const Wanted& w : wanted_) *w.memory = device.alloc(std::max<std::size_t>(count, 1) * w.bytes);
}

std::string program_of(const std::vector<std::string>& files) {
    std::string program;
    for (const std::string& file : files) {
        const auto& all = kernel_texts();
        const auto at = std::find_if(all.begin(), all.end(), [&](const KernelText& t) { return file == t.name; });
        if (at == all.end()) throw std::logic_error("no kernel text \"" + file + "\"");
        program += "#line 1 \"" + file + "\"\n" + at->text + "\n";
    }
    return program;
}

}  // namespace weir::particles
