#!/usr/bin/env bash
# weir's front door: ./weir.sh build | run SCENE [...] | validate [...] | cost [...] | plan CASE --budget 16ms --error 2% | stability [...] | report | picture RESULT [...] | view RESULT [...] | list ... | describe ... | test [...] | install DIR
# Each call installs what is missing (Debian 12, Ubuntu 24.04), configures, builds what it needs, and does its job; a second call re-does only
# what changed. The executable is build/release/weir.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"

packages=(g++ cmake ninja-build ccache git libeigen3-dev libfmt-dev libgtest-dev libbenchmark-dev librapidcheck-dev libtomlplusplus-dev libcli11-dev
          nlohmann-json3-dev opencl-headers ocl-icd-opencl-dev pocl-opencl-icd oclgrind libgsl-dev libfftw3-dev libsuitesparse-dev libopenblas-dev libhypre-dev libnanoflann-dev libvtk9-dev xvfb xauth valgrind gnuplot-nox)

install_missing() {
    if ! command -v dpkg-query >/dev/null; then
        echo "no apt here: these packages of Debian 12, or their likes, are assumed to be installed: ${packages[*]}" >&2
        return
    fi
    local installed missing=()
    installed="$(dpkg-query -W -f='${Package} ${Status}\n' "${packages[@]}" 2>/dev/null | sed -n 's/ install ok installed$//p' || true)"
    for p in "${packages[@]}"; do
        grep -qx -- "$p" <<<"$installed" || missing+=("$p")
    done
    [ ${#missing[@]} -eq 0 ] && return
    local sudo=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || { echo "missing: ${missing[*]}; install them as root, or install sudo" >&2; exit 2; }
        sudo=(sudo)
    fi
    echo "installing: ${missing[*]}" >&2
    "${sudo[@]}" apt-get update -qq >&2
    "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# build [TARGET...]: everything where no target is named
build() {
    install_missing
    [ -f "$here/build/release/build.ninja" ] || (cd "$here" && cmake --preset release)
    cmake --build "$here/build/release" ${1:+--target "$@"}
}

usage() {
    sed -n '2,4s/^# //p' "$0" >&2
    exit 2
}

case "${1:-}" in
    build) build ;;
    run | validate | cost | plan | stability | report | picture | view | list | describe) build weir >&2 && exec "$here/build/release/weir" "$@" ;;
    test) # threads that wait sleep: tests share the machine with other work, and spinning starves the thread that is waited for
        export OMP_WAIT_POLICY="${OMP_WAIT_POLICY:-passive}"
        build && cd "$here/build/release" && exec ctest --output-on-failure "${@:2}" ;;
    install) [ $# -eq 2 ] || usage; build && exec cmake --install "$here/build/release" --prefix "$2" ;;
    *) usage ;;
esac
