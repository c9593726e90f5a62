#!/usr/bin/env bash
# Compiles gpu_particles with a C++ compiler and OpenCL headers alone: benchmarks/gpu_particles/build.sh OUTPUT [LIBRARY]
# LIBRARY: the OpenCL loader to link (default: -lOpenCL). What has to do with scenes is dropped by the linker.
set -euo pipefail
root="$(cd "$(dirname "$0")/../.." && pwd)"
output="$1"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
text() { sed -n "s/^set(kernels \(.*\)/\1/p; /^set(kernels/,/)/{/^set(kernels/d;p}" "$root/solvers/particles/CMakeLists.txt" | tr -d ')\n'; }
{
    echo '#include "particles/kernel_text.hpp"'
    echo 'namespace weir::particles { const std::vector<KernelText>& kernel_texts() { static const std::vector<KernelText> texts = {'
    for file in $(text); do printf '{"%s", R"kernel(' "$file"; cat "$root/solvers/particles/kernels/$file"; echo ')kernel"},'; done
    echo '}; return texts; } }'
} >"$work/kernel_text.cpp"
cd "$root/solvers"
sources=(core/{checkpoint,hex_number,parallel}.cpp geometry/*.cpp backend/choice.cpp backend/opencl.cpp pbf/device_solver.cpp pbf/options.cpp
         particles/{cell_sort,device_fluid,device_memory,device_neighbours,device_sides,device_solids,domain,emitters,fluid,frame,kernels,walls}.cpp)
"${CXX:-c++}" -std=c++20 -O2 -fopenmp -ffp-contract=off -ffunction-sections -fdata-sections -Wl,--gc-sections -static-libgcc -static-libstdc++ \
    -I. "$root/benchmarks/gpu_particles/gpu_particles.cpp" "$work/kernel_text.cpp" "${sources[@]}" "${2:--lOpenCL}" -o "$output"
