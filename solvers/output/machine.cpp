#include "output/machine.hpp"

#include "core/parallel.hpp"
#include "output/build_info.hpp"

#include <fstream>
#include <thread>

#include <sys/utsname.h>
#include <unistd.h>

namespace weir::output {

namespace {

std::string processor_name() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

}  // namespace

Machine this_machine() {
    Machine machine;
    machine.processor = processor_name();
    machine.logical_cores = static_cast<int>(std::thread::hardware_concurrency());
    machine.threads = threads();
    machine.memory_gib = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE)) / (1ll << 30);
    utsname name{};
    if (uname(&name) == 0) machine.system = std::string(name.sysname) + ' ' + name.release;
    machine.compiler = build_compiler;
    machine.build = build_type;
    machine.options = build_options;
    machine.version = build_version;
    machine.commit = build_commit;
    return machine;
}

}  // namespace weir::output
