#!/usr/bin/env bash
# weir's front door: ./weir.sh build | run SCENE [...] | validate [...] | test. Installs what is missing, configures, builds, does its job.
set -euo pipefail
cd "$(dirname "$0")"

packages=(g++ cmake ninja-build ccache git libeigen3-dev libfmt-dev libgtest-dev libbenchmark-dev librapidcheck-dev libtomlplusplus-dev libcli11-dev
          nlohmann-json3-dev libgsl-dev libfftw3-dev libsuitesparse-dev libopenblas-dev libhypre-dev libnanoflann-dev libvtk9-dev gnuplot-nox)

install_missing() {
    local missing=()
    for p in "${packages[@]}"; do
        dpkg-query -W -f='${Status}' "$p" 2>/dev/null | grep -q 'ok installed' || missing+=("$p")
    done
    [ ${#missing[@]} -eq 0 ] && return
    local sudo=''
    [ "$(id -u)" -eq 0 ] || sudo=sudo
    echo "installing: ${missing[*]}"
    $sudo apt-get update -qq
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

build() {
    install_missing
    [ -f build/release/build.ninja ] || cmake --preset release
    cmake --build --preset release
}

usage() {
    sed -n '2s/^# //p' "$0"
    exit 2
}

case "${1:-}" in
    build) build ;;
    run | validate) build >&2 && exec build/release/weir "$@" ;;
    test) build && cd build/release && exec ctest --output-on-failure "${@:2}" ;;
    *) usage ;;
esac
