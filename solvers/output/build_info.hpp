// What CMake knew when this was built; build_info.cpp is made from build_info.cpp.in.
#pragma once

namespace weir::output {

extern const char* const build_version;
extern const char* const build_commit;  // with "-dirty" where the tree had changes; "unknown" outside a git clone
extern const char* const build_type;
extern const char* const build_compiler;
extern const char* const build_options;  // "native, VTK, OpenCL": what was switched on

}  // namespace weir::output
