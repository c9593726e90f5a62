#!/usr/bin/env bash
# Counts the instructions of a step with and without each effect: count.sh [PROGRAM]. Without a program it builds one that callgrind can run
# anywhere, in build/portable: valgrind 3.19 does not know AVX-512, which a build for this machine alone may use. Exit code 77 (skipped)
# where callgrind is missing or cannot run the program.
set -uo pipefail
root=$(cd "$(dirname "$0")/../../.." && pwd)
command -v valgrind >/dev/null || { echo "skipped: no valgrind (Debian: apt-get install valgrind)"; exit 77; }
program=${1:-$root/build/portable/effects_count}
if [ $# -eq 0 ]; then
    { cmake -S "$root" --preset portable && cmake --build "$root/build/portable" --target effects_count; } >&2 || exit 2
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export WEIR_CALLGRIND_OUT=$work/out OMP_NUM_THREADS=1
valgrind --tool=callgrind --callgrind-out-file="$WEIR_CALLGRIND_OUT" --instr-atstart=no --dump-line=no --log-file="$work/log" "$program"
code=$?
if grep -qi "unrecognised instruction" "$work/log"; then
    echo "skipped: valgrind does not know this build's instructions; tests/effects/audit/count.sh alone builds what it knows"
    exit 77
fi
[ $code -le 1 ] || tail -20 "$work/log" >&2
exit $code
