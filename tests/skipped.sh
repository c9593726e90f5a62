#!/usr/bin/env bash
# skipped.sh JUNIT.xml WEIR: one line that counts the tests that ctest skipped, and why. Each reason must be one that this machine has:
# exit code 1 where a test was skipped without a reason, or for want of what is there.
set -euo pipefail
junit=$1 weir=$2
has() { command -v "$1" >/dev/null; }
has_display() { has xvfb-run && has xauth; }
has_browser() { has chromium || has chromium-browser; }
has_embree() { # its header, where compilers look; INCLUDES: other folders
    local folder
    for folder in ${INCLUDES:-/usr/include /usr/local/include}; do [ -e "$folder/embree3/rtcore.h" ] && return 0; done
    return 1
}
has_petsc() { [ -n "$(compgen -G "${PETSC:-/usr/lib/petscdir}/petsc*/*real/include/petsc.h")" ]; }
has_opencl() { "$weir" list devices >/dev/null 2>&1; }

# name, a tab, the reason: the line of a skipped test's output that begins with "skipped: ", or says that there is no OpenCL device
skips=$(awk '
    /<testcase /      { name = $0; sub(/.*<testcase name="/, "", name); sub(/".*/, "", name); skipped = 0; why = "" }
    /<skipped /       { skipped = 1 }
    why == "" && match($0, /skipped: [^<]*|no OpenCL device here|built without OpenCL/) { why = substr($0, RSTART, RLENGTH) }
    /<\/testcase>/    { if (skipped) print name "\t" why }' "$junit")
[ -n "$skips" ] || { echo "0 tests skipped"; exit 0; }

# What would have let the test run is there all the same: then the skip is a mistake.
explained() { # REASON
    case "$1" in
        *"no dpkg-dev"*) ! has dpkg-shlibdeps ;;
        *"another root takes root's rights"*) [ "$(id -u)" -ne 0 ] ;;
        *"no mounts are allowed here"*) ! unshare -m true 2>/dev/null ;;
        *"no overlay can be mounted here"*) true ;;  # the test has tried
        *"no doxygen"*) ! has doxygen ;;
        *"no nbconvert"*) ! /usr/bin/python3 -c 'import ipykernel, nbconvert' 2>/dev/null ;;
        *"no Xvfb"*) ! has_display ;;
        *"no chromium"*) ! has_browser ;;
        *"no mpirun.mpich"*) ! has mpirun.mpich ;;
        *"no mpirun"*) ! has mpirun ;;
        *"WEIR_MPI is off"*) true ;;  # somebody wanted it so
        *"built without MPI"*libmpich-dev*) ! has mpicc.mpich ;;
        *"built without MPI"*) ! has mpicc ;;
        *"no valgrind"*) ! has valgrind ;;
        *"valgrind does not know this build's instructions"*) grep -q avx512f /proc/cpuinfo ;;
        *"no ffmpeg"*) ! has ffmpeg ;;
        *"built without Embree"*) ! has_embree ;;
        *"built without PETSc"*) ! has_petsc ;;
        *"oclgrind is not installed"*) ! has oclgrind ;;
        *"built without OpenCL"* | *"no OpenCL device here"*) ! has_opencl ;;
        *) false ;;
    esac
}
count=0 unexplained=0 reasons=""
while IFS=$'\t' read -r name why; do
    count=$((count + 1))
    if explained "$why"; then
        reasons+="; $name: ${why#skipped: }"
    else
        unexplained=$((unexplained + 1))
        reasons+="; $name: NOT EXPLAINED by this machine (${why:-no reason given})"
    fi
done <<<"$skips"
echo "$count tests skipped${reasons}"
[ "$unexplained" -eq 0 ]
