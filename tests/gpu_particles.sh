#!/usr/bin/env bash
# benchmarks/gpu_particles builds with a C++ compiler and OpenCL headers alone, can be carried, and prints its table: tests/gpu_particles.sh
# Exit code 0: so it is, 1: it is not, 77: no OpenCL device here. Without optimisation, to be quick: no figure is looked at; that a list and
# cells give the same places is checked by the benchmark itself.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
CXXFLAGS=-O0 "$here/../benchmarks/gpu_particles/build.sh" "$work/gpu_particles"
cd "$work"
ldd gpu_particles >shared
if grep -vE "^\s*(linux-vdso|libc|libm|libdl|libpthread|/lib[^ ]*/ld-[^ ]*)(\.so[.0-9]*)? " shared; then
    echo "shared libraries that a bare machine may lack"
    exit 1
fi
sed s/libOpenCL/libOpenXX/g gpu_particles >without # a machine that has no loader
chmod +x without
if ./without >table 2>problem || ! grep -q "no OpenCL device here" problem; then
    echo "without OpenCL's loader it does not say so"
    exit 1
fi
if ! ./gpu_particles --particles 500,8000 --steps 1 --iterations 4 --groups 64,0,1000000 --max-seconds 1e-6 >table 2>problem; then
    grep -q "no OpenCL device here" problem && { echo "skipped: no OpenCL device here"; exit 77; }
    cat table problem
    exit 1
fi
cat table
for line in "^copy: [0-9.]* GB/s" "^sort  *500 particles: bitonic .* counting" "^2D  *512 particles  4 iterations: .* ms a step" \
            "^3D  *432 particles  4 iterations: .* ms a step" "^3D  *8000 particles  4 iterations: skipped" \
            "groups of  64: list .* 9 cells .* times the list" "groups of  64: list .* 27 cells .* times the list" \
            "groups of 1000000: the device takes 1 to [0-9]*" "best groups: list 64 .* cells 64"; do
    grep -q "$line" table || { echo "no line like: $line"; exit 1; }
done
for kernel in lambda correct find_neighbours bitonic_sort counting_sort step list_build list_total cells_total; do
    grep -q ",$kernel," gpu_particles.csv || { echo "no kernel $kernel in the CSV"; exit 1; }
done
