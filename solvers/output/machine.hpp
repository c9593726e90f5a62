// On what a run was made: numbers without a machine mean nothing.
#pragma once
#include <string>

namespace weir::output {

struct Machine {
    std::string processor;  // as the system names it
    int logical_cores = 0;
    int threads = 0;  // that the run uses
    double memory_gib = 0;
    std::string system;    // kernel and its release
    std::string compiler;  // name and version
    std::string build;     // Release, Debug
    std::string rounding;  // what decides the last digits: processor model, compiler, build, mathematical library
    std::string options;   // that the build has on: "native, VTK, OpenCL"
    std::string version;   // of weir
    std::string commit;    // of the source, "unknown" outside a git clone
};

Machine this_machine();

}  // namespace weir::output
