// The kernels as text, embedded by CMake from particles/kernels: a device compiles at run time the same text as the processor's path.
#pragma once
#include <string>
#include <vector>

namespace weir::particles {

struct KernelText {
    const char* name;  // of the file
    const char* text;
};
const std::vector<KernelText>& kernel_texts();

/// The concatenation of the named files, each with its name for the compiler's messages.
std::string program_of(const std::vector<std::string>& files);

}  // namespace weir::particles
