// Build information from CMake; build_info.cpp is generated from build_info.cpp.in.
#pragma once

namespace weir::output {

extern const char* const build_version;
extern const char* const build_commit;  // with "-dirty" for a modified tree; "unknown" outside a git clone
extern const char* const build_type;
extern const char* const build_compiler;
extern const char* const build_options;  // "native, VTK, OpenCL": the enabled options

}  // namespace weir::output
