#!/usr/bin/env bash
# Compiles gpu_particles with a C++ compiler and OpenCL headers alone, to be carried to another machine: benchmarks/gpu_particles/build.sh
# OUTPUT. What has to do with scenes is dropped by the linker. CXX, CXXFLAGS (default: -O2).
# What stays shared are the C library's own (libc, libm, and libdl before glibc 2.34), no older there than here: a loader that is found at
# run time needs the machine's. OpenCL's loader is looked for when the benchmark starts (load_opencl.hpp); libstdc++ and libgcc are linked
# in; there are no threads, so no libgomp: the device does the work.
set -euo pipefail
root="$(cd "$(dirname "$0")/../.." && pwd)"
output="$1"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
text() { sed -n '/^set(kernels /,/)/p' "$root/solvers/particles/CMakeLists.txt" | tr '\n()' '   ' | sed 's/^ *set *kernels//'; }
{
    echo '#include "particles/opencl/kernel_text.hpp"'
    echo 'namespace weir::particles { const std::vector<KernelText>& kernel_texts() { static const std::vector<KernelText> texts = {'
    for file in $(text); do printf '{"%s", R"kernel(' "$file"; cat "$root/solvers/particles/kernels/$file"; echo ')kernel"},'; done
    echo '}; return texts; } }'
} >"$work/kernel_text.cpp"
echo 'inline int omp_get_max_threads() { return 1; }' >"$work/omp.h"
cd "$root/solvers"
# In few pieces, since headers take most of a compiler's time. device_fluid.cpp has types in its unnamed namespace that device_solids.cpp has too.
{
    echo '#include "benchmarks/gpu_particles/load_opencl.hpp"'
    printf '#include "%s"\n' core/{exact_sum,hex_number,parallel}.cpp parallel/{checkpoint,communicator,plane_store,slab}.cpp geometry/*.cpp backend/{choice,opencl}.cpp thermo/ambient.cpp pbf/{bodies,options}.cpp \
        particles/opencl/{device_bodies,device_heat,device_memory,device_neighbours,device_sides,device_solids}.cpp \
        particles/state/{domain,emitters,fluid,frame,kernels,scheme,solver}.cpp particles/boundaries/{solid_terms,squeezed,walls}.cpp \
        particles/{heat/heat,ranks/particle_exchange,threads/cell_sort}.cpp
} >"$work/solvers.cpp"
printf '#include "%s"\n' particles/{boundaries/beside_bodies,boundaries/bodies_in_liquid,opencl/device_ice,heat/ice,heat/ice_pieces,heat/vapour}.cpp geometry/mesh/mesh.cpp rigid/*.cpp >"$work/pieces.cpp"
printf '#include "%s"\n' particles/opencl/device_fluid.cpp pbf/device_solver.cpp "$work/kernel_text.cpp" >"$work/step.cpp"
compile() { # NAME SOURCE
    ${CXX:-c++} -std=c++20 ${CXXFLAGS:--O2} -ffp-contract=off -DFMT_HEADER_ONLY -ffunction-sections -fdata-sections -I"$work" -I. -I"$root" -c "$2" \
        -o "$work/$1.o"
}
pids=()
for source in "$root/benchmarks/gpu_particles/gpu_particles.cpp" "$work/solvers.cpp" "$work/pieces.cpp" particles/heat/ice_lattice.cpp \
    "$work/step.cpp"; do
    compile "$(basename "$source" .cpp)" "$source" &
    pids+=($!)
done
for pid in "${pids[@]}"; do wait "$pid"; done
${CXX:-c++} -Wl,--gc-sections -static-libgcc -static-libstdc++ "$work"/*.o -ldl -o "$output"
