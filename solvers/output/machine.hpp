// The machine of a run, without which measured values are meaningless.
#pragma once
#include <string>

namespace weir::output {

struct Machine {
    std::string processor;  // as named by the system
    int logical_cores = 0;
    int threads = 0;  // used by the run
    double memory_gib = 0;
    std::string system;    // kernel and its release
    std::string compiler;  // name and version
    std::string build;     // Release, Debug
    std::string rounding;  // what determines the last digits: processor model, compiler, build, mathematical library
    std::string options;   // enabled options of the build: "native, VTK, OpenCL"
    std::string version;   // of weir
    std::string commit;    // of the source, "unknown" outside a git clone
};

Machine this_machine();

}  // namespace weir::output
