#!/usr/bin/env bash
# Every kernel of the OpenCL backend on small scenes under oclgrind, an interpreter of kernels: no access out of bounds, no data race.
#   tests/oclgrind.sh WEIR     WEIR: the executable. Exit code 0: clean, 1: something was found, 77: oclgrind is not installed.
set -euo pipefail
weir="$(realpath "$1")"
here="$(cd "$(dirname "$0")" && pwd)"
command -v oclgrind >/dev/null || { echo "skipped: oclgrind is not installed"; exit 77; }
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

check() { # NAME OPTIONS...: one run that must leave an empty log
    local name="$1"
    shift
    oclgrind --data-races --log "$work/$name.log" "$weir" run "$here/shared/scenes/$name.toml" --backend opencl --quiet --out "$work/$name" "$@"
    if [ -s "$work/$name.log" ]; then
        echo "$name: oclgrind found"
        head -40 "$work/$name.log"
        exit 1
    fi
    echo "$name: clean"
}

check pbf_2d
check pbf_3d
check pbf_sides
check pbf_solids
check sph_2d
check sph_3d
check sph_solids
