#!/usr/bin/env bash
# Compiles gpu_particles with a C++ compiler and OpenCL headers alone: benchmarks/gpu_particles/build.sh OUTPUT [LIBRARY]
# LIBRARY: the OpenCL loader to link (default: -lOpenCL). What has to do with scenes is dropped by the linker. CXX, CXXFLAGS (default: -O2).
# Of shared libraries the binary needs the loader, libgomp and those of the C library: a loader is always a shared one.
set -euo pipefail
root="$(cd "$(dirname "$0")/../.." && pwd)"
output="$1"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
text() { sed -n '/^set(kernels /,/)/p' "$root/solvers/particles/CMakeLists.txt" | tr '\n()' '   ' | sed 's/^ *set *kernels//'; }
{
    echo '#include "particles/kernel_text.hpp"'
    echo 'namespace weir::particles { const std::vector<KernelText>& kernel_texts() { static const std::vector<KernelText> texts = {'
    for file in $(text); do printf '{"%s", R"kernel(' "$file"; cat "$root/solvers/particles/kernels/$file"; echo ')kernel"},'; done
    echo '}; return texts; } }'
} >"$work/kernel_text.cpp"
cd "$root/solvers"
sources=(core/{checkpoint,hex_number,parallel}.cpp geometry/*.cpp backend/choice.cpp backend/opencl.cpp pbf/device_solver.cpp pbf/options.cpp
         particles/{cell_sort,device_fluid,device_memory,device_neighbours,device_sides,device_solids,domain,emitters,fluid,frame,kernels,walls}.cpp)
compile() { # SOURCE: to an object with the source's path for a name
    ${CXX:-c++} -std=c++20 ${CXXFLAGS:--O2} -fopenmp -ffp-contract=off -ffunction-sections -fdata-sections -I. -I"$root" -c "$1" \
        -o "$work/$(echo "$1" | tr / _).o"
}
export -f compile
export root work
printf '%s\n' "$root/benchmarks/gpu_particles/gpu_particles.cpp" "$work/kernel_text.cpp" "${sources[@]}" |
    xargs -P "$(nproc)" -I{} bash -c 'set -e; compile {}'
${CXX:-c++} -fopenmp -Wl,--gc-sections -static-libgcc -static-libstdc++ "$work"/*.o "${2:--lOpenCL}" -o "$output"
