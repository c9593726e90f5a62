#include "output/machine.hpp"

#include "core/parallel.hpp"
#include "output/build_info.hpp"

#include <fstream>
#include <thread>

#include <gnu/libc-version.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace weir::output {

namespace {

/// A property of the first processor; "unknown" where it is not available.
std::string of_processor(const std::string& key) {
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);) {
        const auto colon = line.find(':');
        if (colon == std::string::npos || colon + 2 > line.size()) continue;
        const auto last = line.find_last_not_of(" \t", colon - 1);
        if (line.substr(0, last + 1) == key) return line.substr(colon + 2);
    }
    return "unknown";
}

/// The processor's model determines the instructions of a native build and the kernels of BLAS.
std::string rounding() {
    return of_processor("vendor_id") + " family " + of_processor("cpu family") + " model " + of_processor("model") + ", " + build_compiler +
           ", " + build_type + ", " + build_options + ", glibc " + gnu_get_libc_version();
}

}  // namespace

Machine this_machine() {
    Machine machine;
    machine.processor = of_processor("model name");
    machine.logical_cores = static_cast<int>(std::thread::hardware_concurrency());
    machine.threads = threads();
    machine.memory_gib = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE)) / (1ll << 30);
    utsname name{};
    if (uname(&name) == 0) machine.system = std::string(name.sysname) + ' ' + name.release;
    machine.compiler = build_compiler;
    machine.build = build_type;
    machine.rounding = rounding();
    machine.options = build_options;
    machine.version = build_version;
    machine.commit = build_commit;
    return machine;
}

}  // namespace weir::output
