#!/usr/bin/env bash
# Fuzzes the readers of files that users hand in, with clang 14, address and undefined-behaviour sanitizers.
#   tests/fuzz/run.sh [SECONDS [KIND...]]    each kind for so long (default: 240), one core
# Kinds are those of tests/fuzz/targets.hpp. What an input breaks stands in build/fuzz/findings; once it is mended it is kept in
# tests/input/fuzz/KIND, and the gate replays it (input.fuzz_findings). New inputs that reach new code are kept in build/fuzz/corpus.
set -euo pipefail
here="$(cd "$(dirname "$0")/../.." && pwd)"
seconds="${1:-240}"
shift || true
kinds=("$@")
[ ${#kinds[@]} -gt 0 ] || kinds=($(sed -n 's/^bool \([a-z_]*\)(std::string_view.*/\1/p' "$here/tests/fuzz/targets.hpp"))
build="$here/build/fuzz"
cmake -G Ninja -S "$here" -B "$build" -DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_C_COMPILER=clang-14 -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" \
    -DWEIR_FUZZ=ON -DWEIR_TESTS=OFF -DWEIR_BENCHMARKS=OFF -DWEIR_PYTHON=OFF -DWEIR_NATIVE=OFF >/dev/null
ninja -C "$build" -j "${JOBS:-1}" "${kinds[@]/#/fuzz_}"
memory=/dev/shm
[ -w "$memory" ] || memory="${TMPDIR:-/tmp}"
code=0
for kind in "${kinds[@]}"; do
    mkdir -p "$build/corpus/$kind" "$build/findings"
    seeds=()
    folders=("$here/tests/fuzz/corpus/$kind" "$here/tests/input/fuzz/$kind")
    case "$kind" in scene | run | session) folders+=("$here/tests/input/bad") ;; esac
    for folder in "${folders[@]}"; do [ -d "$folder" ] && seeds+=("$folder"); done
    words=()
    [ -f "$here/tests/fuzz/$kind.dict" ] && words=(-dict="$here/tests/fuzz/$kind.dict")
    case "$kind" in validation_case | cost | stability | scene | made_up | session | run) [ -f "$here/tests/fuzz/scene.dict" ] && words=(-dict="$here/tests/fuzz/scene.dict") ;; esac
    echo "== $kind"
    TMPDIR="$memory" OMP_NUM_THREADS=1 ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 "$build/fuzz_$kind" "${words[@]}" -max_total_time="$seconds" -timeout=20 \
        -rss_limit_mb=1500 -malloc_limit_mb=1000 -max_len=20000 -use_value_profile=0 -artifact_prefix="$build/findings/$kind-" -print_final_stats=1 "$build/corpus/$kind" "${seeds[@]}" \
        >"$build/$kind.log" 2>&1 || { code=1; grep -E "ERROR|SUMMARY|runtime error|Test unit written|terminate" "$build/$kind.log" | head -5; }
    grep -E "number_of_executed_units|DONE" "$build/$kind.log" || true
done
exit $code
