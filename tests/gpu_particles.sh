#!/usr/bin/env bash
# benchmarks/gpu_particles builds with a C++ compiler and OpenCL headers alone, and prints its table: tests/gpu_particles.sh
# Exit code 0: so it is, 1: it is not, 77: no OpenCL device here. Without optimisation, to be quick: no figure is looked at.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
CXXFLAGS=-O0 "$here/../benchmarks/gpu_particles/build.sh" "$work/gpu_particles"
cd "$work"
if ! ./gpu_particles --particles 500,8000 --steps 1 --iterations 4 --max-seconds 1e-6 >table 2>problem; then
    grep -q "no OpenCL device here" problem && { echo "skipped: no OpenCL device here"; exit 77; }
    cat table problem
    exit 1
fi
cat table
for line in "^copy: [0-9.]* GB/s" "^sort  *500 particles: bitonic .* counting" "^2D  *512 particles  4 iterations: .* ms a step" \
            "^3D  *432 particles  4 iterations: .* ms a step" "^3D  *8000 particles  4 iterations: skipped"; do
    grep -q "$line" table || { echo "no line like: $line"; exit 1; }
done
for kernel in lambda correct find_neighbours bitonic_sort counting_sort step; do
    grep -q ",$kernel," gpu_particles.csv || { echo "no kernel $kernel in the CSV"; exit 1; }
done
