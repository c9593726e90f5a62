#!/usr/bin/env bash
# Counts the instructions of a step with and without each effect: count.sh [PROGRAM]. Where callgrind does not know the program's
# instructions (valgrind 3.19 has no AVX-512, which a build for this machine alone may use), or without a program, it builds one for any
# x86-64 in build/portable. Exit code 77 (skipped) where there is no callgrind.
set -uo pipefail
root=$(cd "$(dirname "$0")/../../.." && pwd)
command -v valgrind >/dev/null || { echo "skipped: no valgrind (Debian: apt-get install valgrind)"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export WEIR_CALLGRIND_OUT=$work/out OMP_NUM_THREADS=1
count() { valgrind --tool=callgrind --callgrind-out-file="$WEIR_CALLGRIND_OUT" --instr-atstart=no --dump-line=no --log-file="$work/log" "$1"; }
unknown() { grep -qi "unrecognised instruction" "$work/log"; }

code=0
[ $# -eq 0 ] || { count "$1"; code=$?; }
if [ $# -eq 0 ] || unknown; then
    { cmake -S "$root" -B "$root/build/portable" --preset portable -DWEIR_VTK=OFF && cmake --build "$root/build/portable" --target effects_count; } >&2 || exit 2
    count "$root/build/portable/effects_count"
    code=$?
fi
! unknown && [ $code -le 1 ] || tail -20 "$work/log" >&2
exit $code
